//! `MC_MoveAbsolute`: moves to a position.
use super::motion::{MotionBlock, moves};
use super::outputs::MotionOutputs;
use crate::blocks::{BlockName, Input};
use crate::command::{Direction, Goal};
use crate::interface::{direction, required};

/// Moves to a position, counted from the reference.
pub type MoveAbsolute = MotionBlock<MoveAbsoluteInputs>;

moves! {
    /// Inputs of [`MoveAbsolute`].
    pub struct MoveAbsoluteInputs of MoveAbsolute -> MotionOutputs {
        /// Position (m or rad).
        position: f64 = required(Input::Position),
    } {
        /// Direction, for modulo axes.
        direction: Direction = direction(Direction::Shortest),
    }
    |inputs| Goal::Absolute { position: inputs.position, direction: inputs.direction, end_velocity: None }
}
