//! `MC_MoveContinuousAbsolute`: passes a position at a velocity and keeps that.
use super::motion::{MotionBlock, moves};
use crate::blocks::{BlockName, Input};
use crate::command::{Direction, Goal};
use crate::interface::{command_outputs, direction, required};

/// Passes a position at a velocity and keeps that from then on.
pub type MoveContinuousAbsolute = MotionBlock<MoveContinuousAbsoluteInputs>;

moves! {
    /// Inputs of [`MoveContinuousAbsolute`].
    pub struct MoveContinuousAbsoluteInputs of MoveContinuousAbsolute -> MoveContinuousAbsoluteOutputs {
        /// Position (m or rad).
        position: f64 = required(Input::Position),
        /// EndVelocity, with its sign (m/s or rad/s); at zero the axis stands there, in Continuous Motion.
        end_velocity: f64 = required(Input::EndVelocity),
    } {
        /// Direction, for modulo axes.
        direction: Direction = direction(Direction::Shortest),
    }
    |inputs| Goal::Absolute {
        position: inputs.position,
        direction: inputs.direction,
        end_velocity: Some(inputs.end_velocity),
    }
}

command_outputs! {
    /// Outputs of [`MoveContinuousAbsolute`].
    pub struct MoveContinuousAbsoluteOutputs;
    /// InEndVelocity: the position is passed at EndVelocity, which is kept.
    in_end_velocity = InEndVelocity by InTarget
}
