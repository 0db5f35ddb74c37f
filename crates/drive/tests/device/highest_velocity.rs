//! The highest velocity (6080h) in cyclic synchronous and interpolated position: exactly at it, above it, on any grid.
use crate::axis::{Axis, setpoint};
use servobench_cia402::interpolated::{Point, SubMode};
use servobench_cia402::{ControlBit, Mode, StatusBit};
use servobench_drive::device::{CycleParams, Limits, Params};
use servobench_motion::interpolate;
use servobench_testkit::Random;

const MICROMETRE: f64 = 1e-6;
const WAYS: [interpolate::Mode; 3] =
    [interpolate::Mode::Linear, interpolate::Mode::Cubic, interpolate::Mode::CubicBSpline];

/// A drive that is switched on at `position` (µm) in csp; a cycle of `steps` steps, and at most `units` micrometres in it.
fn axis(interpolation: interpolate::Mode, position: i32, steps: u32, units: i32) -> (Axis, f64) {
    let defaults = Params::default();
    let cycle = f64::from(steps) * defaults.period;
    let velocity = f64::from(units) * MICROMETRE / cycle;
    let params = Params {
        interpolation,
        cycle: CycleParams { steps, ..defaults.cycle },
        limits: Limits { velocity, ..defaults.limits },
        ..defaults
    };
    let mut axis = Axis::new(&params);
    axis.position = f64::from(position) * MICROMETRE;
    axis.enable(Mode::CyclicSynchronousPosition);
    (axis, velocity)
}

/// Oracle: at a velocity of at most `v` a step covers at most v·T. Roundings of positions of up to 2 km.
fn assert_steady(axis: &mut Axis, velocity: f64, what: &str) {
    let mut before = axis.position;
    let allowed = velocity * axis.params.period * (1.0 + 1e-9) + 4.0 * f64::EPSILON * before.abs();
    for outputs in axis.cycle() {
        let at = setpoint(&outputs.demand);
        assert!((at.x - before).abs() <= allowed, "{what}: {} in a step at {at:?}", at.x - before);
        assert!(at.v.abs() <= velocity * (1.0 + 1e-6), "{what}: {at:?}");
        before = at.x;
    }
}

/// Targets that require exactly the highest velocity, there and back and with rests between: nothing is cut, and nothing jumps.
#[test]
fn just_the_highest_velocity_is_followed_by_every_interpolation() {
    for interpolation in WAYS {
        for (position, steps, units) in
            [(0, 4, 500), (123_456_789, 4, 500), (-77_777, 3, 333), (2_000_000_000, 7, 7), (-1_234_567, 5, 7919)]
        {
            let (mut axis, velocity) = axis(interpolation, position, steps, units);
            let mut target = position;
            for n in 0..200 {
                let way = match n / 10 % 4 {
                    0 => units,
                    2 => -units,
                    _ => 0,
                };
                target += way;
                axis.frame.target_position = target;
                axis.frame.velocity_offset = axis.params.units.velocity(velocity * f64::from(way.signum()));
                if interpolation == interpolate::Mode::Cubic && n % 10 == 0 {
                    // A cubic that begins or ends at rest is faster in between than at its ends, so the offset of a line does not fit.
                    axis.frame.velocity_offset = 0;
                }
                assert_steady(&mut axis, velocity, &format!("{interpolation:?}, frame {n} from {position}"));
                let is_even = interpolation != interpolate::Mode::Cubic || n % 10 > 1;
                assert!(!(is_even && axis.has(StatusBit::InternalLimitActive)), "{interpolation:?}, frame {n}");
            }
        }
    }
}

/// Random targets: at, below and beyond the highest velocity, through zero. Bit 11 is set while the targets are cut.
#[test]
fn no_targets_make_the_demand_jump_or_pass_the_highest_velocity() {
    let mut random = Random::seeded(6080);
    let mut between =
        |low: i32, high: i32| low + i32::try_from(random.next() % u64::from(high.abs_diff(low) + 1)).unwrap();
    for (case, interpolation) in (0..300).zip(WAYS.into_iter().cycle()) {
        let (steps, units, mut target) = (between(1, 9), between(1, 5000), between(-1_000_000, 1_000_000));
        let (mut axis, velocity) = axis(interpolation, target, steps.unsigned_abs(), units);
        for n in 0..60 {
            target += match between(0, 4) {
                0 => 0,
                1 => units,
                2 => -units,
                3 => between(-units, units),
                _ => between(-3 * units, 3 * units),
            };
            axis.frame.target_position = target;
            let offset = 1.5e-3 * f64::from(between(-1000, 1000)) * velocity;
            axis.frame.velocity_offset =
                if interpolation == interpolate::Mode::Linear { 0 } else { axis.params.units.velocity(offset) };
            let what = format!("case {case}, {interpolation:?}, frame {n}");
            assert_steady(&mut axis, velocity, &what);
            if interpolation == interpolate::Mode::Linear {
                let is_behind = (axis.position - f64::from(target) * MICROMETRE).abs() > 0.5 * MICROMETRE;
                assert_eq!(axis.has(StatusBit::InternalLimitActive), is_behind, "{what}");
            }
        }
    }
}

/// 0.143 m/s commanded, 0.1 m/s allowed: interpolated position keeps the limit, reports it meanwhile, and catches up.
#[test]
fn interpolated_position_obeys_it_too() {
    let defaults = Params::default();
    let limits = Limits { velocity: 0.1, ..defaults.limits };
    let params = Params { sub_mode: SubMode::Cubic, limits, ..defaults };
    let mut axis = Axis::enabled(&params, Mode::InterpolatedPosition);
    for (position, time) in [(0, 7000), (1000, 20_000), (1001, 0)] {
        axis.state.trajectory_buffer().add(Point { position, velocity: Some(0), time, is_relative: false }).unwrap();
    }
    axis.frame.controlword = axis.frame.controlword.with(ControlBit::ModeSpecific4, true);
    for k in 0..108 {
        let before = axis.position;
        axis.step(k % 4 == 0);
        assert!((axis.position - before).abs() <= 25e-6 * (1.0 + 1e-9), "step {k}");
        assert_eq!(axis.has(StatusBit::InternalLimitActive), k < 28, "step {k}");
    }
    assert!((axis.position - 1001e-6).abs() < 1e-15, "{}", axis.position);
}
