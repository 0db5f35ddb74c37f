//! Reasons why a run has no verdict.
use crate::worker::WorkerError;
use servobench::panicked::Panicked;
use servobench::{EngineMissing, Error};
use servobench_isolation::in_words;
use servobench_sim::{BuildError, Failure};
use std::time::Duration;

/// Reasons why a run has no verdict.
#[derive(Debug, thiserror::Error)]
pub enum RunError {
    /// The closed loop cannot be built, or its run ended early.
    #[error(transparent)]
    Loop(Error),
    /// The time limit was reached.
    #[error(
        "its {which} of time, {} s, was reached at {reached:.3} s of {length:.3} s simulated; allow it longer with `run.time_limit` and \
         `--time-limit`, or shorten the run",
        limit.as_secs_f64()
    )]
    TimeLimit {
        /// `limit` or `default limit`.
        which: &'static str,
        /// The limit, by the clock.
        limit: Duration,
        /// Simulated time reached (s).
        reached: f64,
        /// Simulated length of the whole run (s).
        length: f64,
    },
    /// Its recording alone exceeds the memory limit.
    #[error(
        "its recording takes {} of memory, and the limit is {}: name fewer `record.channels`, shorten the run, or raise \
         `--memory-limit`",
        in_words(*need), in_words(*limit)
    )]
    Memory {
        /// Memory needed (B).
        need: u64,
        /// Memory limit (B).
        limit: u64,
    },
    /// The worker process reported an error, or failed to.
    #[error(transparent)]
    Worker(#[from] WorkerError),
}

impl RunError {
    /// True where the scenario is at fault: it requests something that cannot be built.
    #[must_use]
    pub const fn is_input(&self) -> bool {
        match self {
            Self::Loop(error) => error.is_input(),
            Self::Worker(WorkerError::Input(_)) => true,
            Self::TimeLimit { .. } | Self::Memory { .. } | Self::Worker(_) => false,
        }
    }
}

impl From<Error> for RunError {
    fn from(error: Error) -> Self {
        Self::Loop(error)
    }
}

impl From<BuildError> for RunError {
    fn from(error: BuildError) -> Self {
        Self::Loop(error.into())
    }
}

impl From<EngineMissing> for RunError {
    fn from(error: EngineMissing) -> Self {
        Self::Loop(error.into())
    }
}

impl From<Failure> for RunError {
    fn from(error: Failure) -> Self {
        Self::Loop(error.into())
    }
}

impl From<Panicked> for RunError {
    fn from(error: Panicked) -> Self {
        Self::Loop(error.into())
    }
}
