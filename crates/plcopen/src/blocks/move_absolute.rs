//! `MC_MoveAbsolute`: to a position.
use super::motion::{MotionBlock, MotionInputs};
use super::outputs::MotionOutputs;
use crate::command::{BufferMode, Command, Direction, Dynamics, Goal};
use crate::name::BlockName;
use servobench_motion::Limits;

/// To a position, counted from the reference.
pub type MoveAbsolute = MotionBlock<MoveAbsoluteInputs>;

/// Inputs of [`MoveAbsolute`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MoveAbsoluteInputs {
    /// Execute.
    pub execute: bool,
    /// ContinuousUpdate.
    pub continuous_update: bool,
    /// Position (m or rad).
    pub position: f64,
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
    /// Direction, for modulo axes.
    pub direction: Direction,
    /// BufferMode.
    pub buffer_mode: BufferMode,
}

impl MoveAbsoluteInputs {
    /// To position 0 as fast as `limits` allow, not executed.
    #[must_use]
    pub fn within(limits: &Limits) -> Self {
        Self {
            execute: false,
            continuous_update: false,
            position: 0.0,
            velocity: limits.velocity,
            acceleration: limits.acceleration,
            deceleration: limits.acceleration,
            jerk: Some(limits.jerk).filter(|jerk| jerk.is_finite()),
            snap: Some(limits.snap).filter(|snap| snap.is_finite()),
            direction: Direction::default(),
            buffer_mode: BufferMode::default(),
        }
    }
}

impl MotionInputs for MoveAbsoluteInputs {
    const NAME: BlockName = BlockName::MoveAbsolute;
    type Outputs = MotionOutputs;

    fn execute(&self) -> bool {
        self.execute
    }

    fn continuous_update(&self) -> bool {
        self.continuous_update
    }

    fn command(&self) -> Command {
        let Self { position, velocity, acceleration, deceleration, jerk, snap, direction, buffer_mode, .. } = *self;
        Command {
            block: Self::NAME,
            goal: Goal::Absolute { position, direction, end_velocity: None },
            dynamics: Dynamics { velocity: Some(velocity), acceleration, deceleration, jerk, snap },
            buffer_mode,
        }
    }
}
