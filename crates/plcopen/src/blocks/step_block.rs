//! `MC_StepBlock` of part 5: an obstacle as the reference.
use super::motion::{MotionBlock, MotionInputs};
use super::outputs::MotionOutputs;
use crate::blocks::{BlockName, Input};
use crate::command::{BufferMode, Command, Direction, Dynamics, Goal, Obstacle};
use crate::interface::{buffer_mode, direction, inputs, like, limit, limit_if_any, optional, or, required};
use servobench_motion::Limits;

/// Moves against an obstacle that blocks the axis, where the position is set to the given one. A homing step, which leaves the axis there
/// and in Homing; `MC_FinishHoming` ends that.
pub type StepBlock = MotionBlock<StepBlockInputs>;

/// Default TorqueTolerance, as a part of TorqueLimit.
const TOLERANCE: f64 = 0.05;

inputs! {
    /// Inputs of [`StepBlock`].
    pub struct StepBlockInputs on execute {
        /// Velocity of the search (m/s or rad/s).
        velocity: f64 = required(Input::Velocity).positive(),
        /// Acceleration (m/s² or rad/s²).
        acceleration: f64 = limit(Input::Acceleration),
        /// Deceleration (m/s² or rad/s²).
        deceleration: f64 = like(Input::Deceleration, Input::Acceleration),
        /// Jerk (m/s³ or rad/s³); `None` leaves it to the axis.
        jerk: Option<f64> = limit_if_any(Input::Jerk),
        /// Snap (m/s⁴ or rad/s⁴), beyond the standard; `None` leaves it to the axis.
        snap: Option<f64> = limit_if_any(Input::Snap),
        /// Direction: positive or negative.
        direction: Direction = direction(Direction::Positive),
        /// SetPosition: the position of the axis at the obstacle (m or rad).
        position: f64 = or(Input::Position, 0.0),
        /// DetectionVelocityLimit (m/s or rad/s): velocity below which the axis is held by an obstacle.
        detection_velocity_limit: f64 = required(Input::DetectionVelocityLimit),
        /// DetectionVelocityTime (s): duration for which the velocity must be that low.
        detection_velocity_time: f64 = required(Input::DetectionVelocityTime),
        /// TorqueLimit (N·m or N).
        torque_limit: f64 = required(Input::TorqueLimit),
        /// TorqueTolerance (N·m or N), beyond the standard; `None` for 5 % of the limit.
        torque_tolerance: Option<f64> = optional(Input::TorqueTolerance),
        /// TimeLimit (s).
        time_limit: f64 = or(Input::TimeLimit, f64::INFINITY),
        /// DistanceLimit (m or rad).
        distance_limit: f64 = or(Input::DistanceLimit, f64::INFINITY),
        /// BufferMode: aborting or buffered.
        buffer_mode: BufferMode = buffer_mode(),
    }
}

impl StepBlockInputs {
    /// Inputs of a search upwards with at most `torque` (N·m or N) and a tenth of the velocity of `limits`, until the axis has been slower
    /// than a tenth of that for 50 ms; not executed.
    #[must_use]
    pub fn pushing(torque: f64, limits: &Limits) -> Self {
        let velocity = 0.1 * limits.velocity;
        Self {
            execute: false,
            velocity,
            acceleration: limits.acceleration,
            deceleration: limits.acceleration,
            jerk: Some(limits.jerk).filter(|jerk| jerk.is_finite()),
            snap: Some(limits.snap).filter(|snap| snap.is_finite()),
            direction: Direction::Positive,
            position: 0.0,
            detection_velocity_limit: 0.1 * velocity,
            detection_velocity_time: 0.05,
            torque_limit: torque,
            torque_tolerance: None,
            time_limit: f64::INFINITY,
            distance_limit: f64::INFINITY,
            buffer_mode: BufferMode::default(),
        }
    }
}

impl MotionInputs for StepBlockInputs {
    const NAME: BlockName = BlockName::StepBlock;
    type Outputs = MotionOutputs;

    fn execute(&self) -> bool {
        self.execute
    }

    fn command(&self) -> Command {
        let Self { velocity, acceleration, deceleration, jerk, snap, buffer_mode, .. } = *self;
        let obstacle = Obstacle {
            direction: self.direction,
            position: self.position,
            velocity: self.detection_velocity_limit,
            time: self.detection_velocity_time,
            effort: self.torque_limit,
            effort_tolerance: self.torque_tolerance.unwrap_or(TOLERANCE * self.torque_limit),
            time_limit: self.time_limit,
            distance_limit: self.distance_limit,
        };
        Command {
            block: Self::NAME,
            goal: Goal::Obstacle(obstacle),
            dynamics: Dynamics { velocity: Some(velocity), acceleration, deceleration, jerk, snap },
            buffer_mode,
        }
    }
}
