//! A run in a process of its own: the worker is this same program, told one scenario and where its recording goes.
//!
//! ```text
//! servobench worker --engine <name> [--recording <file>] --name <scenario> [--path <file>] [--durations <s>,<s>…]
//!                   [--set <override>]…
//! stdin:  text of the scenario
//! stdout: JSON lines, {"progress": 0.25} …, and at last {"end": "done" or {"input": "<why>"} or {"diverged": …} or
//!         {"gaveup": "<why>"} or {"failed": "<why>"}}
//! exit code: 0 done, 2 the input is wrong, 3 ended early (the recording is there as far as it came)
//! ```
//! Without `--recording` nothing runs: the worker tells what keeps the scenario from being built,
//! `{"objections": […]}`, and is done.
//!
//! What the worker says of its end is what the run is reported with, so that a reason does not depend on where a run
//! happened. An end without a word is that of a native library; it costs this run only, and what the library wrote on
//! standard error is reported. A worker that says nothing for [`WorkerCommand::timeout`] is ended.
mod call;
mod listener;
mod message;
mod serve;

pub(crate) use call::{ask, call};
pub use message::End;
pub use serve::{Order, serve};

use servobench_trace::TraceError;
use std::io;
use std::path::PathBuf;
use std::process::ExitStatus;
use std::time::Duration;
use thiserror::Error;

/// How to start a worker.
#[derive(Debug, Clone)]
pub struct WorkerCommand {
    /// The program.
    pub program: PathBuf,
    /// Folder for the recordings on their way from the worker; each is removed when it was read.
    pub folder: PathBuf,
    /// How long a worker may say nothing. It speaks every few thousand ticks, but not while the engine reads the model
    /// nor while it writes the recording.
    pub timeout: Duration,
}

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
    #[error("the engine's library ended its process ({status}){}", with_last_words(last_words))]
    Ended {
        /// How it ended.
        status: ExitStatus,
        /// The end of what it wrote on standard error.
        last_words: String,
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
    Recording(#[from] TraceError),
}

fn with_last_words(last_words: &str) -> String {
    if last_words.is_empty() { String::new() } else { format!("; its last words: {last_words}") }
}
