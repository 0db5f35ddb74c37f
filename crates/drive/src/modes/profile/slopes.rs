//! Linear ramps.

/// Largest rates of change of a value (unit of the value per second), magnitudes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Slopes {
    /// Away from zero.
    pub(super) away: f64,
    /// Towards zero.
    pub(super) back: f64,
}

impl Slopes {
    /// Value after a `period` (s) on the ramp to `target`. On a ramp through zero the slope changes there, not at the next step.
    pub(super) fn next(&self, value: f64, target: f64, period: f64) -> f64 {
        // Sign of the value, or of its target when the value is zero.
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
