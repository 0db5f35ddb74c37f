//! Seeded random numbers and tables.
use servobench_motion::pvt::Knot;
pub(crate) use servobench_testkit::Random;

/// A walk of `count` points, up to ±1 each, at times of 5 to 255 ms.
pub(crate) fn walk(random: &mut Random, count: usize) -> Vec<Knot> {
    let mut knot = Knot::new(random.between(-1.0, 1.0), 0.0);
    let mut knots = vec![knot];
    while knots.len() < count {
        knot = Knot::new(knot.t + random.between(0.005, 0.255), knot.x + random.between(-1.0, 1.0));
        knots.push(knot);
    }
    knots
}
