//! `MC_MoveContinuousAbsolute`: to a position that is passed at a velocity, which is kept.
use super::execution::Report;
use super::motion::{MotionBlock, MotionInputs};
use super::outputs::{Outputs, flag, number};
use crate::command::{BufferMode, Command, Direction, Dynamics, Goal};
use crate::error::ErrorId;
use crate::name::BlockName;
use servobench_motion::Limits;

/// To a position that is passed at a velocity, which is kept from then on.
pub type MoveContinuousAbsolute = MotionBlock<MoveContinuousAbsoluteInputs>;

/// Inputs of [`MoveContinuousAbsolute`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MoveContinuousAbsoluteInputs {
    /// Execute.
    pub execute: bool,
    /// ContinuousUpdate.
    pub continuous_update: bool,
    /// Position (m or rad).
    pub position: f64,
    /// EndVelocity, with its sign (m/s or rad/s); at zero the axis stands there, in Continuous Motion.
    pub end_velocity: f64,
    /// Velocity (m/s or rad/s).
    pub velocity: f64,
    /// Acceleration (m/s² or rad/s²).
    pub acceleration: f64,
    /// Deceleration (m/s² or rad/s²).
    pub deceleration: f64,
    /// Jerk (m/s³ or rad/s³); `None` leaves it to the axis.
    pub jerk: Option<f64>,
    /// Snap (m/s⁴ or rad/s⁴), beyond the standard; `None` leaves it to the axis.
    pub snap: Option<f64>,
    /// Direction, for modulo axes.
    pub direction: Direction,
    /// BufferMode.
    pub buffer_mode: BufferMode,
}

impl MoveContinuousAbsoluteInputs {
    /// To position 0 as fast as `limits` allow, not executed.
    #[must_use]
    pub fn within(limits: &Limits) -> Self {
        Self {
            execute: false,
            continuous_update: false,
            position: 0.0,
            end_velocity: 0.0,
            velocity: limits.velocity,
            acceleration: limits.acceleration,
            deceleration: limits.acceleration,
            jerk: Some(limits.jerk).filter(|jerk| jerk.is_finite()),
            snap: Some(limits.snap).filter(|snap| snap.is_finite()),
            direction: Direction::default(),
            buffer_mode: BufferMode::default(),
        }
    }
}

impl MotionInputs for MoveContinuousAbsoluteInputs {
    const NAME: BlockName = BlockName::MoveContinuousAbsolute;
    type Outputs = MoveContinuousAbsoluteOutputs;

    fn execute(&self) -> bool {
        self.execute
    }

    fn continuous_update(&self) -> bool {
        self.continuous_update
    }

    fn command(&self) -> Command {
        let Self { position, end_velocity, direction, buffer_mode, .. } = *self;
        let Self { velocity, acceleration, deceleration, jerk, snap, .. } = *self;
        Command {
            block: Self::NAME,
            goal: Goal::Absolute { position, direction, end_velocity: Some(end_velocity) },
            dynamics: Dynamics { velocity: Some(velocity), acceleration, deceleration, jerk, snap },
            buffer_mode,
        }
    }
}

/// Outputs of [`MoveContinuousAbsolute`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[expect(clippy::struct_excessive_bools, reason = "each is an output of the standard")]
pub struct MoveContinuousAbsoluteOutputs {
    /// InEndVelocity: the position is passed at EndVelocity, which is kept.
    pub in_end_velocity: bool,
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

impl From<Report> for MoveContinuousAbsoluteOutputs {
    fn from(report: Report) -> Self {
        Self {
            in_end_velocity: report == Report::InTarget,
            busy: report.is_busy(),
            active: report.is_active(),
            command_aborted: report == Report::Aborted,
            error: report.error_id() != ErrorId::None,
            error_id: report.error_id(),
        }
    }
}

impl Outputs for MoveContinuousAbsoluteOutputs {
    const NAMES: &'static [&'static str] = &["InEndVelocity", "Busy", "Active", "CommandAborted", "Error", "ErrorID"];

    fn each(&self, record: impl FnMut(f64)) {
        let Self { in_end_velocity, busy, active, command_aborted, error, error_id } = *self;
        let flags = [in_end_velocity, busy, active, command_aborted, error].map(flag);
        flags.into_iter().chain([number(error_id)]).for_each(record);
    }
}
