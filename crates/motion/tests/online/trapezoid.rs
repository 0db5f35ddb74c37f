//! Order 2 against a practically unlimited jerk, and against worked numbers.
use crate::random::{Random, limits, sweep_size};
use servobench_base::Setpoint;
use servobench_motion::Order;
use servobench_motion::online::{DirectionalLimits, Effort, Sides, Target, Transition};

/// Oracle: order 3, which is planned by a search, with a jerk that takes the acceleration from limit to limit in a
/// millionth of the time. It may be longer by the duration of its changes of the acceleration; and shorter, by less than that, only if
/// it begins beyond the velocity limit, which it leaves later.
#[test]
fn order_2_is_order_3_without_a_limit_of_jerk() {
    let mut random = Random::seeded(5);
    for _ in 0..sweep_size(100_000) {
        let t = random.decades(-2.0, 1.0);
        let limits = limits(&mut random, 1.0, t);
        let DirectionalLimits { velocity, acceleration, .. } = limits;
        let speed = velocity.above.max(velocity.below);
        let slow = acceleration.above.min(acceleration.below);
        let time = speed / slow;
        let limits = DirectionalLimits { jerk: 1e6 * slow / time, ..limits };
        let within = |random: &mut Random| {
            let v = 1.2 * random.signed();
            (if v > 0.0 { velocity.above * v } else { velocity.below * v }).clamp(-velocity.below, velocity.above)
        };
        let from = Setpoint { x: random.signed() * speed * time, v: 1.5 * within(&mut random), ..Setpoint::default() };
        let x = from.x + random.signed() * speed * time * random.decades(-2.0, 1.5);
        let target = Target::Position { x, v: if random.unit() < 0.5 { 0.0 } else { within(&mut random) } };
        let [two, three] = [Order::Second, Order::Third]
            .map(|order| Transition::plan(order, &from, &target, &limits, Effort::Fast).unwrap().duration());
        let is_beyond = from.v > velocity.above || from.v < -velocity.below;
        let slack = if is_beyond { 1e-5 * time } else { 1e-12 * (three + time) };
        assert!(two <= three + slack, "{from:?} to {target:?} within {limits:?}: {two} s, {three} s");
        // Near a target that is just out of reach the time is the root of the distance.
        assert!(three - two <= 1e-2 * time, "{from:?} to {target:?} within {limits:?}: {two} s, {three} s");
    }
}

/// Oracle: by hand. 4 m/s² up and 1 m/s² down; the velocity limit is reached in the second only.
#[test]
fn worked_moves() {
    let acceleration = Sides { above: 4.0, below: 1.0 };
    let limits = DirectionalLimits { velocity: Sides::both(2.0), acceleration, jerk: f64::NAN, snap: f64::NAN };
    let rest = Setpoint::default();
    let cases = [
        // 0.4·w²·… = w²/8 + w²/2 = 2.5 m/s·w² / 4: w = 1 for 0.625 m.
        (rest, 0.625, 0.0, 1.25),
        // 0.5 m up, 2 m down, 2.5 m at 2 m/s.
        (rest, 5.0, 0.0, 0.5 + 2.0 + 1.25),
        // From 2 m/s with 2 m to stop in: directly down.
        (Setpoint { v: 2.0, ..rest }, 2.0, 0.0, 2.0),
        // From 3 m/s, beyond the limit: 1 s and 2.5 m to it, 2 m down from it, 4 m at 2 m/s.
        (Setpoint { v: 3.0, ..rest }, 8.5, 0.0, 1.0 + 2.0 + 2.0),
        // Passed at 2 m/s against the direction there: 0.5 m up to 2 m/s, 1 m at that, 2 m down to rest, 2 m back to −2 m/s.
        (rest, 1.5, -2.0, 0.5 + 0.5 + 2.0 + 2.0),
    ];
    for (from, x, v, seconds) in cases {
        let target = Target::Position { x, v };
        let planned = Transition::plan(Order::Second, &from, &target, &limits, Effort::Fast).unwrap();
        assert!((planned.duration() - seconds).abs() < 1e-14 * 10.0, "{target:?}: {} s", planned.duration());
    }
    let to_velocity = Transition::plan(Order::Second, &rest, &Target::Velocity(-1.5), &limits, Effort::Fast).unwrap();
    assert_eq!((to_velocity.duration(), to_velocity.at(9.0).v), (1.5, -1.5));
}
