//! Seeded random numbers and tables.
#[path = "../shared/random.rs"]
mod shared;

use servobench_motion::pvt::Knot;
pub(crate) use shared::Random;

impl Random {
    /// Uniform in [low, high).
    pub(crate) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// A walk of `count` points, up to ±1 each, at times of 5 to 255 ms.
    pub(crate) fn knots(&mut self, count: usize) -> Vec<Knot> {
        let mut knot = Knot::new(self.between(-1.0, 1.0), 0.0);
        let mut knots = vec![knot];
        while knots.len() < count {
            knot = Knot::new(knot.t + self.between(0.005, 0.255), knot.x + self.between(-1.0, 1.0));
            knots.push(knot);
        }
        knots
    }
}
