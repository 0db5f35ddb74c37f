//! Seeded random requests over many decades.
#[path = "../shared/random.rs"]
mod shared;

use servobench_motion::{Limits, Order};
pub(crate) use shared::Random;

/// One request for a plan.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Request {
    pub(crate) order: Order,
    pub(crate) distance: f64,
    pub(crate) limits: Limits,
    pub(crate) sample_time: f64,
}

impl Random {
    /// A whole number below `end`.
    pub(crate) fn below(&mut self, end: usize) -> usize {
        usize::try_from(self.next() % end as u64).unwrap()
    }

    /// Between 10^low and 10^high: any number, or one with a short decimal mantissa as people type them.
    fn decades(&mut self, round: bool, low: i32, high: i32) -> f64 {
        const MANTISSAS: [&str; 14] =
            ["1", "1.2", "1.25", "1.5", "1.6", "2", "2.5", "3", "4", "5", "6", "7", "7.5", "8"];
        if round {
            let exponent = low + i32::try_from(self.below(usize::try_from(high - low).unwrap())).unwrap();
            format!("{}e{exponent}", MANTISSAS[self.below(MANTISSAS.len())]).parse().unwrap()
        } else {
            10.0_f64.powf(f64::from(low) + self.unit() * f64::from(high - low))
        }
    }

    /// A request: distances from an encoder count to a kilometre, limits ten decades apart, sample times from a
    /// microsecond to a tenth of a second; every second one round.
    pub(crate) fn request(&mut self) -> Request {
        let round = self.below(2) == 0;
        let order = [Order::Second, Order::Third, Order::Fourth][self.below(3)];
        let sign = if self.below(2) == 0 { 1.0 } else { -1.0 };
        Request {
            order,
            distance: sign * self.decades(round, -9, 3),
            limits: Limits {
                velocity: self.decades(round, -5, 5),
                acceleration: self.decades(round, -4, 6),
                jerk: self.decades(round, -3, 7),
                snap: self.decades(round, -1, 9),
            },
            sample_time: self.decades(round, -6, -1),
        }
    }
}

/// Size of a random sweep: `SERVOBENCH_SWEEP`, or what CI can afford.
pub(crate) fn sweep_size() -> usize {
    std::env::var("SERVOBENCH_SWEEP").map_or(100_000, |size| size.parse().expect("SERVOBENCH_SWEEP is a whole number"))
}
