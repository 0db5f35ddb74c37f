//! Limits as drives and function blocks have them: one acceleration to speed up with, another one to brake with.
use super::second::Sides;
use super::trapezoid::Rates;
use super::{DirectionalLimits, check_limits};
use crate::{Order, PlanError};

/// What a transition may not exceed, acceleration while the speed grows and while it falls; in the axis unit (m or rad).
///
/// Profile acceleration and deceleration of a drive (CiA 402, objects 6083h and 6084h), `Acceleration` ("increasing energy of
/// the motor") and `Deceleration` of a block (`PLCopen` Motion Control, part 1).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RampLimits {
    /// Velocity (m/s or rad/s).
    pub velocity: Sides,
    /// Acceleration while the speed grows (m/s² or rad/s²), a magnitude.
    pub acceleration: f64,
    /// Acceleration while the speed falls (m/s² or rad/s²), a magnitude.
    pub deceleration: f64,
    /// Jerk (m/s³ or rad/s³), a magnitude; order 2 does not use it.
    pub jerk: f64,
    /// Snap (m/s⁴ or rad/s⁴), a magnitude; orders 2 and 3 do not use it.
    pub snap: f64,
}

impl RampLimits {
    /// What they are for an axis that moves in the direction of `sign` only: what it speeds up with is then on one side, what
    /// it brakes with on the other.
    #[must_use]
    pub fn towards(&self, sign: f64) -> DirectionalLimits {
        let Self { acceleration, deceleration, .. } = *self;
        self.with(if sign >= 0.0 {
            Sides { above: acceleration, below: deceleration }
        } else {
            Sides { above: deceleration, below: acceleration }
        })
    }

    /// What keeps them in whatever direction the axis moves: the smaller of both accelerations.
    #[must_use]
    pub const fn either_way(&self) -> DirectionalLimits {
        self.with(Sides::both(self.acceleration.min(self.deceleration)))
    }

    const fn with(&self, acceleration: Sides) -> DirectionalLimits {
        let Self { velocity, jerk, snap, .. } = *self;
        DirectionalLimits { velocity, acceleration, jerk, snap }
    }

    pub(crate) const fn rates(&self) -> Rates {
        Rates { growing: Sides::both(self.acceleration), falling: Sides::both(self.deceleration) }
    }

    pub(crate) fn check(&self, order: Order) -> Result<(), PlanError> {
        let Self { velocity, acceleration, deceleration, jerk, snap } = *self;
        let magnitudes = [
            ("velocity.above", velocity.above),
            ("velocity.below", velocity.below),
            ("acceleration", acceleration),
            ("deceleration", deceleration),
        ];
        check_limits(order, magnitudes, jerk, snap)
    }
}
