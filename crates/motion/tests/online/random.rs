//! Seeded random numbers and requests.
use servobench_motion::online::{DirectionalLimits, Sides};

/// `SplitMix64` (Steele, Lea & Flood 2014).
pub(crate) struct Random(u64);

impl Random {
    pub(crate) fn seeded(seed: u64) -> Self {
        Self(seed)
    }

    /// Uniform in [0, 1).
    pub(crate) fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / 9_007_199_254_740_992.0
    }

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
