//! The program: moves of every family, and pauses.
use super::Filter;
use servobench_metrics::Limit;

/// A step of the program.
#[derive(Debug, Clone, PartialEq)]
#[expect(clippy::large_enum_variant, reason = "a program has some dozen steps, most of them moves")]
pub enum Step {
    /// A move.
    Move(MoveStep),
    /// A pause (s).
    Wait(f64),
}

/// A move.
#[derive(Debug, Clone, PartialEq)]
pub struct MoveStep {
    /// Which way it goes.
    pub way: Way,
    /// Order of the profile: 2, 3 or 4; of a table the highest derivative that is no impulse.
    pub order: u8,
    /// Limits of |velocity|, |acceleration|, |jerk|, |snap|; infinite where there is none.
    pub limits: [f64; 4],
    /// What filters it.
    pub filter: Filter,
    /// Takes over from the move before, so long after the start of that (s); at its end unless given.
    pub aborts_after: Option<f64>,
    /// Slowed to last this long (s), every derivative in proportion; `None`: as fast as the limits allow.
    pub duration: Option<f64>,
    /// Limits of what is measured on this move.
    pub metric_limits: Vec<Limit>,
}

/// Which way a move goes.
#[derive(Debug, Clone, PartialEq)]
pub enum Way {
    /// From rest to rest.
    Rest(RestMove),
    /// From the state in which the move before leaves the axis.
    Online(OnlineMove),
    /// By the operands of Rockwell's axis move, from rest to rest.
    Rockwell(RockwellMove),
    /// Through a table, from rest.
    Table(TableMove),
}

/// Where a move goes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Target {
    /// To a position.
    Absolute(f64),
    /// By a distance from the last target.
    Relative(f64),
}

/// A move from rest to rest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RestMove {
    /// Where to.
    pub target: Target,
    /// Which profile.
    pub method: Method,
    /// Samples of which all times are whole multiples; `None` for the continuous plan.
    pub grid: Option<Grid>,
}

/// How a move from rest to rest is sampled.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Grid {
    /// Sample time (s), a whole number of base ticks.
    pub sample_time: f64,
    /// How its times are made whole.
    pub sampling: Sampling,
    /// How set-points are made of its samples.
    pub execution: Execution,
}

/// How the times of a move are made whole numbers of samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Sampling {
    /// One after the other, as it is published.
    #[default]
    Published,
    /// With the fewest samples that a step through boxes needs.
    Fewest,
}

/// How set-points are made of the samples of the highest derivative.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Execution {
    /// By the exact polynomial.
    #[default]
    Hold,
    /// By the forward-Euler cascade.
    Euler,
}

/// Which profile goes from rest to rest.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Method {
    /// The published step through boxes.
    #[default]
    Published,
    /// The shortest.
    Optimal,
}

/// A move from any state of motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OnlineMove {
    /// Where to.
    pub goal: Goal,
    /// How much work its plan may be.
    pub effort: PlanEffort,
    /// Limits of velocity and acceleration below zero, where they differ from those above.
    pub negative: [Option<f64>; 2],
}

/// Where a move from a state of motion goes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Goal {
    /// To a position, passed at a velocity.
    Position(Target, f64),
    /// To a velocity, held for a time (s).
    Velocity(f64, f64),
}

/// How much work the plan of a move from a state of motion may be.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum PlanEffort {
    /// A bounded amount, for a control cycle.
    #[default]
    Fast,
    /// More, where that makes the move shorter.
    Refined,
}

/// Rockwell's axis move; its speed and acceleration are the limits of the step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RockwellMove {
    /// Where to.
    pub target: Target,
    /// Shape of the velocity.
    pub shape: RockwellShape,
    /// Deceleration (magnitude).
    pub deceleration: f64,
    /// Jerk of the acceleration and of the deceleration; of a trapezoid the largest.
    pub jerks: [RockwellJerk; 2],
    /// Largest jerk of accelerations and decelerations that the axis is configured for.
    pub maximum: [f64; 2],
}

/// Shape of the velocity of Rockwell's axis move.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RockwellShape {
    /// Acceleration as rectangular as the axis' jerk allows.
    Trapezoid,
    /// Acceleration with a jerk of its own.
    SCurve,
}

/// How Rockwell's axis move says its jerk.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum RockwellJerk {
    /// As a value.
    Value(f64),
    /// As a part of the largest.
    PartOfMaximum(f64),
    /// As the part of the ramp in which the acceleration changes.
    PartOfTime(f64),
}

/// A move through a table.
#[derive(Debug, Clone, PartialEq)]
pub struct TableMove {
    /// Its points: time (s), position, velocity where it has one (axis coordinate).
    pub points: Vec<(f64, f64, Option<f64>)>,
    /// Whether the positions count from where the axis is.
    pub is_relative: bool,
    /// Where the velocities come from.
    pub velocities: Velocities,
    /// How it is followed.
    pub follow: Follow,
}

/// Where the velocities at the points of a table come from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Velocities {
    /// The table; a point without one is approached linearly.
    Given,
    /// The mean of the segments before and behind.
    Average,
    /// The average rule, then so many passes of smoothing.
    Smooth(u32),
    /// Continuous acceleration.
    Continuous,
}

/// How a table is followed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Follow {
    /// Along its cubic and linear segments.
    Segments,
    /// By profile velocities with plateaus; the share of a segment at either end in which velocity changes.
    Plateaus(f64),
    /// By profile velocities along its spline; commands per second (Hz).
    Steps(f64),
}

impl MoveStep {
    /// Where the move goes, if that is a position.
    #[must_use]
    pub const fn target(&self) -> Option<Target> {
        match &self.way {
            Way::Rest(RestMove { target, .. })
            | Way::Online(OnlineMove { goal: Goal::Position(target, _), .. })
            | Way::Rockwell(RockwellMove { target, .. }) => Some(*target),
            Way::Online(_) | Way::Table(_) => None,
        }
    }

    /// Whether the axis still moves at its end.
    #[must_use]
    pub fn ends_in_motion(&self) -> bool {
        match &self.way {
            Way::Online(OnlineMove { goal: Goal::Position(_, v) | Goal::Velocity(v, _), .. }) => *v != 0.0,
            Way::Rest(_) | Way::Rockwell(_) => false,
            Way::Table(table) => table.points.last().is_some_and(|(.., v)| v.is_some_and(|v| v != 0.0)),
        }
    }
}
