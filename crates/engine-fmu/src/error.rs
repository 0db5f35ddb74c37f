//! Errors before an isolated FMU takes a step.
use servobench_fmi::SlaveError;
use std::io;
use std::path::PathBuf;
use thiserror::Error;

/// Reason why an FMU cannot be isolated in a process.
#[derive(Debug, Error)]
pub enum IsolationError {
    /// The process cannot be started.
    #[error("cannot start the process of the FMU, `{}`: {source}", program.display())]
    Start {
        /// The program.
        program: PathBuf,
        /// The system's error.
        source: io::Error,
    },
    /// The system refused memory or another resource that both processes share.
    #[error("cannot {action}: {source}")]
    System {
        /// The attempted action.
        action: &'static str,
        /// The system's error.
        source: io::Error,
    },
    /// The request to load cannot be serialised.
    #[error("cannot tell the process of the FMU what to load: {0}")]
    Setup(#[source] serde_json::Error),
    /// The FMU cannot be loaded or initialised.
    #[error("{0}")]
    Refused(String),
    /// The FMU crashed or hung while it was loaded or initialised.
    #[error(transparent)]
    Slave(#[from] SlaveError),
}

/// Reason why a process cannot be a host.
#[derive(Debug, Error)]
pub enum HostError {
    /// The process was not started by a simulation.
    #[error("standard input is not the memory of a simulation: this program is started by servobench itself")]
    NoPage,
    /// The system refused a resource.
    #[error("cannot {action}: {source}")]
    System {
        /// The attempted action.
        action: &'static str,
        /// The system's error.
        source: io::Error,
    },
}
