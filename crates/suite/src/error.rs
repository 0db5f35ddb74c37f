//! Why a run has no verdict.
use crate::worker::WorkerError;
use servobench::panicked::Panicked;
use servobench::{EngineMissing, Error};
use servobench_isolation::in_words;
use servobench_sim::{BuildError, Failure};
use std::time::Duration;

/// Why a run has no verdict.
#[derive(Debug, thiserror::Error)]
pub enum RunError {
    /// The closed loop cannot be built, or its run ended early.
    #[error(transparent)]
    Loop(Error),
    /// It took longer than it may.
    #[error(
        "its {which} of time, {} s, was reached at {reached:.3} s of {length:.3} s simulated; allow it longer with `run.time_limit` and \
         `--time-limit`, or shorten the run",
        limit.as_secs_f64()
    )]
    TimeLimit {
        /// `limit` or `default limit`.
        which: &'static str,
        /// How long it may take, by the clock.
        limit: Duration,
        /// How far it came (s).
        reached: f64,
        /// How far it would have gone (s).
        length: f64,
    },
    /// Its recording alone takes more memory than there may be.
    #[error(
        "its recording takes {} of memory, and the limit is {}: name fewer `record.channels`, shorten the run, or raise \
         `--memory-limit`",
        in_words(*need), in_words(*limit)
    )]
    Memory {
        /// What it takes (B).
        need: u64,
        /// What there may be (B).
        limit: u64,
    },
    /// The worker process says why, or could not.
    #[error(transparent)]
    Worker(#[from] WorkerError),
}

impl RunError {
    /// True where the scenario is at fault: it asks for what cannot be built.
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
