//! The velocity at which a target is passed, against the transition that passes it.
use crate::random::{Random, limits, sweep_size};
use servobench_base::Setpoint;
use servobench_motion::Order;
use servobench_motion::online::{
    DirectionalLimits, Effort, Sides, Target, Transition, braking_velocity, passing_velocity,
};

const ORDERS: [Order; 3] = [Order::Second, Order::Third, Order::Fourth];

/// Lowest velocity towards the target on the path to it, relative to the limit.
fn lowest(order: Order, from: &Setpoint, x: f64, speed: f64, limits: &DirectionalLimits) -> f64 {
    let sign = (x - from.x).signum();
    let target = Target::Position { x, v: sign * speed };
    let planned = Transition::plan(order, from, &target, limits, Effort::Refined).unwrap();
    let parts = (0..=50).map(|k| f64::from(k) / 50.0);
    let times = planned.segments().flat_map(|part| parts.clone().map(move |share| part.start + share * part.length));
    times.map(|t| sign * planned.at(t).v).fold(f64::INFINITY, f64::min)
        / (limits.velocity.above + limits.velocity.below)
}

/// A state during a move, and a position in front of it.
fn situation(random: &mut Random, order: Order) -> (Setpoint, f64, DirectionalLimits) {
    let t = random.decades(-1.0, 1.0);
    let limits = limits(random, 1.0, t);
    let length = t.powi(4) * random.decades(-2.0, 1.0);
    let target = Target::Position { x: length * random.signed(), v: 0.0 };
    let planned = Transition::plan(order, &Setpoint::default(), &target, &limits, Effort::Fast).unwrap();
    let from = planned.at(random.unit() * planned.duration());
    let ahead = if from.v == 0.0 { random.signed() } else { from.v };
    let x = from.x + ahead.signum() * t.powi(4) * random.decades(-3.0, 1.0);
    (from, x, limits)
}

/// An axis that passes at that velocity does not turn back. The fastest path to a higher one, a little above it and all over the range,
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
    // Two in a thousand, of order 4: states so near the velocity limit that a fastest path passes it.
    assert!(turned * 10_000 <= count && lower * 300 <= count, "{turned} {lower} of {count}");
    assert!(bounded * 4 > count && none * 4 < count, "{bounded} {none} of {count}");
}

/// From there the distance is just enough to stop, and from a little faster it is not.
#[test]
fn the_next_move_can_just_be_braked() {
    let mut random = Random::seeded(9);
    for k in 0..sweep_size(30_000) {
        let order = ORDERS[k % 3];
        let t = random.decades(-1.0, 1.0);
        let limits = limits(&mut random, 1.0, t);
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
    // An axis at rest at its target passes it at rest; a moving one passes it as it is.
    for order in ORDERS {
        assert_eq!(passing_velocity(order, &rest, 0.0, &limits, 1e3), Ok(Some(0.0)));
        let moving = Setpoint { v: 3.0, ..rest };
        assert_eq!(passing_velocity(order, &moving, 0.0, &limits, 1e3), Ok(Some(3.0)));
    }
}

/// No speed that is higher by more than a share of the limit can be reached at the target, by a plan: speeds all over the rest are
/// tried. The possibility is not monotonic: a higher speed needs a longer run-up, and braking further makes room for it.
#[test]
fn no_much_higher_speed_passes() {
    const PARTS: [f64; 16] = [1e-4, 1e-3, 0.01, 0.02, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95, 1.0];
    let mut random = Random::seeded(31);
    for (order, allowed) in ORDERS.into_iter().zip([1e-9, 0.05, 0.4]) {
        let (mut worst, mut higher, mut count) = (0.0_f64, 0, 0);
        for _ in 0..sweep_size(30_000) / 10 {
            let (from, x, limits) = situation(&mut random, order);
            let sign = (x - from.x).signum();
            let limit = if sign > 0.0 { limits.velocity.above } else { limits.velocity.below };
            let stop = Transition::plan(order, &from, &Target::Velocity(0.0), &limits, Effort::Fast).unwrap();
            let back = |k: u32| sign * stop.at(f64::from(k) / 400.0 * stop.duration()).v < -1e-9 * limit;
            if sign * from.v < 0.0 || (0..=400).any(back) {
                continue;
            }
            let found = passing_velocity(order, &from, x, &limits, f64::MAX).unwrap();
            let speed = found.unwrap_or(0.0);
            let context = || format!("{order:?} {found:?} from {from:?} to {x} within {limits:?}");
            assert!(found.is_none() || lowest(order, &from, x, speed, &limits) >= -1e-9, "{}", context());
            let mut most = 0.0_f64;
            for part in PARTS {
                let faster = (speed + part * (limit - speed)).min(limit);
                let target = Target::Position { x, v: sign * faster };
                let planned = Transition::plan(order, &from, &target, &limits, Effort::Refined).unwrap();
                if planned.excess() <= 0.0 && lowest(order, &from, x, faster, &limits) >= -1e-9 {
                    most = most.max((faster - speed) / limit);
                }
            }
            assert!(most <= allowed, "{most} {}", context());
            (worst, count, higher) = (worst.max(most), count + 1, higher + usize::from(most > 1e-3));
        }
        println!(
            "{order:?}: at {higher} of {count} a speed passes that is higher by 0.1 % of the limit; by {worst} at most"
        );
        assert!(100 * higher <= 3 * count, "{order:?}: {higher} of {count}");
    }
}

/// Next to the velocity limit the speed was rounded down to an eighth of it: 14.5 m/s, where 29.0 m/s are passed.
#[test]
fn next_to_its_limit_the_velocity_is_not_halved() {
    let from = Setpoint {
        v: 28.131_263_881_380_12,
        a: 1.450_447_681_007_900_3,
        j: -1.130_477_121_291_381_1,
        ..Setpoint::default()
    };
    let limits = DirectionalLimits {
        velocity: Sides::both(29.006),
        acceleration: Sides { below: 68.24, above: 41.49 },
        jerk: 1.586,
        snap: 0.2628,
    };
    let speed = passing_velocity(Order::Fourth, &from, 2.539e3, &limits, f64::MAX).unwrap().unwrap();
    assert!(speed > 0.999 * 29.006, "{speed}");
    assert!(lowest(Order::Fourth, &from, 2.539e3, speed, &limits) >= -1e-9);
}
