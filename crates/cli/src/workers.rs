//! How much runs at a time, and where.
use crate::error::CliError;
use servobench_suite::{AtATime, WorkerCommand};
use std::num::NonZero;
use std::path::Path;
use std::thread::available_parallelism;
use std::time::Duration;

/// How worker processes are started: this program again. Their recordings pass through `folder`.
pub(crate) fn command(folder: &Path, timeout: Duration) -> Result<WorkerCommand, CliError> {
    let program = std::env::current_exe().map_err(CliError::OwnProgram)?;
    Ok(WorkerCommand { program, folder: folder.to_owned(), timeout })
}

/// `jobs` at a time, or one for each core.
pub(crate) fn at_a_time(jobs: Option<u16>) -> AtATime {
    AtATime::jobs(jobs.map_or_else(|| available_parallelism().map_or(1, NonZero::get), usize::from))
}
