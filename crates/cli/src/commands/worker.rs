//! `servobench worker`: runs scenarios, one after the other, in a separate process.
use crate::engines;
use crate::error::CliError;
use crate::exit::Exit;
use crate::fmu_trust::FmuTrust;
use crate::interrupt;
use servobench_isolation::contain;
use servobench_suite::worker::serve;

/// Runs the scenarios that come in on standard input; [`serve`] sends all replies.
pub(crate) fn worker() -> Result<Exit, CliError> {
    contain()?;
    // Files that it unpacked are removed with it.
    interrupt::watch(&std::env::temp_dir())?;
    // The starting process has checked the command line, and allows no code of FMUs to run where nothing is recorded.
    let (running, checking) = (engines::with(FmuTrust::AsTheScenarioSays), engines::with(FmuTrust::Describe));
    serve(&running, &checking).map_err(CliError::Listen)?;
    Ok(Exit::Passed)
}
