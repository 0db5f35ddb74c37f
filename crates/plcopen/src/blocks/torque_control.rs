//! `MC_TorqueControl`: to an effort.
use super::execution::Report;
use super::motion::{MotionBlock, MotionInputs};
use super::outputs::{Outputs, flag, number};
use crate::command::{BufferMode, Command, Direction, Dynamics, Goal};
use crate::error::ErrorId;
use crate::name::BlockName;
use servobench_motion::Limits;

/// To an effort, which is kept; the axis moves as its load lets it.
pub type TorqueControl = MotionBlock<TorqueControlInputs>;

/// Inputs of [`TorqueControl`].
///
/// The drive is given the effort alone, so that the axis only watches Velocity: one that runs faster fails. Acceleration,
/// Deceleration and Jerk, which would limit the motion, are left out for that reason.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TorqueControlInputs {
    /// Execute.
    pub execute: bool,
    /// ContinuousUpdate.
    pub continuous_update: bool,
    /// Torque (N·m or N); a sign counts in the direction.
    pub torque: f64,
    /// TorqueRamp (N·m/s or N/s); infinite for a step.
    pub torque_ramp: f64,
    /// Velocity (m/s or rad/s) that the axis may not exceed.
    pub velocity: f64,
    /// Direction: positive, negative or current.
    pub direction: Direction,
    /// BufferMode.
    pub buffer_mode: BufferMode,
}

impl TorqueControlInputs {
    /// No effort, at once, at any velocity that `limits` allow, not executed.
    #[must_use]
    pub fn within(limits: &Limits) -> Self {
        Self {
            execute: false,
            continuous_update: false,
            torque: 0.0,
            torque_ramp: f64::INFINITY,
            velocity: limits.velocity,
            direction: Direction::Positive,
            buffer_mode: BufferMode::default(),
        }
    }
}

impl MotionInputs for TorqueControlInputs {
    const NAME: BlockName = BlockName::TorqueControl;
    type Outputs = TorqueControlOutputs;

    fn execute(&self) -> bool {
        self.execute
    }

    fn continuous_update(&self) -> bool {
        self.continuous_update
    }

    fn command(&self) -> Command {
        let Self { torque: effort, torque_ramp: ramp, velocity, direction, buffer_mode, .. } = *self;
        let dynamics = Dynamics { velocity: Some(velocity), ..Dynamics::braking(f64::INFINITY, None, None) };
        Command { block: Self::NAME, goal: Goal::Effort { effort, ramp, direction }, dynamics, buffer_mode }
    }
}

/// Outputs of [`TorqueControl`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[expect(clippy::struct_excessive_bools, reason = "each is an output of the standard")]
pub struct TorqueControlOutputs {
    /// InTorque: the commanded effort is reached.
    pub in_torque: bool,
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

impl From<Report> for TorqueControlOutputs {
    fn from(report: Report) -> Self {
        Self {
            in_torque: report == Report::InTarget,
            busy: report.is_busy(),
            active: report.is_active(),
            command_aborted: report == Report::Aborted,
            error: report.error_id() != ErrorId::None,
            error_id: report.error_id(),
        }
    }
}

impl Outputs for TorqueControlOutputs {
    const NAMES: &'static [&'static str] = &["InTorque", "Busy", "Active", "CommandAborted", "Error", "ErrorID"];

    fn each(&self, record: impl FnMut(f64)) {
        let Self { in_torque, busy, active, command_aborted, error, error_id } = *self;
        let flags = [in_torque, busy, active, command_aborted, error].map(flag);
        flags.into_iter().chain([number(error_id)]).for_each(record);
    }
}
