//! `MC_TorqueControl`: applies an effort.
use super::motion::{MotionBlock, MotionInputs};
use crate::blocks::{BlockName, Input};
use crate::command::{BufferMode, Command, Direction, Dynamics, Goal};
use crate::interface::{buffer_mode, command_outputs, direction, flag, inputs, limit, or, required};
use servobench_motion::Limits;

/// Applies an effort and keeps it; the load determines the motion.
pub type TorqueControl = MotionBlock<TorqueControlInputs>;

inputs! {
    /// Inputs of [`TorqueControl`].
    ///
    /// The drive receives the effort alone, so the axis only monitors Velocity: one that runs faster fails. Acceleration, Deceleration and
    /// Jerk, which would limit the motion, are therefore left out.
    pub struct TorqueControlInputs on execute {
        /// Torque (N·m or N), with a sign relative to the direction.
        torque: f64 = required(Input::Torque),
        /// TorqueRamp (N·m/s or N/s); infinite for a step.
        torque_ramp: f64 = or(Input::TorqueRamp, f64::INFINITY),
        /// Velocity (m/s or rad/s) that the axis may not exceed.
        velocity: f64 = limit(Input::Velocity).positive(),
        /// Direction: positive, negative or current.
        direction: Direction = direction(Direction::Positive),
        /// BufferMode.
        buffer_mode: BufferMode = buffer_mode(),
        /// ContinuousUpdate.
        continuous_update: bool = flag(Input::ContinuousUpdate, false),
    }
}

impl TorqueControlInputs {
    /// Inputs of zero effort, without a ramp, at any velocity that `limits` allow, not executed.
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

command_outputs! {
    /// Outputs of [`TorqueControl`].
    pub struct TorqueControlOutputs;
    /// InTorque: the commanded effort is reached.
    in_torque = InTorque by InTarget
}
