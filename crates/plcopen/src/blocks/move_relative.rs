//! `MC_MoveRelative`: moves by a distance.
use super::motion::{MotionBlock, moves};
use super::outputs::MotionOutputs;
use crate::blocks::{BlockName, Input};
use crate::command::Goal;
use crate::interface::required;

/// Moves by a distance from the commanded position at the beginning.
pub type MoveRelative = MotionBlock<MoveRelativeInputs>;

moves! {
    /// Inputs of [`MoveRelative`].
    pub struct MoveRelativeInputs of MoveRelative -> MotionOutputs {
        /// Distance (m or rad).
        distance: f64 = required(Input::Distance),
    } {}
    |inputs| Goal::Relative { distance: inputs.distance, end_velocity: None }
}
