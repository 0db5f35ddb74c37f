//! From rest to rest, an online plan is the offline one.
use crate::random::{Random, limits, sweep_size};
use servobench_base::Setpoint;
use servobench_motion::online::{Effort, Target, Transition};
use servobench_motion::{Limits, Order, Profile};

/// Oracle: orders 2 and 3 the product of moving averages, order 4 the optimum that is planned from the middle, with other equations.
#[test]
fn from_rest_to_rest_it_takes_as_long_as_the_offline_plan() {
    let mut random = Random::seeded(1);
    for _ in 0..sweep_size(100_000) / 2 {
        let (d, t) = (random.decades(-6.0, 9.0), random.decades(-3.0, 1.0));
        let sides = limits(&mut random, d, t);
        let (velocity, acceleration) = (sides.velocity.above, sides.acceleration.above);
        let limits = Limits { velocity, acceleration, jerk: sides.jerk, snap: sides.snap };
        let x = random.signed() * d * t.powi(4) * random.decades(-2.0, 1.0);
        for order in [Order::Second, Order::Third, Order::Fourth] {
            let target = Target::Position { x, v: 0.0 };
            let online = Transition::plan(order, &Setpoint::default(), &target, &limits.into(), Effort::Fast).unwrap();
            let offline = Profile::plan_optimal(order, x, &limits).unwrap();
            let ratio = online.duration() / offline.duration();
            assert!((ratio - 1.0).abs() < 1e-12, "{order:?} {x} {limits:?}: {online:?} {offline:?} {ratio}");
        }
    }
}
