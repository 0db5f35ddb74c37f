//! How far a position gets in a time at the highest velocity (6080h).
use servobench_base::Setpoint;

/// Roundings that are between a velocity just at the limit and the one that is found from two positions: those of the positions,
/// their difference, and the coefficients of a cubic.
const ROUNDINGS: f64 = 16.0;

/// What the highest velocity leaves of the way between two positions.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Reach {
    velocity: f64,
    duration: f64,
    /// The same velocity with what rounding may make of it.
    tolerated: f64,
}

impl Reach {
    /// Of a way of `duration` (s) between positions that are at most `size` (m or rad) from zero and from each other, at a highest
    /// `velocity` (m/s or rad/s), which may be infinite.
    pub(super) fn new(velocity: f64, duration: f64, size: f64) -> Self {
        let rounding = ROUNDINGS * f64::EPSILON;
        Self { velocity, duration, tolerated: velocity * (1.0 + rounding) + rounding * size / duration }
    }

    /// Whether a velocity is beyond the highest one.
    pub(super) const fn is_exceeded_by(&self, velocity: f64) -> bool {
        velocity.abs() > self.tolerated
    }

    /// The velocity as far as it is allowed.
    pub(super) const fn velocity(&self, velocity: f64) -> f64 {
        velocity.clamp(-self.velocity, self.velocity)
    }

    /// As far as the axis gets of a way (m or rad) that is too long; `None` of one that is not.
    pub(super) fn cut(&self, way: f64) -> Option<f64> {
        self.is_exceeded_by(way / self.duration).then(|| (self.velocity * self.duration).copysign(way))
    }

    /// Whether a cubic that begins with `start` is faster between its ends than it may be at them.
    pub(super) fn is_passed_by(&self, start: &Setpoint) -> bool {
        let turn = -start.a / start.j;
        turn > 0.0 && turn < self.duration && self.is_exceeded_by(start.v + 0.5 * start.a * turn)
    }
}
