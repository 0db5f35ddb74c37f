//! Seeded random requests over many decades.
use servobench_motion::{Limits, Order};
pub(crate) use servobench_testkit::Random;

/// One request for a plan.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Request {
    pub(crate) order: Order,
    pub(crate) distance: f64,
    pub(crate) limits: Limits,
    pub(crate) sample_time: f64,
}

/// Between 10^low and 10^high: any number, or one with a short decimal mantissa as people type them.
fn decades(random: &mut Random, round: bool, low: i32, high: i32) -> f64 {
    const MANTISSAS: [&str; 14] = ["1", "1.2", "1.25", "1.5", "1.6", "2", "2.5", "3", "4", "5", "6", "7", "7.5", "8"];
    if round {
        let exponent = low + i32::try_from(random.index(usize::try_from(high - low).unwrap())).unwrap();
        format!("{}e{exponent}", MANTISSAS[random.index(MANTISSAS.len())]).parse().unwrap()
    } else {
        10.0_f64.powf(f64::from(low) + random.unit() * f64::from(high - low))
    }
}

/// A request: distances from an encoder count to a kilometre, limits ten decades apart, sample times from a
/// microsecond to a tenth of a second; every second one round.
pub(crate) fn request(random: &mut Random) -> Request {
    let round = random.index(2) == 0;
    let order = [Order::Second, Order::Third, Order::Fourth][random.index(3)];
    let sign = if random.index(2) == 0 { 1.0 } else { -1.0 };
    Request {
        order,
        distance: sign * decades(random, round, -9, 3),
        limits: Limits {
            velocity: decades(random, round, -5, 5),
            acceleration: decades(random, round, -4, 6),
            jerk: decades(random, round, -3, 7),
            snap: decades(random, round, -1, 9),
        },
        sample_time: decades(random, round, -6, -1),
    }
}

/// Size of a random sweep: `SERVOBENCH_SWEEP`, or what CI can afford.
pub(crate) fn sweep_size() -> usize {
    std::env::var("SERVOBENCH_SWEEP").map_or(100_000, |size| size.parse().expect("SERVOBENCH_SWEEP is a whole number"))
}
