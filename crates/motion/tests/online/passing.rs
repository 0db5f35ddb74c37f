//! The velocity at which a target is passed, against what the transition that passes it does.
use crate::random::{Random, sweep_size};
use servobench_base::Setpoint;
use servobench_motion::Order;
use servobench_motion::online::{
    DirectionalLimits, Effort, Sides, Target, Transition, braking_velocity, passing_velocity,
};

const ORDERS: [Order; 3] = [Order::Second, Order::Third, Order::Fourth];

/// Lowest velocity towards the target on the way to it, as a part of the limit.
fn lowest(order: Order, from: &Setpoint, x: f64, speed: f64, limits: &DirectionalLimits) -> f64 {
    let sign = (x - from.x).signum();
    let target = Target::Position { x, v: sign * speed };
    let planned = Transition::plan(order, from, &target, limits, Effort::Refined).unwrap();
    let parts = (0..=50).map(|k| f64::from(k) / 50.0);
    let times = planned.segments().flat_map(|part| parts.clone().map(move |share| part.start + share * part.length));
    times.map(|t| sign * planned.at(t).v).fold(f64::INFINITY, f64::min)
        / (limits.velocity.above + limits.velocity.below)
}

/// A state on the way of a move, and a position in front of it.
fn situation(random: &mut Random, order: Order) -> (Setpoint, f64, DirectionalLimits) {
    let t = random.decades(-1.0, 1.0);
    let limits = random.limits(1.0, t);
    let length = t.powi(4) * random.decades(-2.0, 1.0);
    let target = Target::Position { x: length * random.signed(), v: 0.0 };
    let planned = Transition::plan(order, &Setpoint::default(), &target, &limits, Effort::Fast).unwrap();
    let from = planned.at(random.unit() * planned.duration());
    let ahead = if from.v == 0.0 { random.signed() } else { from.v };
    let x = from.x + ahead.signum() * t.powi(4) * random.decades(-3.0, 1.0);
    (from, x, limits)
}

/// Who passes at that velocity does not turn back. The fastest way to a higher one, a little above it and all over the range,
/// leads beyond the position.
#[test]
fn it_is_the_highest_that_the_fastest_way_reaches() {
    let mut random = Random::seeded(7);
    let (mut bounded, mut none, mut turned, mut lower, count) = (0, 0, 0, 0, sweep_size(30_000));
    for k in 0..count {
        let order = ORDERS[k % 3];
        let (from, x, limits) = situation(&mut random, order);
        let limit = if x > from.x { limits.velocity.above } else { limits.velocity.below };
        let context = || format!("{order:?} from {from:?} to {x} within {limits:?}");
        let Some(speed) = passing_velocity(order, &from, x, &limits, f64::MAX).unwrap() else {
            none += 1;
            continue;
        };
        assert!((0.0..=limit).contains(&speed), "{speed} {}", context());
        let least = lowest(order, &from, x, speed, &limits);
        // A state from which it cannot even come to a stop without turning back leaves no choice.
        let stop = Transition::plan(order, &from, &Target::Velocity(0.0), &limits, Effort::Fast).unwrap();
        let back = |k: u32| (x - from.x).signum() * stop.at(f64::from(k) / 400.0 * stop.duration()).v < -1e-9 * limit;
        if from.v != 0.0 && (0..=400).any(back) {
            continue;
        }
        turned += usize::from(least < -1e-9);
        assert!(least >= -1e-9 || order == Order::Fourth, "{speed} {}", context());
        bounded += usize::from(speed < limit);
        for part in [1e-6, random.unit(), random.unit(), random.unit()] {
            let faster = speed + part * (limit - speed);
            let sign = (x - from.x).signum();
            let target = Target::Velocity(sign * faster);
            let way = Transition::plan(order, &from, &target, &limits, Effort::Fast).unwrap();
            let beyond = sign * (way.at(way.duration()).x - x);
            let is_highest = beyond >= 0.0 || faster <= speed * (1.0 + 1e-9);
            lower += usize::from(!is_highest);
            assert!(is_highest || order == Order::Fourth, "{speed} {faster} {beyond} {}", context());
        }
    }
    // Two in a thousand, of order 4: states so near the velocity limit that a fastest way passes it.
    assert!(turned * 10_000 <= count && lower * 300 <= count, "{turned} {lower} of {count}");
    assert!(bounded * 4 > count && none * 4 < count, "{bounded} {none} of {count}");
}

/// From there the distance is just enough to stop in, and from a little faster it is not.
#[test]
fn the_next_move_can_just_be_braked() {
    let mut random = Random::seeded(9);
    for k in 0..sweep_size(30_000) {
        let order = ORDERS[k % 3];
        let t = random.decades(-1.0, 1.0);
        let limits = random.limits(1.0, t);
        let distance = random.signed() * t.powi(4) * random.decades(-3.0, 1.0);
        let speed = braking_velocity(order, distance, &limits).unwrap();
        let limit = if distance > 0.0 { limits.velocity.above } else { limits.velocity.below };
        let stops_at = |speed: f64| {
            let from = Setpoint { v: distance.signum() * speed, ..Setpoint::default() };
            let stop = Transition::plan(order, &from, &Target::Velocity(0.0), &limits, Effort::Fast).unwrap();
            stop.at(f64::MAX).x / distance
        };
        assert!(stops_at(speed) <= 1.0, "{order:?} {distance} {limits:?}");
        assert!(speed >= limit || stops_at(speed * (1.0 + 1e-9)) > 1.0, "{order:?} {distance} {limits:?}");
    }
}

/// Oracle: v²/2a; and v = ∛(j·x²) from the jerk alone, as a stop from v takes 2·√(v/j) at v/2 on the average.
#[test]
fn closed_forms() {
    let limits = DirectionalLimits { velocity: Sides::both(1e3), acceleration: Sides::both(8.0), jerk: 2.0, snap: 1.0 };
    let second = braking_velocity(Order::Second, -4.0, &limits).unwrap();
    assert!((second / 8.0 - 1.0).abs() < 1e-11, "{second}");
    let third = braking_velocity(Order::Third, 0.5, &limits).unwrap();
    assert!((third / 0.5_f64.cbrt() - 1.0).abs() < 1e-11, "{third}");
    let rest = Setpoint::default();
    let third = passing_velocity(Order::Third, &rest, 0.5, &limits, 1e3).unwrap().unwrap();
    assert!((third / 0.5_f64.cbrt() - 1.0).abs() < 1e-11, "{third}");
    // What stands at its target passes it at rest; what moves there passes it as it is.
    for order in ORDERS {
        assert_eq!(passing_velocity(order, &rest, 0.0, &limits, 1e3), Ok(Some(0.0)));
        let moving = Setpoint { v: 3.0, ..rest };
        assert_eq!(passing_velocity(order, &moving, 0.0, &limits, 1e3), Ok(Some(3.0)));
    }
}
