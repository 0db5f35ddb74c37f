//! Order 3 against independent code: `rsruckig`, the port of Ruckig (Berscheid & Kröger, RSS 2021).
use crate::random::{Random, sweep_size};
use rsruckig::prelude::*;
use servobench_base::Setpoint;
use servobench_motion::Order;
use servobench_motion::online::{DirectionalLimits, Effort, Sides, Target, Transition};

fn duration(from: &Setpoint, x: f64, v: f64, limits: &DirectionalLimits) -> Option<f64> {
    let mut input = InputParameter::new(None);
    input.current_position[0] = from.x;
    input.current_velocity[0] = from.v;
    input.current_acceleration[0] = from.a;
    input.target_position[0] = x;
    input.target_velocity[0] = v;
    input.max_velocity[0] = limits.velocity.above;
    input.max_acceleration[0] = limits.acceleration.above;
    input.max_jerk[0] = limits.jerk;
    let mut trajectory = Trajectory::new(None);
    Ruckig::<1, ThrowErrorHandler>::new(None, 0.01).calculate(&input, &mut trajectory).ok()?;
    Some(trajectory.get_duration())
}

/// Without an initial acceleration that forces the velocity beyond its limit: there Ruckig brakes first, and is slower.
#[test]
fn order_3_takes_as_long_as_ruckig() {
    let mut random = Random::seeded(3);
    let mut compared = 0;
    for _ in 0..sweep_size(100_000) {
        let [v, a, j] = [(); 3].map(|()| random.decades(-0.7, 0.7));
        let limits =
            DirectionalLimits { velocity: Sides::both(v), acceleration: Sides::both(a), jerk: j, snap: f64::INFINITY };
        let from = Setpoint { v: v * random.signed(), a: a * random.signed(), ..Setpoint::default() };
        if (from.v + from.a * from.a.abs() / (2.0 * j)).abs() > v {
            continue;
        }
        let (x, end) =
            (random.signed() * random.decades(-2.0, 1.5), if random.unit() < 0.5 { 0.0 } else { v * random.signed() });
        let target = Target::Position { x, v: end };
        let ours = Transition::plan(Order::Third, &from, &target, &limits, Effort::Fast).unwrap().duration();
        let Some(theirs) = duration(&from, x, end, &limits) else { continue };
        compared += 1;
        assert!(
            (ours / theirs - 1.0).abs() < 1e-9,
            "{from:?} to {target:?} within {limits:?}: {ours} s, Ruckig {theirs} s"
        );
    }
    assert!(compared > sweep_size(100_000) / 2, "{compared}");
}
