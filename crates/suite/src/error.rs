//! Why a run has no verdict.
use crate::engines::EngineMissing;
use crate::panicked::Panicked;
use crate::worker::WorkerError;
use servobench_isolation::in_words;
use servobench_plant::MechanicsError;
use servobench_sim::{BuildError, Failure};
use std::time::Duration;
use thiserror::Error;

/// Why a run has no verdict.
#[derive(Debug, Error)]
pub enum RunError {
    /// The closed loop cannot be built.
    #[error(transparent)]
    Build(#[from] BuildError),
    /// The build lacks the engine.
    #[error(transparent)]
    EngineMissing(#[from] EngineMissing),
    /// The run ended early.
    #[error(transparent)]
    Failed(#[from] Failure),
    /// Something panicked.
    #[error(transparent)]
    Panicked(#[from] Panicked),
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
    /// The disk takes no more of its recording.
    #[error("the recording cannot be kept: {0}")]
    NotKept(#[source] std::io::Error),
    /// The worker process says why, or could not.
    #[error(transparent)]
    Worker(#[from] WorkerError),
}

/// Whether `error` is one of what was tried, not of the scenario.
pub(crate) const fn is_of_the_run(error: &BuildError) -> bool {
    matches!(
        error,
        BuildError::Mechanics(MechanicsError::Native { .. } | MechanicsError::NotSaved)
            | BuildError::Broken(_)
            | BuildError::NotBegun(_)
    )
}

impl RunError {
    /// Whether the scenario is at fault: it asks for what cannot be built.
    #[must_use]
    pub const fn is_input(&self) -> bool {
        match self {
            // A library that does not load, or an FMU that crashes, is not the scenario's fault.
            Self::Build(error) if is_of_the_run(error) => false,
            Self::Build(_) | Self::Worker(WorkerError::Input(_)) => true,
            Self::EngineMissing(_)
            | Self::Failed(_)
            | Self::Panicked(_)
            | Self::TimeLimit { .. }
            | Self::Memory { .. }
            | Self::NotKept(_)
            | Self::Worker(_) => false,
        }
    }
}
