//! `MC_MoveAdditive`: moves by a distance from the last target.
use super::motion::{MotionBlock, moves};
use super::outputs::MotionOutputs;
use crate::blocks::{BlockName, Input};
use crate::command::Goal;
use crate::interface::required;

/// Moves by a distance from the target of the last command; in ContinuousMotion from the commanded position.
pub type MoveAdditive = MotionBlock<MoveAdditiveInputs>;

moves! {
    /// Inputs of [`MoveAdditive`].
    pub struct MoveAdditiveInputs of MoveAdditive -> MotionOutputs {
        /// Distance (m or rad).
        distance: f64 = required(Input::Distance),
    } {}
    |inputs| Goal::Additive(inputs.distance)
}
