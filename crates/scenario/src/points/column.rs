//! The columns of a table of points.
use servobench_config::Physical;
use servobench_config::quantities::{ACCELERATION, JERK, POSITION, SNAP, TIME, VELOCITY};
use std::fmt;

/// A column of a table of points.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Column {
    /// Time from any zero.
    Time,
    /// Absolute position.
    Position,
    /// Distance from the previous point, for the first from the initial position of the axis: the relative flag of a drive's points.
    Step,
    /// Velocity at the point.
    Velocity,
    /// Acceleration at the point.
    Acceleration,
    /// Jerk at the point.
    Jerk,
    /// Snap at the point.
    Snap,
}

/// Set of columns that a table has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Layout {
    /// Positions, and optionally velocities.
    Positions,
    /// Velocities alone.
    Velocities,
    /// Accelerations alone.
    Accelerations,
}

impl Layout {
    /// The columns that it must have; a cell of another column may be empty.
    pub(super) const fn needed(self) -> [Column; 2] {
        match self {
            Self::Positions => [Column::Time, Column::Position],
            Self::Velocities => [Column::Time, Column::Velocity],
            Self::Accelerations => [Column::Time, Column::Acceleration],
        }
    }

    /// True if `column` holds the values of this layout.
    pub(super) fn is_value(self, column: Column) -> bool {
        self.needed()[1] == column || self == Self::Positions && column == Column::Step
    }

    /// True if a move uses `column`; a table may contain the others too.
    pub(super) fn uses(self, column: Column) -> bool {
        column == Column::Time || self.is_value(column) || self == Self::Positions && column == Column::Velocity
    }

    /// A valid heading.
    pub(super) const fn example(self) -> &'static str {
        match self {
            Self::Positions => "time [ms],position [mm],velocity [mm/s]",
            Self::Velocities | Self::Accelerations => self.shortest_example(),
        }
    }

    /// The shortest valid heading.
    pub(super) const fn shortest_example(self) -> &'static str {
        match self {
            Self::Positions => "time [ms],position [mm]",
            Self::Velocities => "time [ms],velocity [mm/s]",
            Self::Accelerations => "time [ms],acceleration [mm/s2]",
        }
    }
}

impl Column {
    /// Every column: time, then by derivative of position.
    pub(super) const ALL: [Self; 7] =
        [Self::Time, Self::Position, Self::Step, Self::Velocity, Self::Acceleration, Self::Jerk, Self::Snap];

    pub(super) const fn name(self) -> &'static str {
        match self {
            Self::Time => "time",
            Self::Position => "position",
            Self::Step => "step",
            Self::Velocity => "velocity",
            Self::Acceleration => "acceleration",
            Self::Jerk => "jerk",
            Self::Snap => "snap",
        }
    }

    /// Name of several of its values.
    pub(super) const fn plural(self) -> &'static str {
        match self {
            Self::Time => "times",
            Self::Position => "positions",
            Self::Step => "steps",
            Self::Velocity => "velocities",
            Self::Acceleration => "accelerations",
            Self::Jerk => "jerks",
            Self::Snap => "snaps",
        }
    }

    /// Quantities that it may hold: linear first, then rotary.
    pub(super) fn candidates(self) -> Vec<&'static Physical> {
        match self {
            Self::Time => vec![&TIME],
            Self::Position | Self::Step => vec![&POSITION.linear, &POSITION.rotary],
            Self::Velocity => vec![&VELOCITY.linear, &VELOCITY.rotary],
            Self::Acceleration => vec![&ACCELERATION.linear, &ACCELERATION.rotary],
            Self::Jerk => vec![&JERK.linear, &JERK.rotary],
            Self::Snap => vec![&SNAP.linear, &SNAP.rotary],
        }
    }

    /// A unit to propose.
    pub(super) const fn proposal(self) -> &'static str {
        match self {
            Self::Time => "ms",
            Self::Position | Self::Step => "mm",
            Self::Velocity => "mm/s",
            Self::Acceleration => "mm/s2",
            Self::Jerk => "mm/s3",
            Self::Snap => "mm/s4",
        }
    }
}

impl fmt::Display for Column {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}
