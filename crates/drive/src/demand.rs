//! Demand of the mode of operation on the loops, and limits of its effort.
use servobench_base::{Setpoint, Stateful};

/// Demand on the loops at a tick. Positions and velocities are in the axis coordinate (m or rad), efforts in the motor's (N·m or N).
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub enum Demand {
    /// The motor carries no current.
    Off,
    /// The position loop follows the set-point.
    Position {
        /// Set-point to follow.
        setpoint: Setpoint,
        /// Offset of the velocity from the position loop.
        velocity_offset: f64,
        /// Offset of the effort from the velocity loop.
        effort_offset: f64,
    },
    /// The velocity loop follows the velocity, without a position loop.
    Velocity {
        /// Velocity to follow, and acceleration for the feedforward. The position is not used.
        setpoint: Setpoint,
        /// Offset of the effort from the velocity loop.
        effort_offset: f64,
    },
    /// An effort, within the drive's limits.
    Effort(f64),
}

/// Largest efforts that the loops may demand in addition to the drive's own limits, magnitudes in the motor's coordinate (N·m or N); may be
/// infinite.
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

    /// Lower of these limits and `limit`, in each direction.
    #[must_use]
    pub const fn at_most(self, limit: f64) -> Self {
        Self { forward: self.forward.min(limit), backward: self.backward.min(limit) }
    }

    /// Lower of these limits and `others`, in each direction.
    #[must_use]
    pub const fn within(self, others: Self) -> Self {
        Self { forward: self.forward.min(others.forward), backward: self.backward.min(others.backward) }
    }

    /// Limits of an axis that counts in the opposite direction.
    #[must_use]
    pub const fn turned(self) -> Self {
        Self { forward: self.backward, backward: self.forward }
    }

    /// Larger of the two limits.
    #[must_use]
    pub const fn largest(self) -> f64 {
        self.forward.max(self.backward)
    }
}

/// Feedforward in addition to a set-point.
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

    /// Feedforward of the demand; a demanded effort is not one.
    pub(crate) const fn offsets(&self) -> Offsets {
        match *self {
            Self::Position { velocity_offset: velocity, effort_offset: effort, .. } => Offsets { velocity, effort },
            Self::Velocity { effort_offset: effort, .. } => Offsets { velocity: 0.0, effort },
            Self::Effort(_) | Self::Off => Offsets { velocity: 0.0, effort: 0.0 },
        }
    }

    /// Cuts the efforts to the limits of both directions; returns true if any was cut.
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

    /// Shifts the demand to an axis whose zero differs by `distance`.
    #[inline]
    pub(crate) fn move_by(&mut self, distance: f64) {
        if let Self::Position { setpoint, .. } = self {
            setpoint.x += distance;
        }
    }
}
