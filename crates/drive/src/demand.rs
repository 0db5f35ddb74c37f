//! What the mode of operation asks of the loops, and how much effort they may make of it.
use servobench_base::{Setpoint, Stateful};

/// What the loops are to do at a tick. Positions and velocities are in the axis coordinate (m or rad), efforts in the
/// motor's (N·m or N).
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub enum Demand {
    /// The motor carries no current.
    Off,
    /// The position loop follows the set-point.
    Position {
        /// What is followed.
        setpoint: Setpoint,
        /// Added to the velocity that the position loop asks for.
        velocity_offset: f64,
        /// Added to the effort that the velocity loop asks for.
        effort_offset: f64,
    },
    /// The velocity loop follows the velocity; there is no position loop.
    Velocity {
        /// What is followed: velocity, and acceleration for the feedforward. Its position is not used.
        setpoint: Setpoint,
        /// Added to the effort that the velocity loop asks for.
        effort_offset: f64,
    },
    /// The effort itself, within the drive's limits.
    Effort(f64),
}

/// The largest efforts that the loops may ask for beside the drive's own limits, magnitudes in the motor's coordinate (N·m or N);
/// may be infinite.
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub struct EffortLimits {
    /// In positive direction.
    pub forward: f64,
    /// In negative direction.
    pub backward: f64,
}

impl EffortLimits {
    /// No limits.
    pub const NONE: Self = Self::both(f64::INFINITY);

    /// The same limit in both directions.
    #[must_use]
    pub const fn both(limit: f64) -> Self {
        Self { forward: limit, backward: limit }
    }

    /// These, and at most `limit` in either direction.
    #[must_use]
    pub const fn at_most(self, limit: f64) -> Self {
        Self { forward: self.forward.min(limit), backward: self.backward.min(limit) }
    }

    /// These, and at most `others` in each direction.
    #[must_use]
    pub const fn within(self, others: Self) -> Self {
        Self { forward: self.forward.min(others.forward), backward: self.backward.min(others.backward) }
    }

    /// The same limits of an axis that counts the other way round.
    #[must_use]
    pub const fn turned(self) -> Self {
        Self { forward: self.backward, backward: self.forward }
    }

    /// The larger one.
    #[must_use]
    pub const fn largest(self) -> f64 {
        self.forward.max(self.backward)
    }
}

/// What is fed forward beside a set-point.
#[derive(Debug, Clone, Copy, PartialEq, Default, Stateful)]
pub struct Offsets {
    /// To the velocity loop (m/s or rad/s).
    pub velocity: f64,
    /// To the current loop, in the motor's coordinate (N·m or N).
    pub effort: f64,
}

impl Offsets {
    pub(crate) const fn scaled(self, by: f64) -> Self {
        Self { velocity: self.velocity * by, effort: self.effort * by }
    }
}

impl Demand {
    /// The position loop follows `setpoint`, without offsets.
    #[must_use]
    pub const fn position(setpoint: Setpoint) -> Self {
        Self::Position { setpoint, velocity_offset: 0.0, effort_offset: 0.0 }
    }

    /// What it feeds forward; an effort that is demanded itself is none.
    pub(crate) const fn offsets(&self) -> Offsets {
        match *self {
            Self::Position { velocity_offset: velocity, effort_offset: effort, .. } => Offsets { velocity, effort },
            Self::Velocity { effort_offset: effort, .. } => Offsets { velocity: 0.0, effort },
            Self::Effort(_) | Self::Off => Offsets { velocity: 0.0, effort: 0.0 },
        }
    }

    /// Cuts the efforts to the limits of both directions; whether there was anything to cut.
    #[inline]
    pub(crate) fn keep_within(&mut self, EffortLimits { forward, backward }: EffortLimits) -> bool {
        let (Self::Position { effort_offset: effort, .. }
        | Self::Velocity { effort_offset: effort, .. }
        | Self::Effort(effort)) = self
        else {
            return false;
        };
        let is_beyond = *effort > forward || *effort < -backward;
        *effort = effort.clamp(-backward, forward);
        is_beyond
    }

    /// Makes it the same demand on an axis that counts from elsewhere.
    #[inline]
    pub(crate) fn move_by(&mut self, distance: f64) {
        if let Self::Position { setpoint, .. } = self {
            setpoint.x += distance;
        }
    }
}
