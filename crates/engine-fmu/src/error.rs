//! What can go wrong before an FMU in a process of its own takes a step.
use servobench_fmi::SlaveError;
use std::io;
use std::path::PathBuf;
use thiserror::Error;

/// Why there is no FMU in a process of its own.
#[derive(Debug, Error)]
pub enum IsolationError {
    /// The process cannot be started.
    #[error("cannot start the process of the FMU, `{}`: {source}", program.display())]
    Start {
        /// The program.
        program: PathBuf,
        /// What the system says.
        source: io::Error,
    },
    /// The system does not give what both processes share.
    #[error("cannot {action}: {source}")]
    System {
        /// What was tried.
        action: &'static str,
        /// What the system says.
        source: io::Error,
    },
    /// What is to be loaded cannot be put into words.
    #[error("cannot tell the process of the FMU what to load: {0}")]
    Setup(#[source] serde_json::Error),
    /// The FMU cannot be loaded or initialised.
    #[error("{0}")]
    Refused(String),
    /// It crashed or hung in loading or initialisation.
    #[error(transparent)]
    Slave(#[from] SlaveError),
}

/// Why a process is no host.
#[derive(Debug, Error)]
pub enum HostError {
    /// It was not started by a simulation.
    #[error("standard input is not the memory of a simulation: this program is started by servobench itself")]
    NoPage,
    /// The system does not give what it needs.
    #[error("cannot {action}: {source}")]
    System {
        /// What was tried.
        action: &'static str,
        /// What the system says.
        source: io::Error,
    },
}
