//! Seeded tables.
use servobench_motion::pvt::Knot;

/// Numbers in [0, 1): xorshift64* (Vigna 2016).
pub(crate) struct Random(pub(crate) u64);

impl Random {
    pub(crate) fn next(&mut self) -> f64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        (self.0.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub(crate) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.next()
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
