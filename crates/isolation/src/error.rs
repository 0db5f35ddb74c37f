//! Why a process is not contained.
use std::io;
use thiserror::Error;

/// Why a process is not contained.
#[derive(Debug, Error)]
pub enum ContainError {
    /// Nobody has started it to be contained.
    #[error("this command is started by servobench itself, which tells it what it may take")]
    NotStarted,
    /// The system does not give what is needed.
    #[error("cannot {action}: {source}")]
    System {
        /// What was tried.
        action: &'static str,
        /// What the system says.
        source: io::Error,
    },
}
