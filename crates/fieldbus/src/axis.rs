//! What a motion task and an axis tell each other, once per cycle of that task.
//!
//! Positions and velocities are in the axis unit (m or rad), efforts in the motor's (N·m or N).
use crate::{Fault, Interpolation};
use servobench_motion::interpolate::Sample;

/// What the motion task wants of the axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AxisCommand {
    /// Whether the axis is to be powered.
    pub power: bool,
    /// Its rising edge resets a fault.
    pub reset: bool,
    /// What the axis does while it is powered.
    pub task: Task,
}

/// What a powered axis does.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Task {
    /// Follows set-points, one per cycle.
    Follow(Sample),
    /// Gives an effort, one per cycle.
    Effort(f64),
    /// Looks for its reference by the drive's own procedure.
    Home {
        /// What the position of the reference is from then on.
        position: f64,
    },
}

/// What the motion task hears of the axis.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct AxisFeedback {
    /// Actual position.
    pub position: f64,
    /// Actual velocity.
    pub velocity: f64,
    /// Actual effort.
    pub effort: f64,
    /// How far the power is.
    pub power: Power,
    /// Fault of the drive or of the link to it; `None` without one.
    pub fault: Option<Fault>,
    /// How the set-points of the motion task arrive.
    pub interpolation: Interpolation,
    /// How far homing is.
    pub homing: Homing,
    /// The switches, inverted where they are wired so.
    pub switches: Switches,
}

/// How far the power of an axis is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Power {
    /// The motor carries no current.
    #[default]
    Off,
    /// On the way from one to the other.
    Switching,
    /// The axis is powered and does what is asked of it, unless there is a fault.
    On,
}

/// How far homing is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Homing {
    /// Not asked for.
    #[default]
    Idle,
    /// Under way.
    Busy,
    /// The reference is found and the axis stands still.
    Attained,
    /// The drive gave it up.
    Failed,
}

/// Limit and reference switches of an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Switches {
    /// Negative end.
    pub negative_limit: bool,
    /// Reference switch or index pulse.
    pub home: bool,
    /// Positive end.
    pub positive_limit: bool,
}
