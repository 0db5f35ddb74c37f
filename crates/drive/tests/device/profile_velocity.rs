//! Profile velocity and profile torque.
use crate::axis::{Axis, setpoint};
use servobench_cia402::{Mode, StatusBit};
use servobench_drive::Demand;
use servobench_drive::device::{Limits, Params, Window};
use servobench_drive::modes::profile::Ramp;

fn axis(params: &Params) -> Axis {
    let mut axis = Axis::enabled(params, Mode::ProfileVelocity);
    (axis.frame.profile_acceleration, axis.frame.profile_deceleration) = (1_000_000, 4_000_000);
    axis
}

/// Oracle: lines. Up at 1 m/s², down at 4 m/s², through zero with the slope changing there.
#[test]
fn velocities_go_linearly_by_acceleration_and_deceleration() {
    let mut axis = axis(&Params::default());
    let h = 250e-6;
    axis.frame.target_velocity = 100_000;
    for k in 0..500_i32 {
        let got = setpoint(&axis.step(k % 4 == 0).demand);
        let v = (f64::from(k) * h).min(0.1);
        // Each step rounds the sum once.
        assert!((got.v - v).abs() < 1e-14, "step {k}: {got:?} {v}");
        assert!((got.a - if k < 400 { 1.0 } else { 0.0 }).abs() < 1e-11, "step {k}: {got:?}");
    }
    // To zero within 0.025 s, then to the other side.
    axis.frame.target_velocity = -30_000;
    for k in 0..300_i32 {
        let got = setpoint(&axis.step(k % 4 == 0).demand);
        let t = f64::from(k) * h;
        let v = if t < 0.025 { 0.1 - 4.0 * t } else { -(t - 0.025).min(0.03) };
        assert!((got.v - v).abs() < 1e-14, "step {k}: {got:?} {v}");
    }
}

/// Oracle: 0.5 m/s² and a target between two steps: the last step is shorter, the velocity does not pass the target.
#[test]
fn a_target_between_two_steps_is_met_exactly() {
    let mut axis = axis(&Params::default());
    axis.frame.profile_acceleration = 700_000;
    axis.frame.target_velocity = 33_333;
    let velocities: Vec<_> = (0..400).map(|k| setpoint(&axis.step(k % 4 == 0).demand).v).collect();
    let target: f64 = 33_333.0 * 1e-6;
    assert!(velocities.iter().all(|v| *v <= target) && velocities[399].to_bits() == target.to_bits());
}

#[test]
fn bit_10_is_set_within_the_velocity_window_and_bit_12_at_standstill() {
    let params = Params {
        velocity: Window { width: 0.01, time: 0.005 },
        standstill: Window { width: 0.02, time: 0.002 },
        ..Params::default()
    };
    let mut axis = axis(&params);
    axis.cycle();
    assert!(axis.has(StatusBit::ModeSpecific12), "the axis stands");
    axis.frame.target_velocity = 100_000;
    let (mut moved, mut reached) = (None, None);
    for k in 0..500 {
        axis.step(k % 4 == 0);
        if moved.is_none() && !axis.has(StatusBit::ModeSpecific12) {
            moved = Some(k);
        }
        if reached.is_none() && axis.has(StatusBit::TargetReached) {
            reached = Some(k);
        }
    }
    // Above 0.02 m/s after 0.02 s and for 2 ms; within 0.01 m/s of 0.1 m/s after 0.09 s and for 5 ms. The axis is measured a
    // step later.
    assert!((88..=90).contains(&moved.unwrap()) && (380..=382).contains(&reached.unwrap()), "{moved:?} {reached:?}");
}

#[test]
fn a_target_velocity_beyond_the_highest_is_approached_as_far_and_the_drive_says_so() {
    let limits = Limits { profile_velocity: 0.05, ..Params::default().limits };
    let mut axis = axis(&Params { limits, ..Params::default() });
    axis.frame.target_velocity = -80_000;
    axis.cycles(100);
    assert!((axis.velocity + 0.05).abs() < 1e-15 && axis.has(StatusBit::InternalLimitActive), "{}", axis.velocity);
    assert!(!axis.has(StatusBit::TargetReached), "the target is another one");
}

#[test]
fn an_acceleration_beyond_the_highest_is_cut_and_the_drive_says_so() {
    let limits = Limits { acceleration: 0.5, ..Params::default().limits };
    let mut axis = axis(&Params { limits, ..Params::default() });
    axis.frame.target_velocity = 100_000;
    axis.cycles(50);
    assert!((axis.velocity - 0.025).abs() < 1e-14 && axis.has(StatusBit::InternalLimitActive), "{}", axis.velocity);
    axis.frame.profile_acceleration = 500_000;
    axis.cycle();
    assert!(!axis.has(StatusBit::InternalLimitActive));
}

/// Oracle: from rest to V within A and J takes V/A + A/J; half way it is at V/2 with A.
/// A new target meanwhile takes effect without a jump of the acceleration.
#[test]
fn jerk_limited_velocities_keep_their_jerk() {
    let mut params = Params::default();
    params.profile.ramp = Ramp::JerkLimited(20.0);
    let mut axis = axis(&params);
    axis.frame.profile_deceleration = 1_000_000;
    axis.frame.target_velocity = 100_000;
    let ramp: Vec<_> = (0..800).map(|k| setpoint(&axis.step(k % 4 == 0).demand)).collect();
    // 0.15 s: 300 steps are half of it.
    assert!((ramp[300].v - 0.05).abs() < 1e-14 && (ramp[300].a - 1.0).abs() < 1e-12, "{:?}", ramp[300]);
    assert!(ramp[599].v < 0.1 && (ramp[600].v - 0.1).abs() < 1e-15, "{:?} {:?}", ramp[599], ramp[600]);
    axis.frame.target_velocity = -100_000;
    let back = (0..500).map(|k| setpoint(&axis.step(k % 4 == 0).demand));
    let mut way: Vec<_> = ramp.into_iter().chain(back).collect();
    axis.frame.target_velocity = 50_000;
    way.extend((0..1200).map(|k| setpoint(&axis.step(k % 4 == 0).demand)));
    for (k, pair) in way.windows(2).enumerate() {
        assert!((pair[1].a - pair[0].a).abs() <= 20.0 * 250e-6 + 1e-11, "step {k}: {pair:?}");
        assert!(pair[0].a.abs() <= 1.0 + 1e-11, "step {k}: {pair:?}");
    }
    assert!((way.last().unwrap().v - 0.05).abs() < 1e-15);
}

/// Oracle: 100 N·m/s over 0.25 ms steps.
#[test]
fn efforts_go_linearly_by_the_torque_slope() {
    let mut params = Params::default();
    params.profile.effort_slope = 100.0;
    let mut axis = Axis::enabled(&params, Mode::ProfileTorque);
    axis.frame.target_torque = 410;
    let efforts: Vec<_> = (0..24)
        .map(|k| {
            let Demand::Effort(effort) = axis.step(k % 4 == 0).demand else { panic!("no effort") };
            (effort, axis.has(StatusBit::TargetReached))
        })
        .collect();
    for (k, (effort, is_reached)) in (0..).zip(&efforts) {
        assert!((effort - (0.025 * f64::from(k)).min(0.41)).abs() < 1e-15, "step {k}: {effort}");
        assert_eq!(*is_reached, k >= 17, "step {k}");
    }
}
