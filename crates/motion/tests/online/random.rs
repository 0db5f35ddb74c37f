//! Seeded random numbers and requests.
use servobench_motion::online::{DirectionalLimits, Sides};
pub(crate) use servobench_testkit::Random;

/// Limits that a snap of `d` fills in times around `t` (s), each by a decade more or less, the sides by a factor of two.
pub(crate) fn limits(random: &mut Random, d: f64, t: f64) -> DirectionalLimits {
    let mut around = |value: f64| value * random.decades(-0.7, 0.7);
    let [velocity, acceleration, jerk] = [around(d * t * t * t), around(d * t * t), around(d * t)];
    let mut sides = |value: f64| Sides { below: value * (0.7 + 0.7 * random.unit()), above: value };
    DirectionalLimits { velocity: sides(velocity), acceleration: sides(acceleration), jerk, snap: d }
}

/// Size of a random sweep: `SERVOBENCH_SWEEP`, or `usual`.
pub(crate) fn sweep_size(usual: usize) -> usize {
    std::env::var("SERVOBENCH_SWEEP").map_or(usual, |size| size.parse().expect("SERVOBENCH_SWEEP is a whole number"))
}
