//! Commands from blocks to the axis.
use crate::blocks::BlockName;
use crate::error::BlockError;
use crate::params::AxisParams;
use servobench_base::{Stateful, finite, positive};
use servobench_motion::Limits;

servobench_config::choices! {
    /// Relation of a command to those before it (MC_BUFFER_MODE).
    #[derive(Stateful)]
    pub enum BufferMode default Aborting {
        /// the active motion is aborted
        Aborting = "aborting",
        /// the active motion ends first
        Buffered = "buffered",
        /// its target is passed at the lower of both velocities
        BlendingLow = "blending-low",
        /// its target is passed at the velocity of the active motion
        BlendingPrevious = "blending-previous",
        /// its target is passed at the velocity of this command
        BlendingNext = "blending-next",
        /// its target is passed at the higher of both velocities
        BlendingHigh = "blending-high",
    }
}

impl BufferMode {
    /// Name in the spelling of the standard.
    #[must_use]
    pub const fn standard_name(self) -> &'static str {
        match self {
            Self::Aborting => "mcAborting",
            Self::Buffered => "mcBuffered",
            Self::BlendingLow => "mcBlendingLow",
            Self::BlendingPrevious => "mcBlendingPrevious",
            Self::BlendingNext => "mcBlendingNext",
            Self::BlendingHigh => "mcBlendingHigh",
        }
    }

    /// Velocity with which the end of the previous command is passed; `None` if that command is done first.
    pub(crate) fn blending_velocity(self, before: f64, this: f64) -> Option<f64> {
        match self {
            Self::Aborting | Self::Buffered => None,
            Self::BlendingLow => Some(before.min(this)),
            Self::BlendingPrevious => Some(before),
            Self::BlendingNext => Some(this),
            Self::BlendingHigh => Some(before.max(this)),
        }
    }
}

servobench_config::choices! {
    /// Direction of rotation (MC_DIRECTION).
    #[derive(Stateful)]
    pub enum Direction default Shortest {
        /// upwards
        Positive = "positive",
        /// downwards
        Negative = "negative",
        /// the shorter distance on a modulo axis
        Shortest = "shortest",
        /// the direction in which the axis already moves
        Current = "current",
    }
}

impl Direction {
    /// Name in the spelling of the standard.
    #[must_use]
    pub const fn standard_name(self) -> &'static str {
        match self {
            Self::Positive => "mcPositiveDirection",
            Self::Shortest => "mcShortestWay",
            Self::Negative => "mcNegativeDirection",
            Self::Current => "mcCurrentDirection",
        }
    }
}

/// Limits of velocity and its derivatives from a block, magnitudes in the axis unit (m or rad).
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub struct Dynamics {
    /// Velocity (m/s or rad/s); `None` if the block has no such input.
    pub velocity: Option<f64>,
    /// Acceleration (m/s² or rad/s²).
    pub acceleration: f64,
    /// Deceleration (m/s² or rad/s²).
    pub deceleration: f64,
    /// Jerk (m/s³ or rad/s³); `None` leaves it to the axis.
    pub jerk: Option<f64>,
    /// Snap (m/s⁴ or rad/s⁴), beyond the standard; `None` leaves it to the axis.
    pub snap: Option<f64>,
}

impl Dynamics {
    /// Dynamics of a command for which nothing is planned.
    pub(crate) const NONE: Self =
        Self { velocity: Some(0.0), acceleration: 0.0, deceleration: 0.0, jerk: Some(0.0), snap: Some(0.0) };

    /// Dynamics of a stop.
    #[must_use]
    pub const fn braking(deceleration: f64, jerk: Option<f64>, snap: Option<f64>) -> Self {
        Self { velocity: None, acceleration: deceleration, deceleration, jerk, snap }
    }

    /// # Errors
    /// [`BlockError`] names the first input that is not positive or above the limit of the axis.
    pub(crate) fn check(&self, block: BlockName, limits: &Limits) -> Result<(), BlockError> {
        let inputs = [
            ("Velocity", self.velocity, limits.velocity),
            ("Acceleration", Some(self.acceleration), limits.acceleration),
            ("Deceleration", Some(self.deceleration), limits.acceleration),
            ("Jerk", self.jerk, limits.jerk),
            ("Snap", self.snap, limits.snap),
        ];
        for (input, value, limit) in inputs.into_iter().filter_map(|(input, value, limit)| Some((input, value?, limit)))
        {
            check_input(block, input, value, limit)?;
        }
        if self.snap.is_some() && self.jerk.unwrap_or(limits.jerk) == f64::INFINITY {
            let bound = "given where Snap is";
            return Err(BlockError::Input { block, input: "Jerk", value: f64::INFINITY, bound });
        }
        Ok(())
    }
}

/// Goal of a motion, in the unit of the axis as the program sees it.
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub enum Goal {
    /// To a position.
    Absolute {
        /// Position (m or rad).
        position: f64,
        /// Direction on a modulo axis.
        direction: Direction,
        /// Signed velocity at which the position is passed and which is kept from then on (m/s or rad/s); `None` to stop there.
        end_velocity: Option<f64>,
    },
    /// By a distance from the beginning of the motion.
    Relative {
        /// Distance (m or rad).
        distance: f64,
        /// Signed velocity at the end, as of a position (m/s or rad/s).
        end_velocity: Option<f64>,
    },
    /// By a distance from the target of the previous command.
    Additive(f64),
    /// To a velocity, kept from then on, with a sign relative to the direction.
    Velocity {
        /// Velocity (m/s or rad/s).
        velocity: f64,
        /// Direction of a positive velocity.
        direction: Direction,
    },
    /// To rest.
    Rest,
    /// To a reference: the position counts from it.
    Reference(Reference),
    /// Against an obstacle, with limited effort: the position counts from it.
    Obstacle(Obstacle),
    /// By a distance away from the reference, which ends homing.
    Away(f64),
    /// To an effort, kept from then on.
    Effort {
        /// Effort (N·m or N).
        effort: f64,
        /// Rate of change (N·m/s or N/s), infinite for a step.
        ramp: f64,
        /// Direction of a positive effort.
        direction: Direction,
    },
    /// Along a trajectory from the block itself, a set-point per cycle: see [`Axis::lead`](crate::Axis::lead).
    Led(Ending),
}

/// Reference of the position.
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub enum Reference {
    /// Reference found by the drive, with this position (m or rad).
    Search(f64),
    /// Present position of the axis, with this value (m or rad).
    Here(f64),
    /// Zero of the drive's encoder.
    Encoder,
}

/// Search for an obstacle, and its detection: the axis gives the effort, within its tolerance, and is slower than the velocity for the
/// given time.
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub struct Obstacle {
    /// Direction: positive or negative.
    pub direction: Direction,
    /// Position of the axis at the obstacle (m or rad).
    pub position: f64,
    /// Velocity below which the axis is held (m/s or rad/s).
    pub velocity: f64,
    /// Duration below that velocity (s).
    pub time: f64,
    /// Largest effort of the search (N·m or N).
    pub effort: f64,
    /// Tolerance of the effort below that, at the obstacle (N·m or N).
    pub effort_tolerance: f64,
    /// Longest time of the search (s); may be infinite.
    pub time_limit: f64,
    /// Longest distance of the search (m or rad); may be infinite.
    pub distance_limit: f64,
}

impl Obstacle {
    /// 1 upwards, −1 downwards.
    pub(crate) fn sign(&self) -> f64 {
        if self.direction == Direction::Negative { -1.0 } else { 1.0 }
    }

    /// # Errors
    /// [`BlockError`] names the first invalid input.
    fn check(&self, block: BlockName) -> Result<(), BlockError> {
        finite_input(block, "SetPosition", self.position)?;
        if !matches!(self.direction, Direction::Positive | Direction::Negative) {
            let value = self.direction.standard_name();
            let bound = "mcPositiveDirection or mcNegativeDirection";
            return Err(BlockError::Direction { block, value, bound });
        }
        for (input, value) in [
            ("DetectionVelocityLimit", self.velocity),
            ("TorqueLimit", self.effort),
            ("TorqueTolerance", self.effort_tolerance),
        ] {
            check_input(block, input, value, f64::INFINITY)?;
        }
        for (input, value) in [
            ("DetectionVelocityTime", self.time),
            ("TimeLimit", self.time_limit),
            ("DistanceLimit", self.distance_limit),
        ] {
            if value.is_nan() || value < 0.0 {
                return Err(BlockError::Input { block, input, value, bound: "zero or positive" });
            }
        }
        Ok(())
    }
}

/// End of a trajectory that a block gives.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Stateful)]
pub enum Ending {
    /// To rest.
    AtRest,
    /// To a velocity, which the axis keeps.
    Moving,
}

/// A command to the axis.
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub struct Command {
    /// Block that gave the command.
    pub block: BlockName,
    /// Goal.
    pub goal: Goal,
    /// Limits.
    pub dynamics: Dynamics,
    /// Relation to the commands before it.
    pub buffer_mode: BufferMode,
}

impl Command {
    /// Checks everything that does not depend on the state of the axis.
    pub(crate) fn check(&self, params: &AxisParams) -> Result<(), BlockError> {
        let block = self.block;
        if !matches!(self.goal, Goal::Effort { .. } | Goal::Reference(_)) {
            self.dynamics.check(block, &params.limits)?;
        }
        match self.goal {
            Goal::Absolute { position, end_velocity, .. } => {
                finite_input(block, "Position", position)?;
                self.check_end_velocity(end_velocity)?;
                if let Some(period) = params.modulo
                    && !(0.0..period).contains(&position)
                {
                    let bound = "within the modulo period, from 0 on";
                    return Err(BlockError::Input { block, input: "Position", value: position, bound });
                }
            }
            Goal::Relative { distance, end_velocity } => {
                finite_input(block, "Distance", distance)?;
                self.check_end_velocity(end_velocity)?;
            }
            Goal::Additive(distance) | Goal::Away(distance) => finite_input(block, "Distance", distance)?,
            Goal::Obstacle(obstacle) => obstacle.check(block)?,
            Goal::Velocity { velocity, direction } => {
                finite_input(block, "Velocity", velocity)?;
                if velocity.abs() > params.limits.velocity {
                    let (value, limit) = (velocity, params.limits.velocity);
                    return Err(BlockError::AboveLimit { block, input: "Velocity", value, limit });
                }
                endless_direction(block, direction)?;
            }
            Goal::Effort { effort, ramp, direction } => {
                finite_input(block, "Torque", effort)?;
                endless_direction(block, direction)?;
                if ramp.is_nan() || ramp <= 0.0 {
                    return Err(BlockError::Input { block, input: "TorqueRamp", value: ramp, bound: "positive" });
                }
                if let Some(velocity) = self.dynamics.velocity {
                    check_input(block, "Velocity", velocity, params.limits.velocity)?;
                }
            }
            Goal::Reference(reference) => {
                if let Reference::Search(position) | Reference::Here(position) = reference {
                    finite_input(block, "Position", position)?;
                }
            }
            Goal::Rest | Goal::Led(_) => {}
        }
        if self.begins_at_standstill() && !matches!(self.buffer_mode, BufferMode::Aborting | BufferMode::Buffered) {
            return Err(self.wrong_buffer_mode("mcAborting or mcBuffered, as homing begins at Standstill"));
        }
        Ok(())
    }

    fn check_end_velocity(&self, end_velocity: Option<f64>) -> Result<(), BlockError> {
        let (block, Some(value)) = (self.block, end_velocity) else { return Ok(()) };
        finite_input(block, "EndVelocity", value)?;
        if self.dynamics.velocity.is_some_and(|velocity| value.abs() > velocity) {
            let bound = "at most Velocity in magnitude";
            return Err(BlockError::Input { block, input: "EndVelocity", value, bound });
        }
        Ok(())
    }

    /// True if the axis is at Standstill when the command is done.
    pub(crate) fn ends_at_standstill(&self) -> bool {
        !self.is_endless() && self.goal != Goal::Led(Ending::Moving)
    }

    /// True if the command keeps its target until another one takes over.
    pub(crate) const fn is_endless(&self) -> bool {
        match self.goal {
            Goal::Absolute { end_velocity: Some(_), .. }
            | Goal::Relative { end_velocity: Some(_), .. }
            | Goal::Velocity { .. }
            | Goal::Effort { .. } => true,
            Goal::Absolute { end_velocity: None, .. }
            | Goal::Relative { end_velocity: None, .. }
            | Goal::Additive(_)
            | Goal::Away(_)
            | Goal::Rest
            | Goal::Reference(_)
            | Goal::Obstacle(_)
            | Goal::Led(_) => false,
        }
    }

    /// True if the command waits for Standstill, rather than for the previous command.
    pub(crate) const fn begins_at_standstill(&self) -> bool {
        matches!(self.goal, Goal::Reference(_) | Goal::Obstacle(_) | Goal::Away(_))
    }

    /// True if the command leaves the axis in Homing, to be followed by another step or the end of homing.
    pub(crate) const fn is_homing_step(&self) -> bool {
        matches!(self.goal, Goal::Obstacle(_))
    }

    /// True if the position counts from a reference after the command.
    pub(crate) const fn ends_homing(&self) -> bool {
        matches!(self.goal, Goal::Reference(_) | Goal::Away(_))
    }

    pub(crate) const fn wrong_buffer_mode(&self, bound: &'static str) -> BlockError {
        BlockError::BufferMode { block: self.block, value: self.buffer_mode.standard_name(), bound }
    }
}

/// Checks the direction of an endless motion, which has no shortest path.
fn endless_direction(block: BlockName, direction: Direction) -> Result<(), BlockError> {
    let value = direction.standard_name();
    match direction {
        Direction::Shortest => Err(BlockError::Direction { block, value, bound: "a direction to run in" }),
        Direction::Positive | Direction::Negative | Direction::Current => Ok(()),
    }
}

pub(crate) fn finite_input(block: BlockName, input: &'static str, value: f64) -> Result<(), BlockError> {
    match finite(input, value) {
        Ok(_) if value.abs() <= LARGEST => Ok(()),
        _ => Err(BlockError::Input { block, input, value, bound: "a number within ±1e15" }),
    }
}

/// Checks a magnitude against `limit`.
fn check_input(block: BlockName, input: &'static str, value: f64, limit: f64) -> Result<(), BlockError> {
    match positive(input, value) {
        Ok(_) if value > limit => Err(BlockError::AboveLimit { block, input, value, limit }),
        Ok(_) if (1.0 / LARGEST..=LARGEST).contains(&value) => Ok(()),
        _ => Err(BlockError::Input { block, input, value, bound: "positive, from 1e-15 to 1e15" }),
    }
}

/// Largest plausible magnitude, and inverse of the smallest: a value outside was written in the wrong unit; within, every plan fits `f64`.
const LARGEST: f64 = 1e15;
