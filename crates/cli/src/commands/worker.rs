//! `servobench worker`: scenarios in a process of its own, one after the other.
use crate::engines;
use crate::error::CliError;
use crate::exit::Exit;
use crate::fmu_trust::FmuTrust;
use crate::interrupt;
use servobench_isolation::contain;
use servobench_suite::worker::serve;

/// Runs the scenarios that come in on standard input; everything that is to be said of them is said by [`serve`].
pub(crate) fn worker() -> Result<Exit, CliError> {
    contain()?;
    // What it has unpacked goes with it.
    interrupt::watch(&std::env::temp_dir())?;
    // Whoever started it has asked the command line, and wants no code of FMUs to run where nothing is recorded.
    let (running, checking) = (engines::with(FmuTrust::AsTheScenarioSays), engines::with(FmuTrust::Describe));
    serve(&running, &checking).map_err(CliError::Listen)?;
    Ok(Exit::Passed)
}
