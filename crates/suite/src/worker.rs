//! Runs in separate processes: the worker is this same program, which receives one scenario after the other.
//!
//! ```text
//! servobench worker
//! standard input:   a socket. In: orders, JSON lines. Out: JSON lines, {"progress": 0.25} …, {"holds": 9000000}, and at last of each
//!                   order {"end": "done" or {"input": "<why>"} or {"diverged": …} or {"gaveup": "<why>"} or {"stopped": 1.5}
//!                   or {"failed": "<why>"}}
//! standard output:  the file that the recording of an order goes to; it has no name
//! ```
//! [`servobench_isolation`] contains it: it ends with this program however that ends, and leaves nothing behind.
//!
//! A run is reported with the end that its worker reports, so that a reason does not depend on where a run happened. An end without a
//! report is that of a native library; it costs this run only, and the library's standard output and standard error are reported. A worker
//! that is silent for [`WorkerCommand::timeout`] is killed.
//!
//! A worker is used again when its order came to an orderly end: starting one costs more than a short run. One that has failed in any way,
//! or has kept much memory, is not.
mod message;
mod order;
mod process;
mod recording;
mod serve;
mod workers;

pub use message::End;
pub use order::{Order, Task};
pub use serve::{answer, serve};
pub use workers::{RunLimits, WorkerCommand, Workers};

use std::io;
use std::path::PathBuf;
use std::time::Duration;
use thiserror::Error;

/// Reasons why a worker gave no run, or an incomplete one.
#[derive(Debug, Error)]
pub enum WorkerError {
    /// The worker reports that the input is wrong.
    #[error("{0}")]
    Input(String),
    /// The worker reports why the run ended early.
    #[error("{0}")]
    Failed(String),
    /// The process could not be started, or communication with it failed.
    #[error("cannot {action} the worker `{}`: {source}", program.display())]
    Process {
        /// The attempted action.
        action: &'static str,
        /// The program.
        program: PathBuf,
        /// Error of the system.
        source: io::Error,
    },
    /// The process ended without a report.
    #[error("the engine's library ended its process: {how}")]
    Ended {
        /// Its end, in words, with the last of its output.
        how: String,
    },
    /// The worker was silent for too long and was killed.
    #[error(
        "the engine's process made no progress for {} s and was ended; allow it longer with `--worker-timeout`",
        timeout.as_secs_f64()
    )]
    Stalled {
        /// Duration of the wait.
        timeout: Duration,
    },
    /// The worker was done, but its recording cannot be read.
    #[error("the recording of the worker: {0}")]
    Recording(io::Error),
}
