//! What a motion task and an axis tell each other, once per cycle of that task.
//!
//! Positions and velocities are in the axis unit (m or rad), efforts in the motor's (N·m or N).
use crate::{Fault, Interpolation, ProbeFeedback, TouchProbe};
use servobench_base::Stateful;
use servobench_cia402::InterpolationData;
use servobench_motion::interpolate::Sample;

/// What the motion task wants of the axis.
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub struct AxisCommand {
    /// Whether the axis is to be powered.
    pub power: bool,
    /// Its rising edge resets a fault.
    pub reset: bool,
    /// What the axis does while it is powered.
    pub task: Task,
    /// Bits of the drive's digital outputs (60FEh).
    pub digital_outputs: u32,
    /// What the drive's touch probe is asked for.
    pub touch_probe: Option<TouchProbe>,
    /// Largest effort in either direction (6072h), a magnitude; `None` leaves it to the drive, which is also what a drive may
    /// lower it to.
    pub effort_limit: Option<f64>,
}

impl AxisCommand {
    /// A powered axis that does `task`, and nothing else.
    #[must_use]
    pub const fn of(task: Task) -> Self {
        Self { power: true, reset: false, task, digital_outputs: 0, touch_probe: None, effort_limit: None }
    }
}

/// What a powered axis does.
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
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
    /// Leaves the way to the drive.
    Drive(ProfileCommand),
}

/// A profile that the drive generates itself, in a mode of its own. Velocities and accelerations that are zero are left to the drive.
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub enum ProfileCommand {
    /// To a position, at rest (pp). Another number is another set-point; it begins where the last one ends.
    Position {
        /// Number of the set-point, from 1.
        number: u32,
        /// Where to.
        position: f64,
        /// Largest velocity.
        velocity: f64,
        /// Largest acceleration and deceleration.
        acceleration: f64,
    },
    /// To a velocity, on a straight ramp (pv).
    Velocity {
        /// Velocity.
        velocity: f64,
        /// Acceleration and deceleration.
        acceleration: f64,
    },
    /// Along the points of its buffer (ip).
    Points {
        /// A point for the buffer, or a command to it; sent once.
        point: Option<TrajectoryPoint>,
        /// Whether the points are followed.
        follow: bool,
    },
}

/// A point on its way to the buffer of a drive, by one of the objects that lead there.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Stateful)]
pub enum TrajectoryPoint {
    /// The eight bytes of the move segment command (2010h): a point, or a command to the buffer.
    MoveSegment([u8; 8]),
    /// The interpolation data record (60C1h).
    DataRecord(InterpolationData),
}

/// What the motion task learns of the axis.
#[derive(Debug, Clone, Copy, PartialEq, Default, Stateful)]
pub struct AxisFeedback {
    /// Actual position.
    pub position: f64,
    /// By how much the position that the drive's loops follow is ahead of the actual one; 0 where they follow none.
    pub following_error: f64,
    /// Actual velocity.
    pub velocity: f64,
    /// Actual effort.
    pub effort: f64,
    /// How far the power is.
    pub power: Power,
    /// Whether the drive warns (bit 7 of its statusword).
    pub has_warning: bool,
    /// Fault of the drive or of the link to it; `None` without one.
    pub fault: Option<Fault>,
    /// How the set-points of the motion task arrive.
    pub interpolation: Interpolation,
    /// How far homing is.
    pub homing: Homing,
    /// How far the drive is on a way of its own.
    pub profile: ProfileFeedback,
    /// The switches, inverted where they are wired so.
    pub switches: Switches,
    /// Bits of the drive's digital inputs (60FDh), as they are wired.
    pub digital_inputs: u32,
    /// What the touch probe has found.
    pub touch_probe: ProbeFeedback,
}

impl AxisFeedback {
    /// Position that the drive's loops follow, or the actual one where they follow none: where a set-point begins.
    #[must_use]
    pub const fn demanded(&self) -> f64 {
        self.position + self.following_error
    }
}

/// How far the drive is on a way of its own.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Stateful)]
pub struct ProfileFeedback {
    /// Number of the last set-point that it has acknowledged.
    pub acknowledged: u32,
    /// Whether it says that the target is reached (bit 10).
    pub target_reached: bool,
    /// Whether it follows points (bit 12 in ip).
    pub is_active: bool,
    /// Free points of its buffer (2011h).
    pub buffer_free: u16,
    /// State of its buffer (2012h).
    pub buffer_status: u32,
}

/// How far the power of an axis is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Stateful)]
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
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Stateful)]
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
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Stateful)]
pub struct Switches {
    /// Negative end.
    pub negative_limit: bool,
    /// Reference switch or index pulse.
    pub home: bool,
    /// Positive end.
    pub positive_limit: bool,
}
