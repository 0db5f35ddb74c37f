//! Why a run could not be built.
use servobench_base::{ParamError, RateError};
use servobench_motion::PlanError;
use servobench_plant::MechanicsError;
use thiserror::Error;

/// Why a scenario could not be turned into a closed loop.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum BuildError {
    /// A parameter is out of its bound.
    #[error(transparent)]
    Parameter(#[from] ParamError),
    /// A task rate does not divide the base rate.
    #[error(transparent)]
    Rate(#[from] RateError),
    /// A move cannot be planned.
    #[error("program step {}: {error}", index + 1)]
    Plan {
        /// Number of the step, from 0.
        index: usize,
        /// What the planner says.
        error: PlanError,
    },
    /// The engine refuses the mechanics.
    #[error(transparent)]
    Mechanics(#[from] MechanicsError),
    /// The motor is fed back from a sensor that is not there, or the like.
    #[error("{0}")]
    Contradiction(&'static str),
    /// The recording would not fit in memory.
    #[error(
        "recording {channels} channels at {rate} Hz for {duration} s takes {gigabytes:.1} GB, more than {limit} GB; \
         lower `record.rate` or name fewer `record.channels`"
    )]
    TooLong {
        /// Channels.
        channels: usize,
        /// Recording rate (Hz).
        rate: u32,
        /// Length of the run (s).
        duration: f64,
        /// Memory it would take.
        gigabytes: f64,
        /// Memory that is granted.
        limit: f64,
    },
    /// A channel that the recording does not have.
    #[error("`record.channels` names `{name}`, which this axis does not have; it has {}", available.join(", "))]
    UnknownChannel {
        /// What was asked for.
        name: String,
        /// What there is.
        available: Vec<String>,
    },
}
