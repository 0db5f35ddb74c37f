//! Separate accelerations for speeding up and for braking.
use crate::random::{Random, limits, sweep_size};
use servobench_base::Setpoint;
use servobench_motion::Order;
use servobench_motion::online::{DirectionalLimits, Effort, RampLimits, Sides, Target, Transition};

const ORDERS: [Order; 3] = [Order::Second, Order::Third, Order::Fourth];

fn ramps(random: &mut Random) -> RampLimits {
    let t = random.decades(-2.0, 1.0);
    let DirectionalLimits { velocity, acceleration, jerk, snap } = limits(random, 1.0, t);
    let deceleration = acceleration.above * random.decades(-0.7, 0.7);
    RampLimits { velocity, acceleration: acceleration.above, deceleration, jerk, snap }
}

/// Moves that abort one another: as the speed grows and falls, each acceleration keeps its limit, by 1e-9 of it for rounding.
#[test]
fn accelerations_keep_the_limit_of_what_they_do() {
    let mut random = Random::seeded(6);
    for chain in 0..sweep_size(100_000) / 20 {
        let (order, limits) = (ORDERS[chain % 3], ramps(&mut random));
        let RampLimits { velocity, acceleration, deceleration, .. } = limits;
        let length = velocity.above * velocity.above / acceleration.min(deceleration);
        let mut from = Setpoint::default();
        for _ in 0..10 {
            let x = from.x + random.signed() * length * random.decades(-2.0, 1.0);
            let v = if random.unit() < 0.7 { 0.0 } else { velocity.below.min(velocity.above) * random.signed() };
            let target = Target::Position { x, v };
            let planned = Transition::plan_ramps(order, &from, &target, &limits, Effort::Fast).unwrap();
            let context = || format!("{order:?} from {from:?} to {target:?} within {limits:?}: {planned:?}");
            for k in 0..=100 {
                let at = planned.at(f64::from(k) / 100.0 * planned.duration());
                // The last bits of a velocity that is zero have a sign, too.
                let stands = at.v.abs() < 1e-9 * (velocity.above + velocity.below);
                let limit = match at.v * at.a > 0.0 {
                    _ if stands => acceleration.max(deceleration),
                    true => acceleration,
                    false => deceleration,
                };
                assert!(at.a.abs() <= limit * (1.0 + 1e-9), "{at:?} {}", context());
                assert!(
                    at.v <= velocity.above * (1.0 + 1e-9) && at.v >= -velocity.below * (1.0 + 1e-9),
                    "{}",
                    context()
                );
            }
            let end = planned.at(planned.duration().next_down());
            assert!((end.x - x).abs() <= 1e-9 * (length + (x - from.x).abs()), "{end:?} {}", context());
            from = planned.at(random.unit() * planned.duration());
        }
    }
}

/// Oracle: by hand, with 1 m/s² to speed up and 4 m/s² to brake. 0.5 s and 0.5 m to stand; then w²/2 + w²/8 = 3.5 m back.
#[test]
fn a_trapezoid_brakes_with_its_deceleration_and_turns_with_its_acceleration() {
    let limits = RampLimits {
        velocity: Sides::both(10.0),
        acceleration: 1.0,
        deceleration: 4.0,
        jerk: f64::NAN,
        snap: f64::NAN,
    };
    let from = Setpoint { v: 2.0, ..Setpoint::default() };
    let target = Target::Position { x: -3.0, v: 0.0 };
    let planned = Transition::plan_ramps(Order::Second, &from, &target, &limits, Effort::Fast).unwrap();
    let w = 5.6_f64.sqrt();
    assert!((planned.duration() / (0.5 + w + w / 4.0) - 1.0).abs() < 1e-14, "{planned:?}");
    let values: Vec<f64> = planned.segments().map(|segment| segment.value).collect();
    assert_eq!(values, [-4.0, -1.0, 4.0]);
    // To a velocity on the other side: 0.5 s to stand, 3 s to −3 m/s.
    let reversed =
        Transition::plan_ramps(Order::Second, &from, &Target::Velocity(-3.0), &limits, Effort::Fast).unwrap();
    assert_eq!((reversed.duration(), reversed.at(reversed.duration()).v), (3.5, -3.0));
}

/// An axis that keeps its direction has both accelerations; one that reverses passes zero with the smaller one.
#[test]
fn smooth_ways_choose_their_limits_by_the_direction() {
    let limits =
        RampLimits { velocity: Sides::both(1.0), acceleration: 2.0, deceleration: 5.0, jerk: 50.0, snap: 2000.0 };
    let alike = RampLimits { deceleration: 2.1, ..limits };
    let (rest, moving) = (Setpoint::default(), Setpoint { v: 0.5, ..Setpoint::default() });
    let [ahead, behind] = [1.0, -1.0].map(|x| Target::Position { x, v: 0.0 });
    for order in [Order::Third, Order::Fourth] {
        let plain = |from: &Setpoint, target: &Target, limits: DirectionalLimits| {
            Transition::plan(order, from, target, &limits, Effort::Fast).unwrap()
        };
        let ramps = |from: &Setpoint, target: &Target, limits: &RampLimits| {
            Transition::plan_ramps(order, from, target, limits, Effort::Fast).unwrap()
        };
        assert_eq!(ramps(&moving, &ahead, &limits), plain(&moving, &ahead, limits.towards(1.0)));
        assert_eq!(ramps(&rest, &behind, &limits), plain(&rest, &behind, limits.towards(-1.0)));
        // From rest to rest forwards and backwards are mirror images.
        let [forwards, backwards] = [ahead, behind].map(|target| ramps(&rest, &target, &limits).duration());
        assert_eq!(forwards.to_bits(), backwards.to_bits());
        // An axis that reverses brakes with the deceleration to a stand, and speeds up with the acceleration from there.
        for limits in [limits, alike] {
            let stop = plain(&moving, &Target::Velocity(0.0), limits.towards(1.0));
            let from_there = plain(&stop.at(f64::MAX), &behind, limits.towards(-1.0));
            let turning = ramps(&moving, &behind, &limits);
            assert!(turning.duration() < plain(&moving, &behind, limits.either_way()).duration(), "{order:?}");
            assert!(turning.duration() < 0.99 * (stop.duration() + from_there.duration()), "{order:?}");
            let at_rest =
                (1..1000).map(|k| turning.at(f64::from(k) / 1000.0 * turning.duration())).find(|at| at.v <= 0.0);
            let through = at_rest.map_or(0.0, |at| -at.a / limits.acceleration);
            assert!((through - 1.0).abs() < 0.05, "{order:?}: {through} of the smaller acceleration");
        }
    }
}
