//! Distance within reach in a time at the highest velocity (6080h).
use servobench_base::Setpoint;

/// Rounding errors between a velocity exactly at the limit and the one computed from two positions: those of the positions, their
/// difference, and the coefficients of a cubic.
const ROUNDINGS: f64 = 16.0;

/// Limit of the distance between two positions by the highest velocity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Reach {
    velocity: f64,
    duration: f64,
    /// The same velocity plus a tolerance for rounding.
    tolerated: f64,
}

impl Reach {
    /// Reach over `duration` (s) between positions that are at most `size` (m or rad) from zero and from each other, at a highest
    /// `velocity` (m/s or rad/s), which may be infinite.
    pub(super) fn new(velocity: f64, duration: f64, size: f64) -> Self {
        let rounding = ROUNDINGS * f64::EPSILON;
        Self { velocity, duration, tolerated: velocity * (1.0 + rounding) + rounding * size / duration }
    }

    /// True if a velocity exceeds the highest one.
    pub(super) const fn is_exceeded_by(&self, velocity: f64) -> bool {
        velocity.abs() > self.tolerated
    }

    /// Velocity within the limit.
    pub(super) const fn velocity(&self, velocity: f64) -> f64 {
        velocity.clamp(-self.velocity, self.velocity)
    }

    /// Reachable part of a distance (m or rad) that is too long; `None` if it is not.
    pub(super) fn cut(&self, way: f64) -> Option<f64> {
        self.is_exceeded_by(way / self.duration).then(|| (self.velocity * self.duration).copysign(way))
    }

    /// True if a cubic that begins with `start` exceeds the limit between its ends.
    pub(super) fn is_passed_by(&self, start: &Setpoint) -> bool {
        let turn = -start.a / start.j;
        turn > 0.0 && turn < self.duration && self.is_exceeded_by(start.v + 0.5 * start.a * turn)
    }
}
