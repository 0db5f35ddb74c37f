//! Errors while deriving the matrices of a loop.
use servobench_base::state::Damaged;
use thiserror::Error;

/// Reasons why a loop has no matrices.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum LinearError {
    /// A state that was saved cannot be restored.
    #[error(transparent)]
    Damaged(#[from] Damaged),
    /// The loop does not run.
    #[error("the loop that is to be made linear does not run: {0}")]
    Stopped(String),
    /// The loop does not stay where it is brought to rest.
    #[error("the loop that is to be made linear does not stay at rest: `{0}` changes")]
    NotAtRest(String),
    /// A number that defines its rest is missing.
    #[error("the loop that is to be made linear has no number `{0}`")]
    NoSuchNumber(String),
}
