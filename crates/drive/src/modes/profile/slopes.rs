//! Linear ramps.

/// How fast a value may change (unit of the value per second), magnitudes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Slopes {
    /// Away from zero.
    pub(super) away: f64,
    /// Towards zero.
    pub(super) back: f64,
}

impl Slopes {
    /// Where a value is a `period` (s) later on its way to `target`. On the way through zero the slope changes there, not at
    /// the next step.
    pub(super) fn next(&self, value: f64, target: f64, period: f64) -> f64 {
        // In the direction in which the value is, or goes when it is nothing.
        let sign = if value == 0.0 { target.signum() } else { value.signum() };
        let (now, goal) = (sign * value, sign * target);
        let next = if goal >= now {
            goal.min(now + self.away * period)
        } else if goal >= 0.0 || now >= self.back * period {
            goal.max(now - self.back * period)
        } else {
            let left = period - now / self.back;
            goal.max(-self.away * left)
        };
        sign * next
    }
}
