//! States beyond the limits are led back.
use crate::random::{Random, limits, sweep_size};
use servobench_base::Setpoint;
use servobench_motion::Order;
use servobench_motion::online::{DirectionalLimits, Effort, Sides, Target, Transition};

/// Relative excess of `at` over the limits.
fn excess(at: &Setpoint, limits: &DirectionalLimits, order: Order) -> f64 {
    let part = |Sides { below, above }: Sides, value: f64| ((value - above) / above).max((-value - below) / below);
    let jerk = if order == Order::Fourth { part(Sides::both(limits.jerk), at.j) } else { f64::NEG_INFINITY };
    let acceleration = if order == Order::Second { f64::NEG_INFINITY } else { part(limits.acceleration, at.a) };
    part(limits.velocity, at.v).max(acceleration).max(jerk)
}

/// The target is met, the excess over the limits is reported, and it is not more than the state made unavoidable: a velocity
/// beyond its limit with neither acceleration nor jerk never grows.
#[test]
fn they_come_back_and_it_is_said() {
    let mut random = Random::seeded(2);
    for k in 0..sweep_size(100_000) / 2 {
        let order = [Order::Fourth, Order::Third, Order::Second][k % 3];
        let (d, t) = (random.decades(-3.0, 6.0), random.decades(-2.0, 1.0));
        let limits = limits(&mut random, d, t);
        let DirectionalLimits { velocity, acceleration, jerk, .. } = limits;
        let mut from = Setpoint { v: 2.0 * velocity.above * random.signed(), ..Setpoint::default() };
        let is_calm = k % 2 == 0;
        if !is_calm {
            from.a = 2.0 * acceleration.above * random.signed();
            from.j = 2.0 * jerk * random.signed();
        }
        let length = d * t.powi(4) * random.decades(-2.0, 1.5);
        let target = Target::Position { x: length * random.signed(), v: 0.0 };
        let planned = Transition::plan(order, &from, &target, &limits, Effort::Fast).unwrap();
        if planned.excess() > 3.0 {
            // A jerk that takes the acceleration far beyond: the rest lasts for ages, and rounds at their size.
            assert!(!is_calm && planned.duration().is_finite());
            continue;
        }
        let end = planned.at(planned.duration().next_down());
        let context = || format!("{order:?} from {from:?} to {target:?} within {limits:?}: {planned:?}");
        let fastest = (1.0 + planned.excess()) * (velocity.above + velocity.below);
        let size = length + fastest * planned.duration();
        assert!((end.x - planned.at(planned.duration()).x).abs() < 1e-9 * size, "{}", context());
        assert!(end.v.abs() < 1e-9 * fastest, "{}", context());
        let mut most = excess(&from, &limits, order).max(0.0);
        for segment in planned.segments() {
            for part in [0.0, 0.25, 0.5, 0.75] {
                let found = excess(&planned.at(segment.start + part * segment.length), &limits, order);
                assert!(found <= planned.excess() + 1e-9, "{found} {}", context());
                if is_calm {
                    assert!(found <= most + 1e-9, "{found} {most} {}", context());
                    most = most.min(found.max(0.0));
                }
            }
        }
    }
}

/// Oracle: from v₀ > V to V with the snap d alone limited there are three pulses, of T, 2T and T, and v₀ − V = 2·d·T³.
#[test]
fn a_velocity_beyond_its_limit_is_left_as_fast_as_it_can_be() {
    let limits =
        DirectionalLimits { velocity: Sides::both(1.0), acceleration: Sides::both(1e3), jerk: 1e3, snap: 50.0 };
    for v in [1.1, 1.5, 3.0] {
        let from = Setpoint { v, ..Setpoint::default() };
        let target = Target::Position { x: 100.0, v: 0.0 };
        let planned = Transition::plan(Order::Fourth, &from, &target, &limits, Effort::Fast).unwrap();
        let expected = 4.0 * f64::cbrt((v - 1.0) / (2.0 * 50.0));
        let cruise = planned.segments().find(|segment| segment.length > 10.0).unwrap();
        assert!((cruise.start / expected - 1.0).abs() < 1e-12, "{v}: {} {expected}", cruise.start);
        assert!((planned.excess() / (v - 1.0) - 1.0).abs() < 1e-9, "{}", planned.excess());
    }
}
