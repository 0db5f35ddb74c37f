//! What a block asks of the axis.
use crate::blocks::BlockName;
use crate::error::BlockError;
use crate::params::AxisParams;
use servobench_base::{Stateful, finite, positive};
use servobench_motion::Limits;

servobench_config::choices! {
    /// How a command follows those before it (MC_BUFFER_MODE).
    #[derive(Stateful)]
    pub enum BufferMode default Aborting {
        /// the active motion is aborted
        Aborting = "aborting",
        /// the motion under way ends first
        Buffered = "buffered",
        /// its target is passed at the lower of both velocities
        BlendingLow = "blending-low",
        /// its target is passed at its own velocity
        BlendingPrevious = "blending-previous",
        /// its target is passed at the velocity of the next
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

    /// The velocity with which the end of the command before is to be passed; `None` where that one is done first.
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
        /// the shorter way of a modulo axis
        Shortest = "shortest",
        /// as the axis goes already
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

/// Velocity and its derivatives as a block limits them, magnitudes in the axis unit (m or rad).
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub struct Dynamics {
    /// Velocity (m/s or rad/s); `None` where the block has no such input.
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
    /// Those of a command for which nothing is planned.
    pub(crate) const NONE: Self =
        Self { velocity: Some(0.0), acceleration: 0.0, deceleration: 0.0, jerk: Some(0.0), snap: Some(0.0) };

    /// Those of a stop.
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

/// Where a motion leads, in the unit of the axis as the program sees it.
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub enum Goal {
    /// To a position.
    Absolute {
        /// Position (m or rad).
        position: f64,
        /// Which way round on a modulo axis.
        direction: Direction,
        /// Velocity with a sign at which it is passed and which is kept from then on (m/s or rad/s); `None` to be done there.
        end_velocity: Option<f64>,
    },
    /// By a distance from where the motion begins.
    Relative {
        /// Distance (m or rad).
        distance: f64,
        /// As of a position.
        end_velocity: Option<f64>,
    },
    /// By a distance from where the command before leads.
    Additive(f64),
    /// To a velocity, kept from then on; its sign counts in the direction.
    Velocity {
        /// Velocity (m/s or rad/s).
        velocity: f64,
        /// Which way.
        direction: Direction,
    },
    /// To rest.
    Rest,
    /// To a reference: the position counts from it.
    Reference(Reference),
    /// Against an obstacle, with limited effort: the position counts from it.
    Obstacle(Obstacle),
    /// By a distance away from the reference that was found, which ends homing.
    Away(f64),
    /// To an effort, kept from then on.
    Effort {
        /// Effort (N·m or N).
        effort: f64,
        /// Its rate (N·m/s or N/s), infinite for a step.
        ramp: f64,
        /// Which way.
        direction: Direction,
    },
    /// Along a course that the block itself gives, a set-point per cycle: see [`Axis::lead`](crate::Axis::lead).
    Led(Ending),
}

/// What the position counts from.
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub enum Reference {
    /// From what the drive looks for, which has this position (m or rad).
    Search(f64),
    /// From where the axis stands, which has this position (m or rad).
    Here(f64),
    /// From the zero of the drive's encoder.
    Encoder,
}

/// How an obstacle is looked for, and what counts as one: the axis gives the effort, within its tolerance, and is slower than the
/// velocity for so long.
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub struct Obstacle {
    /// Which way: positive or negative.
    pub direction: Direction,
    /// The position that the axis has at it (m or rad).
    pub position: f64,
    /// Velocity below which the axis is held (m/s or rad/s).
    pub velocity: f64,
    /// For how long (s).
    pub time: f64,
    /// Largest effort of the search (N·m or N).
    pub effort: f64,
    /// By how much the effort may be below it where the axis is held (N·m or N).
    pub effort_tolerance: f64,
    /// Longest time of the search (s); may be infinite.
    pub time_limit: f64,
    /// Longest way of the search (m or rad); may be infinite.
    pub distance_limit: f64,
}

impl Obstacle {
    /// 1 upwards, −1 downwards.
    pub(crate) fn sign(&self) -> f64 {
        if self.direction == Direction::Negative { -1.0 } else { 1.0 }
    }

    /// # Errors
    /// [`BlockError`] names the first input that cannot be.
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

/// What a course that a block gives leads to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Stateful)]
pub enum Ending {
    /// To rest.
    AtRest,
    /// To a velocity, which the axis keeps.
    Moving,
}

/// A command as the axis takes it.
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub struct Command {
    /// The block.
    pub block: BlockName,
    /// Where it leads.
    pub goal: Goal,
    /// What it may not exceed.
    pub dynamics: Dynamics,
    /// How it follows those before it.
    pub buffer_mode: BufferMode,
}

impl Command {
    /// Checks what does not depend on the state of the axis.
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

    /// Whether the axis is at Standstill when it is done.
    pub(crate) fn ends_at_standstill(&self) -> bool {
        !self.is_endless() && self.goal != Goal::Led(Ending::Moving)
    }

    /// Whether it keeps what it has reached until another one takes the axis from it.
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

    /// Whether it waits for the axis to be at Standstill, rather than for the command before it.
    pub(crate) const fn begins_at_standstill(&self) -> bool {
        matches!(self.goal, Goal::Reference(_) | Goal::Obstacle(_) | Goal::Away(_))
    }

    /// Whether it leaves the axis in Homing, where another step or the end of homing is to follow.
    pub(crate) const fn is_homing_step(&self) -> bool {
        matches!(self.goal, Goal::Obstacle(_))
    }

    /// Whether the position counts from a reference after it.
    pub(crate) const fn ends_homing(&self) -> bool {
        matches!(self.goal, Goal::Reference(_) | Goal::Away(_))
    }

    pub(crate) const fn wrong_buffer_mode(&self, bound: &'static str) -> BlockError {
        BlockError::BufferMode { block: self.block, value: self.buffer_mode.standard_name(), bound }
    }
}

/// What has no end has no shortest way to it.
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

/// A magnitude up to `limit`.
fn check_input(block: BlockName, input: &'static str, value: f64, limit: f64) -> Result<(), BlockError> {
    match positive(input, value) {
        Ok(_) if value > limit => Err(BlockError::AboveLimit { block, input, value, limit }),
        Ok(_) if (1.0 / LARGEST..=LARGEST).contains(&value) => Ok(()),
        _ => Err(BlockError::Input { block, input, value, bound: "positive, from 1e-15 to 1e15" }),
    }
}

/// What is larger, or smaller than its inverse, was written in the wrong unit; within it every plan is well within `f64`.
const LARGEST: f64 = 1e15;
