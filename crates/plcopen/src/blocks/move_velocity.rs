//! `MC_MoveVelocity`: moves to a velocity.
use super::motion::{MotionBlock, MotionInputs};
use crate::blocks::{BlockName, Input};
use crate::command::{BufferMode, Command, Direction, Dynamics, Goal};
use crate::interface::{buffer_mode, command_outputs, direction, flag, inputs, like, limit, limit_if_any};
use servobench_motion::Limits;

/// Moves to a velocity and keeps it.
pub type MoveVelocity = MotionBlock<MoveVelocityInputs>;

inputs! {
    /// Inputs of [`MoveVelocity`].
    pub struct MoveVelocityInputs on execute {
        /// Velocity (m/s or rad/s), with a sign relative to the direction.
        velocity: f64 = limit(Input::Velocity),
        /// Acceleration (m/s² or rad/s²).
        acceleration: f64 = limit(Input::Acceleration),
        /// Deceleration (m/s² or rad/s²).
        deceleration: f64 = like(Input::Deceleration, Input::Acceleration),
        /// Jerk (m/s³ or rad/s³); `None` leaves it to the axis.
        jerk: Option<f64> = limit_if_any(Input::Jerk),
        /// Snap (m/s⁴ or rad/s⁴), beyond the standard; `None` leaves it to the axis.
        snap: Option<f64> = limit_if_any(Input::Snap),
        /// Direction: positive, negative or current.
        direction: Direction = direction(Direction::Positive),
        /// BufferMode.
        buffer_mode: BufferMode = buffer_mode(),
        /// ContinuousUpdate.
        continuous_update: bool = flag(Input::ContinuousUpdate, false),
    }
}

impl MoveVelocityInputs {
    /// Inputs of a motion as fast as `limits` allow, not executed.
    #[must_use]
    pub fn within(limits: &Limits) -> Self {
        Self {
            execute: false,
            velocity: limits.velocity,
            acceleration: limits.acceleration,
            deceleration: limits.acceleration,
            jerk: Some(limits.jerk).filter(|jerk| jerk.is_finite()),
            snap: Some(limits.snap).filter(|snap| snap.is_finite()),
            direction: Direction::Positive,
            buffer_mode: BufferMode::default(),
            continuous_update: false,
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

command_outputs! {
    /// Outputs of [`MoveVelocity`].
    pub struct MoveVelocityOutputs;
    /// InVelocity: the commanded velocity is reached.
    in_velocity = InVelocity by InTarget
}
