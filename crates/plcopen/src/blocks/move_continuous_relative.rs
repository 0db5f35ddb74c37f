//! `MC_MoveContinuousRelative`: moves by a distance, passes its end at a velocity and keeps that.
use super::motion::{MotionBlock, moves};
use super::move_continuous_absolute::MoveContinuousAbsoluteOutputs;
use crate::blocks::{BlockName, Input};
use crate::command::Goal;
use crate::interface::required;

/// Moves by a distance from the commanded position at the beginning, passes its end at a velocity and keeps that from then on.
pub type MoveContinuousRelative = MotionBlock<MoveContinuousRelativeInputs>;

moves! {
    /// Inputs of [`MoveContinuousRelative`].
    pub struct MoveContinuousRelativeInputs of MoveContinuousRelative -> MoveContinuousAbsoluteOutputs {
        /// Distance (m or rad).
        distance: f64 = required(Input::Distance),
        /// EndVelocity, with its sign (m/s or rad/s); at zero the axis stands there, in Continuous Motion.
        end_velocity: f64 = required(Input::EndVelocity),
    } {}
    |inputs| Goal::Relative { distance: inputs.distance, end_velocity: Some(inputs.end_velocity) }
}
