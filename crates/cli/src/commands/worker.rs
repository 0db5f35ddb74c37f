//! `servobench worker`: one scenario in a process of its own.
use crate::args::WorkerArgs;
use crate::engines;
use crate::exit::{CliError, Exit};
use crate::sources;
use servobench_suite::{RunError, worker};
use std::io::Read;

/// Runs the scenario that comes in on standard input.
pub(crate) fn worker(args: &WorkerArgs) -> Result<Exit, CliError> {
    let mut text = String::new();
    std::io::stdin().read_to_string(&mut text).map_err(|error| CliError::Run(format!("standard input: {error}")))?;
    let loaded = sources::parse(&args.name, &text, args.path.as_deref())?;
    let served =
        worker::serve(loaded.scenario, &args.durations, args.engine.into(), &engines::installed(), &args.recording);
    match served {
        Ok(()) => Ok(Exit::Passed),
        Err(RunError::Input(words)) => Err(CliError::Input(words)),
        Err(error) => Err(CliError::Run(error.to_string())),
    }
}
