//! Errors in the settings of a link or a bus.
use servobench_base::ParamError;
use servobench_motion::PlanError;
use thiserror::Error;

/// A refused setting, with its bound.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum FieldbusError {
    /// A number out of its bound.
    #[error(transparent)]
    Parameter(#[from] ParamError),
    /// A limit with which no stop can be planned.
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
        /// Largest slack (base ticks).
        highest: u64,
    },
    /// A prediction beyond the present, or longer than supported.
    #[error(
        "`run_ahead` must be at most {highest} cycles of the motion task with this interpolation, got {ahead}: that leaves no delay to \
         take out"
    )]
    RunAhead {
        /// Rejected number of cycles.
        ahead: u32,
        /// Largest number of cycles.
        highest: usize,
    },
    /// A time-out too short for the answer of a sound drive.
    #[error("`drive_timeout` must be longer than the round trip of {round_trip} ticks, got {timeout} ticks")]
    ShortTimeout {
        /// Rejected time-out (base ticks).
        timeout: u64,
        /// Time from a command to the first answer that reflects it (base ticks).
        round_trip: u64,
    },
    /// A position loop in the master with a too old position.
    #[error("`round_trip` and `answer_age` must be at most {highest} ticks together, got {delay}: take a longer cycle")]
    OldAnswer {
        /// Rejected sum (base ticks).
        delay: u64,
        /// Largest sum (base ticks).
        highest: u64,
    },
    /// An integral with which no gain is stable.
    #[error(
        "the integral time of the master's position loop must be longer than {lowest} s, the age of the position and half a cycle, got \
         {time} s: with a shorter one the loop is unstable at every gain"
    )]
    ShortIntegral {
        /// Rejected integral time (s).
        time: f64,
        /// Exclusive lower bound (s).
        lowest: f64,
    },
    /// A velocity of the axis that the drive's unit cannot express.
    #[error(
        "`velocity_limit` is {counts:e} in the drive's velocity unit, at most {highest} fits 32 bits: choose a coarser \
         unit"
    )]
    FineVelocity {
        /// Limit in the drive's unit.
        counts: f64,
        /// Largest value.
        highest: i32,
    },
    /// A bus with too long a delay.
    #[error("`delay` must be at most {highest} bus cycles, got {delay}: take a longer cycle")]
    Delay {
        /// Rejected delay (bus cycles).
        delay: u32,
        /// Longest delay (bus cycles).
        highest: u32,
    },
}
