//! `MC_MoveRelative`: by a distance.
use super::motion::{MotionBlock, MotionInputs};
use super::outputs::MotionOutputs;
use crate::command::{BufferMode, Command, Dynamics, Goal};
use crate::name::BlockName;
use servobench_motion::Limits;

/// By a distance, counted from where the axis is commanded to be when the motion begins.
pub type MoveRelative = MotionBlock<MoveRelativeInputs>;

/// Inputs of [`MoveRelative`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MoveRelativeInputs {
    /// Execute.
    pub execute: bool,
    /// ContinuousUpdate.
    pub continuous_update: bool,
    /// Distance (m or rad).
    pub distance: f64,
    /// Velocity (m/s or rad/s).
    pub velocity: f64,
    /// Acceleration (m/s² or rad/s²).
    pub acceleration: f64,
    /// Deceleration (m/s² or rad/s²).
    pub deceleration: f64,
    /// Jerk (m/s³ or rad/s³); `None` leaves it to the axis.
    pub jerk: Option<f64>,
    /// Snap (m/s⁴ or rad/s⁴), beyond the standard; `None` leaves it to the axis.
    pub snap: Option<f64>,
    /// BufferMode.
    pub buffer_mode: BufferMode,
}

impl MoveRelativeInputs {
    /// By no distance as fast as `limits` allow, not executed.
    #[must_use]
    pub fn within(limits: &Limits) -> Self {
        Self {
            execute: false,
            continuous_update: false,
            distance: 0.0,
            velocity: limits.velocity,
            acceleration: limits.acceleration,
            deceleration: limits.acceleration,
            jerk: Some(limits.jerk).filter(|jerk| jerk.is_finite()),
            snap: Some(limits.snap).filter(|snap| snap.is_finite()),
            buffer_mode: BufferMode::default(),
        }
    }
}

impl MotionInputs for MoveRelativeInputs {
    const NAME: BlockName = BlockName::MoveRelative;
    type Outputs = MotionOutputs;

    fn execute(&self) -> bool {
        self.execute
    }

    fn continuous_update(&self) -> bool {
        self.continuous_update
    }

    fn command(&self) -> Command {
        let Self { distance, velocity, acceleration, deceleration, jerk, snap, buffer_mode, .. } = *self;
        Command {
            block: Self::NAME,
            goal: Goal::Relative(distance),
            dynamics: Dynamics { velocity: Some(velocity), acceleration, deceleration, jerk, snap },
            buffer_mode,
        }
    }
}
