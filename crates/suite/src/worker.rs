//! Runs in processes of their own: the worker is this same program, which is told one scenario after the other.
//!
//! ```text
//! servobench worker
//! standard input:   a socket. In: orders, JSON lines. Out: JSON lines, {"progress": 0.25} …, {"holds": 9000000}, and at last of each
//!                   order {"end": "done" or {"input": "<why>"} or {"diverged": …} or {"gaveup": "<why>"} or {"stopped": 1.5}
//!                   or {"failed": "<why>"}}
//! standard output:  the file that the recording of an order goes to; it has no name
//! ```
//! What contains it is [`servobench_isolation`]: it ends with this program however that ends, and nothing of it stays.
//!
//! What the worker says of its end is what the run is reported with, so that a reason does not depend on where a run
//! happened. An end without a word is that of a native library; it costs this run only, and what the library wrote on
//! standard output and standard error is reported. A worker that says nothing for [`WorkerCommand::timeout`] is ended.
//!
//! A worker serves again when its order came to an orderly end: starting one costs more than a short run. One that has failed in any
//! way, or has kept much memory, does not.
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

/// Why a worker gave no run, or half of one.
#[derive(Debug, Error)]
pub enum WorkerError {
    /// The worker says that the input is wrong.
    #[error("{0}")]
    Input(String),
    /// The worker says why the run ended early.
    #[error("{0}")]
    Failed(String),
    /// The process could not be started or spoken to.
    #[error("cannot {action} the worker `{}`: {source}", program.display())]
    Process {
        /// What was tried.
        action: &'static str,
        /// The program.
        program: PathBuf,
        /// What the system says.
        source: io::Error,
    },
    /// The process ended without a word.
    #[error("the engine's library ended its process: {how}")]
    Ended {
        /// How it ended, with the last of what it wrote.
        how: String,
    },
    /// The worker said nothing for too long and was ended.
    #[error(
        "the engine's process made no progress for {} s and was ended; allow it longer with `--worker-timeout`",
        timeout.as_secs_f64()
    )]
    Stalled {
        /// How long it was waited for.
        timeout: Duration,
    },
    /// The worker was done, but its recording cannot be read.
    #[error("the recording of the worker: {0}")]
    Recording(io::Error),
}
