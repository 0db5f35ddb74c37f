//! The highest velocity (6080h): points that require more are reached later.
use crate::axis::{Axis, COUNT, PERIOD, assert_near, cubic, linear, run, whole};
use servobench_cia402::interpolated::{Point, SubMode};
use servobench_drive::modes::interpolated::Params;
use servobench_testkit::Random;

fn limited(counts: i32, sub_mode: SubMode, velocity: f64) -> Axis {
    let mut axis = Axis::at(counts, sub_mode);
    axis.params = Params { velocity, ..axis.params };
    axis
}

/// Oracle: by hand. 1 mm in 7 ms is 0.143 m/s, of which 0.1 m/s are allowed: 0.7 mm; 0.3 mm are left for the next 11 ms and make
/// 0.4 mm of the 0.1 mm there, 0.036 m/s.
#[test]
fn what_is_cut_is_made_up_for_behind_it() {
    let mut axis = limited(0, SubMode::LinearTimed, 0.1);
    axis.add(&[linear(0, 7), linear(1000, 11), linear(1100, 0)]);
    for k in 0..72 {
        let (at, t) = (axis.step(run()), f64::from(k) * PERIOD);
        let (x, v) = if t < 7e-3 { (0.1 * t, 0.1) } else { (7e-4 + (t - 7e-3) * 0.4 / 11.0, 0.4 / 11.0) };
        assert_near(at.x, x, 1e-15);
        assert_near(at.v, v, 1e-13);
        assert_eq!((axis.state.is_following(), axis.state.is_limited()), (true, t < 7e-3), "{t} s");
    }
    axis.step(run());
    assert!(axis.answer.target_reached && !axis.state.is_limited());
    assert_near(axis.last.x, 1.1e-3, 1e-15);
}

/// Oracle: by hand. 2 mm in 10 ms, and 0.1 m/s are allowed: the last point is reached 10 ms later, where the move ends.
#[test]
fn a_move_goes_on_until_its_last_point_is_reached() {
    let mut axis = limited(-500, SubMode::Cubic, 0.1);
    axis.add(&[cubic(-500, 0, 10), cubic(1500, 0, 0)]);
    for k in 0..80 {
        let at = axis.step(run());
        assert_near(at.x, -5e-4 + 0.1 * f64::from(k) * PERIOD, 1e-15);
        assert!(axis.state.is_following() && axis.state.is_limited(), "step {k}");
    }
    assert_near(axis.step(run()).x, 1.5e-3, 1e-15);
    assert!(axis.answer.target_reached && !axis.state.is_following());
}

/// Points with any times, distances and velocities, and any highest velocity: it is not exceeded, nothing jumps, and every move ends at
/// its last point. A move that is nowhere limited equals that of a drive without a limit, bit for bit.
#[test]
fn no_points_make_the_demand_jump_or_pass_the_highest_velocity() {
    let mut random = Random::seeded(11);
    let mut between = |low: f64, high: f64| low + random.unit() * (high - low);
    let mut limited_moves = 0;
    for case in 0..500 {
        let sub_mode = if case % 2 == 0 { SubMode::Cubic } else { SubMode::LinearTimed };
        let start = whole(between(-1e6, 1e6));
        let mut points = vec![Point { velocity: Some(0), ..linear(start, 3) }];
        for _ in 0..=(case % 7) {
            let position = points[points.len() - 1].position + whole(between(-3000.0, 3000.0));
            let time = whole(between(1000.0, 30_000.0)).unsigned_abs();
            let velocity = (sub_mode == SubMode::Cubic).then(|| whole(between(-2e6, 2e6)));
            points.push(Point { position, velocity, time, is_relative: false });
        }
        let end =
            Point { velocity: Some(0).filter(|_| sub_mode == SubMode::Cubic), time: 0, ..points[points.len() - 1] };
        points.push(end);
        let velocity = between(0.01, 0.5);
        let mut free = Axis::at(start, sub_mode);
        let mut axis = limited(start, sub_mode, velocity);
        free.add(&points);
        axis.add(&points);
        let (mut was_limited, mut before) = (false, axis.last.x);
        let mut steps = 0;
        loop {
            let (at, expected) = (axis.step(run()), free.step(run()));
            was_limited |= axis.state.is_limited();
            let step = (at.x - before).abs();
            assert!(step <= velocity * PERIOD * (1.0 + 1e-9) + 4.0 * f64::EPSILON, "case {case}: {step} to {at:?}");
            assert!(at.v.abs() <= velocity * (1.0 + 1e-9), "case {case}: {at:?} within {velocity}");
            assert!(was_limited || at == expected, "case {case}: {at:?} {expected:?}");
            before = at.x;
            steps += 1;
            if steps > 1 && !axis.state.is_following() {
                break;
            }
            assert!(steps < 1_000_000);
        }
        limited_moves += usize::from(was_limited);
        assert_near(axis.last.x, f64::from(end.position) * COUNT, 1e-15);
        assert_eq!(axis.errors(), 0, "case {case}");
    }
    assert!((100..500).contains(&limited_moves), "{limited_moves}");
}
