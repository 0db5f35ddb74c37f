//! `MC_MoveVelocity`: to a velocity.
use super::execution::Report;
use super::motion::{MotionBlock, MotionInputs};
use super::outputs::{Outputs, flag, number};
use crate::command::{BufferMode, Command, Direction, Dynamics, Goal};
use crate::error::ErrorId;
use crate::name::BlockName;
use servobench_motion::Limits;

/// To a velocity, which is kept.
pub type MoveVelocity = MotionBlock<MoveVelocityInputs>;

/// Inputs of [`MoveVelocity`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MoveVelocityInputs {
    /// Execute.
    pub execute: bool,
    /// ContinuousUpdate.
    pub continuous_update: bool,
    /// Velocity (m/s or rad/s); a sign counts in the direction.
    pub velocity: f64,
    /// Acceleration (m/s² or rad/s²).
    pub acceleration: f64,
    /// Deceleration (m/s² or rad/s²).
    pub deceleration: f64,
    /// Jerk (m/s³ or rad/s³); `None` leaves it to the axis.
    pub jerk: Option<f64>,
    /// Snap (m/s⁴ or rad/s⁴), beyond the standard; `None` leaves it to the axis.
    pub snap: Option<f64>,
    /// Direction: positive, negative or current.
    pub direction: Direction,
    /// BufferMode.
    pub buffer_mode: BufferMode,
}

impl MoveVelocityInputs {
    /// As fast as `limits` allow, not executed.
    #[must_use]
    pub fn within(limits: &Limits) -> Self {
        Self {
            execute: false,
            continuous_update: false,
            velocity: limits.velocity,
            acceleration: limits.acceleration,
            deceleration: limits.acceleration,
            jerk: Some(limits.jerk).filter(|jerk| jerk.is_finite()),
            snap: Some(limits.snap).filter(|snap| snap.is_finite()),
            direction: Direction::Positive,
            buffer_mode: BufferMode::default(),
        }
    }
}

impl MotionInputs for MoveVelocityInputs {
    const NAME: BlockName = BlockName::MoveVelocity;
    type Outputs = MoveVelocityOutputs;

    fn execute(&self) -> bool {
        self.execute
    }

    fn continuous_update(&self) -> bool {
        self.continuous_update
    }

    fn command(&self) -> Command {
        let Self { velocity, acceleration, deceleration, jerk, snap, direction, buffer_mode, .. } = *self;
        Command {
            block: Self::NAME,
            goal: Goal::Velocity { velocity, direction },
            dynamics: Dynamics { velocity: None, acceleration, deceleration, jerk, snap },
            buffer_mode,
        }
    }
}

/// Outputs of [`MoveVelocity`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[expect(clippy::struct_excessive_bools, reason = "each is an output of the standard")]
pub struct MoveVelocityOutputs {
    /// InVelocity: the commanded velocity is reached.
    pub in_velocity: bool,
    /// Busy: the block is not aborted.
    pub busy: bool,
    /// Active: the block has the axis.
    pub active: bool,
    /// CommandAborted: another command took the axis.
    pub command_aborted: bool,
    /// Error.
    pub error: bool,
    /// ErrorID.
    pub error_id: ErrorId,
}

impl From<Report> for MoveVelocityOutputs {
    fn from(report: Report) -> Self {
        Self {
            in_velocity: report == Report::InTarget,
            busy: report.is_busy(),
            active: report.is_active(),
            command_aborted: report == Report::Aborted,
            error: report.error_id() != ErrorId::None,
            error_id: report.error_id(),
        }
    }
}

impl Outputs for MoveVelocityOutputs {
    const NAMES: &'static [&'static str] = &["InVelocity", "Busy", "Active", "CommandAborted", "Error", "ErrorID"];

    fn each(&self, record: impl FnMut(f64)) {
        let Self { in_velocity, busy, active, command_aborted, error, error_id } = *self;
        let flags = [in_velocity, busy, active, command_aborted, error].map(flag);
        flags.into_iter().chain([number(error_id)]).for_each(record);
    }
}
