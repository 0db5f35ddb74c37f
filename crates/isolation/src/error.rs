//! Reasons why a process is not contained.
use std::io;
use thiserror::Error;

/// Reasons why a process is not contained.
#[derive(Debug, Error)]
pub enum ContainError {
    /// The process was not started to be contained.
    #[error("this command is started by servobench itself, which tells it what it may take")]
    NotStarted,
    /// The system refuses a necessary operation.
    #[error("cannot {action}: {source}")]
    System {
        /// The attempted operation.
        action: &'static str,
        /// Error of the system.
        source: io::Error,
    },
}
