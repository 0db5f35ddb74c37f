//! `MC_MoveRelative`: by a distance.
use super::motion::{MotionBlock, moves};
use super::outputs::MotionOutputs;
use crate::blocks::{BlockName, Input};
use crate::command::Goal;
use crate::interface::required;

/// By a distance, counted from where the axis is commanded to be when the motion begins.
pub type MoveRelative = MotionBlock<MoveRelativeInputs>;

moves! {
    /// Inputs of [`MoveRelative`].
    pub struct MoveRelativeInputs of MoveRelative -> MotionOutputs {
        /// Distance (m or rad).
        distance: f64 = required(Input::Distance),
    } {}
    |inputs| Goal::Relative { distance: inputs.distance, end_velocity: None }
}
