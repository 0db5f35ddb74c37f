//! Cyclic synchronous position, velocity and torque.
use crate::axis::{Axis, setpoint};
use servobench_cia402::{ControlBit, Mode, StatusBit};
use servobench_drive::device::{CycleParams, Fault, Limits, Params};
use servobench_drive::{Demand, EffortLimits};
use servobench_motion::interpolate;

const MICROMETRE: f64 = 1e-6;

/// Oracle: by hand. The target of a frame is reached a cycle later, on a line.
#[test]
fn linear_targets_are_reached_a_cycle_later() {
    let mut axis = Axis::enabled(&Params::default(), Mode::CyclicSynchronousPosition);
    let targets = [0, 100, 300, 600, 600, 500];
    let mut before = 0;
    for target in targets {
        axis.frame.target_position = target;
        for (k, outputs) in axis.cycle().iter().enumerate() {
            let passed = k as f64 / 4.0;
            let line = f64::from(before) + passed * f64::from(target - before);
            let got = setpoint(&outputs.demand);
            assert!((got.x - line * MICROMETRE).abs() < 1e-18, "towards {target}, step {k}: {got:?}");
            assert!((got.v - f64::from(target - before) * MICROMETRE / 1e-3).abs() < 1e-15, "{got:?}");
        }
        assert!(axis.has(StatusBit::ModeSpecific12), "the drive follows");
        before = target;
    }
}

/// Oracle: the sum by hand (IEC 61800-7-201, cyclic synchronous position mode), across the end of the counter too. The offset
/// has no effect in modes for which the profile does not define it.
#[test]
fn the_position_offset_is_added_to_the_target_of_csp_alone() {
    let mut axis = Axis::enabled(&Params::default(), Mode::CyclicSynchronousPosition);
    for (target, offset, sum) in [(100, 20, 120), (100, -30, 70), (i32::MAX, i32::MIN + 101, 100)] {
        (axis.frame.target_position, axis.frame.position_offset) = (target, offset);
        axis.cycle();
        // A femtometre: the last of the cycle's four steps adds up from its beginning.
        assert!(
            (axis.position - f64::from(sum) * MICROMETRE).abs() < 1e-15,
            "{target} and {offset}: {}",
            axis.position
        );
    }
    let mut axis = Axis::enabled(&Params::default(), Mode::ProfilePosition);
    (axis.frame.target_position, axis.frame.position_offset) = (100, 20);
    axis.frame.controlword = axis.frame.controlword.with(ControlBit::ModeSpecific4, true);
    axis.cycles(2000);
    assert_eq!(axis.actuals().position, 100);
}

/// Oracle: x = t³ is a cubic with the velocity 3t² at the frames: interpolation reproduces it.
#[test]
fn cubic_interpolation_by_the_velocity_offsets_is_exact_for_cubics() {
    let params = Params {
        interpolation: interpolate::Mode::Cubic,
        cycle: CycleParams { steps: 8, ..Params::default().cycle },
        ..Params::default()
    };
    let mut axis = Axis::enabled(&params, Mode::CyclicSynchronousPosition);
    let cycle = 2e-3;
    // In µm: 1000·n³ at frame n, so that every value is a whole number.
    for n in 1..=5_i32 {
        axis.frame.target_position = 1000 * n.pow(3);
        axis.frame.velocity_offset = 3000 * n.pow(2) * 500;
        for (k, outputs) in axis.cycle().iter().enumerate() {
            let u = f64::from(n - 1) + k as f64 / 8.0;
            let got = setpoint(&outputs.demand);
            let (x, v, a) = (1e-3 * u.powi(3), 3e-3 * u * u / cycle, 6e-3 * u / cycle.powi(2));
            assert!((got.x - x).abs() < 1e-15 * 125.0, "frame {n}, step {k}: {got:?} {x}");
            assert!((got.v - v).abs() < 1e-12 && (got.a - a).abs() < 1e-8, "frame {n}, step {k}: {got:?} {v} {a}");
        }
    }
}

/// Every interpolation reproduces a line; the B-spline does so a cycle later.
#[test]
fn a_b_spline_keeps_a_line_a_cycle_later() {
    let params = Params { interpolation: interpolate::Mode::CubicBSpline, ..Params::default() };
    let mut axis = Axis::enabled(&params, Mode::CyclicSynchronousPosition);
    for n in 1..=10_i32 {
        axis.frame.target_position = 50 * n;
        for (k, outputs) in axis.cycle().iter().enumerate() {
            let got = setpoint(&outputs.demand);
            if n >= 5 {
                let x = 50e-6 * (f64::from(n) - 2.0 + k as f64 / 4.0);
                assert!((got.x - x).abs() < 1e-17 && (got.v - 0.05).abs() < 1e-13, "frame {n}, step {k}: {got:?}");
            }
        }
    }
}

#[test]
fn offsets_go_linearly_to_their_values_within_the_cycle() {
    let mut axis = Axis::enabled(&Params::default(), Mode::CyclicSynchronousPosition);
    (axis.frame.velocity_offset, axis.frame.torque_offset) = (4000, 200);
    for (k, outputs) in axis.cycle().iter().enumerate() {
        let Demand::Position { velocity_offset, effort_offset, .. } = outputs.demand else { panic!("{outputs:?}") };
        let passed = k as f64 / 4.0;
        assert!((velocity_offset - passed * 4e-3).abs() < 1e-18 && (effort_offset - passed * 0.2).abs() < 1e-16);
    }
}

/// Oracle: 0.1 m/s are 100 µm a cycle.
#[test]
fn a_target_too_far_away_is_approached_with_the_highest_velocity_and_the_drive_says_so() {
    let limits = Limits { velocity: 0.1, ..Params::default().limits };
    let mut axis = Axis::enabled(&Params { limits, ..Params::default() }, Mode::CyclicSynchronousPosition);
    axis.frame.target_position = 1050;
    for n in 1..=10 {
        axis.cycle();
        assert!(axis.has(StatusBit::InternalLimitActive), "cycle {n}");
        assert!((axis.position - 1e-4 * f64::from(n)).abs() < 1e-15, "cycle {n}: {}", axis.position);
    }
    axis.cycle();
    assert!(!axis.has(StatusBit::InternalLimitActive));
    assert!((axis.position - 1.05e-3).abs() < 1e-15);
}

#[test]
fn a_missing_frame_is_bridged_at_the_last_velocity_and_too_many_are_a_fault() {
    let mut axis = Axis::enabled(&Params::default(), Mode::CyclicSynchronousPosition);
    for n in 1..=3 {
        axis.frame.target_position = 100 * n;
        axis.cycle();
    }
    // Two cycles without a frame are bridged, the third is a fault.
    for k in 0..8_i32 {
        let outputs = axis.step(false);
        let x = 3e-4 + 1e-4 * f64::from(k) / 4.0;
        assert!((setpoint(&outputs.demand).x - x).abs() < 1e-17 && outputs.fault.is_none(), "step {k}: {outputs:?}");
        assert!(axis.has(StatusBit::Warning));
    }
    let outputs = axis.step(false);
    assert_eq!((outputs.fault, outputs.transition.unwrap().number), (Some(Fault::FramesMissing), 13));
    assert_eq!(axis.actuals().error_code, 0x8700);
}

#[test]
fn missing_frames_count_only_in_a_row() {
    let mut axis = Axis::enabled(&Params::default(), Mode::CyclicSynchronousPosition);
    for n in 0..20 {
        axis.frame.target_position = 100 * n;
        for k in 0..4 {
            // Every other one, two of which would be one too many.
            assert_eq!(axis.step(k == 0 && n % 2 == 0).fault, None, "frame {n}");
        }
    }
}

#[test]
fn frames_that_come_late_by_less_than_the_shift_lose_nothing() {
    let cycle = CycleParams { steps: 4, shift: 2, bridged: 0 };
    let mut axis = Axis::enabled(&Params { cycle, ..Params::default() }, Mode::CyclicSynchronousPosition);
    for (n, late) in (0..).zip([0, 1, 2, 0, 2, 1, 1, 0]) {
        axis.frame.target_position = 100 * (n + 1);
        for k in 0..4 {
            let outputs = axis.step(k == late);
            assert!(outputs.fault.is_none());
            // The cycle of frame n begins two steps after it should have come.
            let steps = 4 * n + k - 2;
            let x = 25e-6 * f64::from(steps.max(0));
            assert!((setpoint(&outputs.demand).x - x).abs() < 1e-16, "frame {n}, step {k}: {outputs:?} {x}");
        }
    }
}

/// Frame n of a line comes `late[n]` steps late: the set-point of the loops at each step, and true if a cycle is missing its frame.
fn line_with_late_frames(params: &Params, late: &[i32]) -> Vec<(servobench_base::Setpoint, bool)> {
    let mut axis = Axis::enabled(params, Mode::CyclicSynchronousPosition);
    let mut seen = Vec::new();
    for (n, late) in (1..).zip(late) {
        axis.frame.target_position = 100 * n;
        for k in 0..4 {
            let outputs = axis.step(k == *late);
            assert_eq!(outputs.fault, None, "frame {n}");
            seen.push((setpoint(&outputs.demand), axis.has(StatusBit::Warning)));
        }
    }
    seen
}

/// Oracle: by hand. Each frame that is later by a step than any before it moves the clock by a step, 25 µm on this line: the
/// velocity of that cycle is 3/4 of the others'. Afterwards frames in time and those up to two steps late have the same effect.
#[test]
fn the_clock_follows_the_latest_of_the_frames() {
    let late = [0, 0, 0, 1, 0, 2, 0, 0, 1, 2, 0, 1, 2, 2, 0, 0];
    for interpolation in [interpolate::Mode::Linear, interpolate::Mode::CubicBSpline] {
        let seen = line_with_late_frames(&Params { interpolation, ..Params::default() }, &late);
        for (k, pair) in seen.windows(2).enumerate().skip(8) {
            let [(before, _), (after, is_missing)] = [pair[0], pair[1]];
            assert!((18.7e-6..25.1e-6).contains(&(after.x - before.x)), "{interpolation:?}, step {k}: {pair:?}");
            assert!(k < 24 || !is_missing, "{interpolation:?}, step {k}");
        }
    }
    // A step is 25 µm; the target of frame n is reached a cycle and two steps after it should have come.
    let seen = line_with_late_frames(&Params::default(), &late);
    for (k, (setpoint, _)) in (0..).zip(&seen).skip(48) {
        assert!((setpoint.x - 25e-6 * f64::from(k - 2)).abs() < 1e-15, "step {k}: {setpoint:?}");
    }
}

#[test]
fn late_velocities_and_efforts_go_on_from_what_they_are() {
    for mode in [Mode::CyclicSynchronousVelocity, Mode::CyclicSynchronousTorque] {
        let mut axis = Axis::enabled(&Params::default(), mode);
        let mut values = Vec::new();
        for (n, late) in (1_i16..).zip([0, 0, 2, 0, 1, 0, 0]) {
            (axis.frame.target_velocity, axis.frame.target_torque) = (10_000 * i32::from(n), 10 * n);
            for k in 0..4 {
                values.push(match axis.step(k == late).demand {
                    Demand::Effort(effort) => effort,
                    demand => setpoint(&demand).v,
                });
            }
        }
        for pair in values.windows(2) {
            // At most the slope of the frames, 10 mm/s or 10 mN·m a cycle, and after a stretch without one twice that.
            assert!((-1e-15..=0.0051).contains(&(pair[1] - pair[0])), "{mode:?}: {pair:?}");
        }
    }
}

/// Oracle: by hand: from 0 to 0.2 m/s in a millisecond is 200 m/s².
#[test]
fn cyclic_velocities_are_ramps_between_the_frames() {
    let mut axis = Axis::enabled(&Params::default(), Mode::CyclicSynchronousVelocity);
    (axis.frame.target_velocity, axis.frame.velocity_offset) = (150_000, 50_000);
    for (k, outputs) in axis.cycle().iter().enumerate() {
        let got = setpoint(&outputs.demand);
        assert!((got.v - 0.05 * k as f64).abs() < 1e-16 && (got.a - 200.0).abs() < 1e-10, "step {k}: {got:?}");
    }
    assert!(axis.cycle().iter().all(|outputs| (setpoint(&outputs.demand).v - 0.2).abs() < 1e-16));
}

#[test]
fn cyclic_efforts_are_ramps_between_the_frames_within_the_limits_of_their_direction() {
    let limits = Limits { effort: EffortLimits { forward: 0.5, backward: 0.25 }, ..Params::default().limits };
    let mut axis = Axis::enabled(&Params { limits, ..Params::default() }, Mode::CyclicSynchronousTorque);
    let mut efforts = |target, offset| {
        (axis.frame.target_torque, axis.frame.torque_offset) = (target, offset);
        let efforts: Vec<_> = axis
            .cycle()
            .iter()
            .map(|outputs| {
                let Demand::Effort(effort) = outputs.demand else { panic!("{outputs:?}") };
                effort
            })
            .collect();
        (efforts, axis.has(StatusBit::InternalLimitActive))
    };
    assert_eq!(efforts(300, 100), (vec![0.0, 0.1, 0.2, 0.30000000000000004], false));
    assert_eq!(efforts(900, -100), (vec![0.4, 0.5, 0.5, 0.5], true));
    assert_eq!(efforts(-800, 0), (vec![0.5, 0.4, 0.0, -0.25], true));
}

/// Oracle: the lower of the direction's object and the limit in the frame, in thousandths of the rated effort.
#[test]
fn a_frame_limits_the_effort_in_every_mode_until_one_comes_that_does_not() {
    let limits = Limits { effort: EffortLimits { forward: 0.5, backward: 0.25 }, ..Params::default().limits };
    let params = Params { limits, ..Params::default() };
    for mode in [
        Mode::CyclicSynchronousPosition,
        Mode::CyclicSynchronousVelocity,
        Mode::CyclicSynchronousTorque,
        Mode::ProfilePosition,
        Mode::ProfileVelocity,
        Mode::ProfileTorque,
        Mode::InterpolatedPosition,
        Mode::Homing,
    ] {
        let mut axis = Axis::enabled(&params, mode);
        let mut limited = |max_torque| {
            axis.frame.max_torque = max_torque;
            axis.cycle().pop().map(|outputs| outputs.effort_limits)
        };
        for (max_torque, forward, backward) in
            [(None, 0.5, 0.25), (Some(400), 0.4, 0.25), (Some(100), 0.1, 0.1), (Some(u16::MAX), 0.5, 0.25)]
        {
            assert_eq!(limited(max_torque), Some(EffortLimits { forward, backward }), "{mode:?} {max_torque:?}");
        }
    }
}
