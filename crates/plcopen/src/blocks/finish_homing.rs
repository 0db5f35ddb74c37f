//! `MC_FinishHoming` of part 5: the end of homing steps.
use super::motion::{MotionBlock, moves};
use super::outputs::MotionOutputs;
use crate::blocks::{BlockName, Input};
use crate::command::Goal;
use crate::interface::or;

/// Moves by a distance away from the reference found by the homing steps, from which the position counts from then on. Without such a step
/// it does not home the axis.
pub type FinishHoming = MotionBlock<FinishHomingInputs>;

moves! {
    /// Inputs of [`FinishHoming`].
    pub struct FinishHomingInputs of FinishHoming -> MotionOutputs {
        /// Distance (m or rad); zero to stay.
        distance: f64 = or(Input::Distance, 0.0),
    } {}
    |inputs| Goal::Away(inputs.distance)
}
