//! Worker processes and the limits of runs.
use crate::console::say;
use crate::error::CliError;
use servobench_isolation::memory_of_machine;
use servobench_results::printable;
use servobench_scenario::TimeBound;
use servobench_suite::{AtATime, RunLimits, WorkerCommand, Workers};
use std::num::NonZero;
use std::path::Path;
use std::thread::available_parallelism;
use std::time::Duration;

/// Memory of runs where that of the machine is unknown (B).
const UNKNOWN: u64 = 4_000_000_000;

/// Worker processes: this program again. Their recordings pass through `folder`, in files without a name.
pub(crate) fn of(folder: &Path, timeout: Duration, limits: RunLimits) -> Result<Workers, CliError> {
    let program = std::env::current_exe().map_err(CliError::OwnProgram)?;
    Ok(Workers::new(WorkerCommand { program, folder: folder.to_owned(), timeout, limits }))
}

/// Ends the workers and reports processes that remain.
pub(crate) fn dismiss(workers: &Workers) {
    for left in workers.dismiss() {
        say(&format!("servobench: warning: the process of an engine: {}\n", printable(&left)));
    }
}

/// Limits of a run. By default it gets half of the machine's memory: metrics need memory beside the recording.
pub(crate) fn limits(time: Option<TimeBound>, memory: Option<u64>) -> RunLimits {
    RunLimits { time, memory: memory.unwrap_or_else(|| memory_of_machine().map_or(UNKNOWN, |memory| memory / 2)) }
}

/// `jobs` at a time, or one for each core; all share the memory limit of one.
pub(crate) fn at_a_time(jobs: Option<u16>, limits: RunLimits) -> AtATime {
    let jobs = jobs.map_or_else(|| available_parallelism().map_or(1, NonZero::get), usize::from);
    AtATime { jobs, memory: limits.memory }
}
