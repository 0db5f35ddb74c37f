//! Seeded random numbers and requests.
#[path = "../shared/random.rs"]
mod shared;

use servobench_motion::online::{DirectionalLimits, Sides};
pub(crate) use shared::Random;

impl Random {
    /// Uniform in [−1, 1).
    pub(crate) fn signed(&mut self) -> f64 {
        2.0 * self.unit() - 1.0
    }

    /// Between 10^low and 10^high.
    pub(crate) fn decades(&mut self, low: f64, high: f64) -> f64 {
        10.0_f64.powf(low + (high - low) * self.unit())
    }

    /// Limits that a snap of `d` fills in times around `t` (s), each by a decade more or less, the sides by a factor of two.
    pub(crate) fn limits(&mut self, d: f64, t: f64) -> DirectionalLimits {
        let mut around = |value: f64| value * self.decades(-0.7, 0.7);
        let [velocity, acceleration, jerk] = [around(d * t * t * t), around(d * t * t), around(d * t)];
        let mut sides = |value: f64| Sides { below: value * (0.7 + 0.7 * self.unit()), above: value };
        DirectionalLimits { velocity: sides(velocity), acceleration: sides(acceleration), jerk, snap: d }
    }
}

/// Size of a random sweep: `SERVOBENCH_SWEEP`, or `usual`.
pub(crate) fn sweep_size(usual: usize) -> usize {
    std::env::var("SERVOBENCH_SWEEP").map_or(usual, |size| size.parse().expect("SERVOBENCH_SWEEP is a whole number"))
}
