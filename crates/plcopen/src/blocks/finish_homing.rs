//! `MC_FinishHoming` of part 5: the end of steps of homing.
use super::motion::{MotionBlock, moves};
use super::outputs::MotionOutputs;
use crate::blocks::{BlockName, Input};
use crate::command::Goal;
use crate::interface::or;

/// By a distance away from the reference that the steps of homing have found, which is what the position counts from then on.
/// Without such a step the axis is not homed by it.
pub type FinishHoming = MotionBlock<FinishHomingInputs>;

moves! {
    /// Inputs of [`FinishHoming`].
    pub struct FinishHomingInputs of FinishHoming -> MotionOutputs {
        /// Distance (m or rad); zero to stay.
        distance: f64 = or(Input::Distance, 0.0),
    } {}
    |inputs| Goal::Away(inputs.distance)
}
