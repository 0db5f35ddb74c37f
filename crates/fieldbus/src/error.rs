//! Why a link or a bus cannot be built.
use servobench_base::ParamError;
use servobench_motion::PlanError;
use thiserror::Error;

/// A setting that is refused, with what would be accepted.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum FieldbusError {
    /// A number out of its bound.
    #[error(transparent)]
    Parameter(#[from] ParamError),
    /// A limit that no stop can be planned with.
    #[error(transparent)]
    Plan(#[from] PlanError),
    /// More slack for late samples than the buffer holds samples.
    #[error(
        "`margin` must be at most {highest} ticks, two cycles of the motion task, got {margin}: let the samples come \
         earlier, or the cycle be longer"
    )]
    Margin {
        /// Rejected slack (base ticks).
        margin: u32,
        /// Largest one (base ticks).
        highest: u64,
    },
    /// A prediction beyond the present, or further than is predicted.
    #[error(
        "`run_ahead` must be at most {highest} cycles of the motion task with this interpolation, got {ahead}: that leaves no delay to \
         take out"
    )]
    RunAhead {
        /// Rejected cycles.
        ahead: u32,
        /// Most of them.
        highest: usize,
    },
    /// A time-out that the answer of a sound drive cannot keep.
    #[error("`drive_timeout` must be longer than the round trip of {round_trip} ticks, got {timeout} ticks")]
    ShortTimeout {
        /// Rejected time-out (base ticks).
        timeout: u64,
        /// From a command to the first answer that knows of it (base ticks).
        round_trip: u64,
    },
    /// A position loop in the master that would learn of the axis too late.
    #[error("`round_trip` and `answer_age` must be at most {highest} ticks together, got {delay}: take a longer cycle")]
    OldAnswer {
        /// Rejected sum (base ticks).
        delay: u64,
        /// Largest one (base ticks).
        highest: u64,
    },
    /// An integral that no gain makes stable.
    #[error(
        "the integral time of the master's position loop must be longer than {lowest} s, the age of the position and half a cycle, got \
         {time} s: with a shorter one the loop is unstable at every gain"
    )]
    ShortIntegral {
        /// Rejected integral time (s).
        time: f64,
        /// What it must be longer than (s).
        lowest: f64,
    },
    /// A velocity of the axis that the drive's unit cannot express.
    #[error(
        "`velocity_limit` is {counts:e} in the drive's velocity unit, at most {highest} fits 32 bits: choose a coarser \
         unit"
    )]
    FineVelocity {
        /// The limit in the drive's unit.
        counts: f64,
        /// Largest value.
        highest: i32,
    },
    /// A bus whose frames are on their way for longer than is kept.
    #[error("`delay` must be at most {highest} bus cycles, got {delay}: take a longer cycle")]
    Delay {
        /// Rejected delay (bus cycles).
        delay: u32,
        /// Longest one (bus cycles).
        highest: u32,
    },
}
