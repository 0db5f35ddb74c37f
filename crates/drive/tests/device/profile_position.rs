//! Profile position: the distances, against closed forms.
use crate::axis::{Axis, setpoint};
use servobench_cia402::{ControlBit, Mode, StatusBit};
use servobench_drive::device::{Limits, Params};
use servobench_drive::modes::profile::Ramp;

fn axis(params: &Params) -> Axis {
    let mut axis = Axis::enabled(params, Mode::ProfilePosition);
    axis.frame.profile_velocity = 100_000;
    (axis.frame.profile_acceleration, axis.frame.profile_deceleration) = (1_000_000, 2_000_000);
    axis
}

/// Commands a target; the set-points from that step on.
fn positions(axis: &mut Axis, target: i32, steps: usize) -> Vec<servobench_base::Setpoint> {
    axis.frame.target_position = target;
    axis.frame.controlword = axis.frame.controlword.with(ControlBit::ModeSpecific4, true);
    (0..steps).map(|k| setpoint(&axis.step(k % 4 == 0).demand)).collect()
}

/// Oracle: 0.1 m/s by 1 m/s² up and 2 m/s² down: 5 mm and 0.1 s, 2.5 mm and 0.05 s, between them 12.5 mm in 0.125 s.
#[test]
fn a_trapezoid_has_its_own_ramps_up_and_down() {
    let mut axis = axis(&Params::default());
    for (k, got) in positions(&mut axis, 20_000, 1200).iter().enumerate() {
        let t = k as f64 * 250e-6;
        let (x, v) = if t < 0.1 {
            (0.5 * t * t, t)
        } else if t < 0.225 {
            (0.005 + 0.1 * (t - 0.1), 0.1)
        } else if t < 0.275 {
            let left = 0.275 - t;
            (0.02 - left * left, 2.0 * left)
        } else {
            (0.02, 0.0)
        };
        assert!((got.x - x).abs() < 1e-15 && (got.v - v).abs() < 1e-14, "step {k}: {got:?} {x} {v}");
    }
    assert!(axis.has(StatusBit::TargetReached));
}

/// Oracle: rest to rest with a cruise and full acceleration takes D/V + V/A + A/J, with half the distance after half the time.
#[test]
fn a_jerk_limited_move_keeps_its_jerk_and_takes_its_time() {
    let mut params = Params::default();
    params.profile.ramp = Ramp::JerkLimited(20.0);
    let mut axis = axis(&params);
    axis.frame.profile_deceleration = 1_000_000;
    let time = 0.02 / 0.1 + 0.1 / 1.0 + 1.0 / 20.0;
    let way = positions(&mut axis, 20_000, 1500);
    assert!((way[700].x - 0.01).abs() < 1e-12, "0.175 s: {:?}", way[700]);
    for (k, pair) in way.windows(2).enumerate() {
        assert!(pair[0].j.abs() <= 20.0 && pair[0].a.abs() <= 1.0 + 1e-12, "step {k}: {:?}", pair[0]);
        assert!((pair[1].a - pair[0].a).abs() <= 20.0 * 250e-6 + 1e-12, "step {k}: {pair:?}");
        assert_eq!(k as f64 * 250e-6 < time - 1e-9, pair[0].v != 0.0 || k == 0, "step {k}: {:?}", pair[0]);
    }
}

/// Oracle: the axis passes the target at 0.04 m/s and continues at that velocity.
#[test]
fn an_end_velocity_is_that_of_the_axis_at_the_target_and_after_it() {
    let mut params = Params::default();
    params.profile.end_velocity = 0.04;
    let mut axis = axis(&params);
    let way = positions(&mut axis, 20_000, 1500);
    let after = way.iter().position(|setpoint| setpoint.x > 0.02).unwrap();
    for (k, got) in way[after..].iter().enumerate() {
        let x = way[after].x + k as f64 * 250e-6 * 0.04;
        assert!((got.v - 0.04).abs() < 1e-12 && (got.x - x).abs() < 1e-14, "{got:?}");
    }
}

#[test]
fn targets_beyond_the_software_limits_are_cut_to_them_and_the_drive_says_so() {
    let limits = Limits { position: Some([-0.01, 0.015]), ..Params::default().limits };
    let mut axis = axis(&Params { limits, ..Params::default() });
    let way = positions(&mut axis, 20_000, 1500);
    assert!(axis.has(StatusBit::InternalLimitActive) && axis.has(StatusBit::TargetReached));
    assert!((way[1499].x - 0.015).abs() < 1e-15 && way.iter().all(|setpoint| setpoint.x <= 0.015 + 1e-15));
    axis.frame.controlword = axis.frame.controlword.with(ControlBit::ModeSpecific4, false);
    axis.cycle();
    positions(&mut axis, 0, 1500);
    assert!(!axis.has(StatusBit::InternalLimitActive) && axis.position.abs() < 1e-15);
}

#[test]
fn a_profile_velocity_beyond_the_highest_one_is_cut_and_the_drive_says_so() {
    let limits = Limits { profile_velocity: 0.06, ..Params::default().limits };
    let mut axis = axis(&Params { limits, ..Params::default() });
    let way = positions(&mut axis, 20_000, 1000);
    assert!(axis.has(StatusBit::InternalLimitActive));
    let highest = way.iter().map(|setpoint| setpoint.v).fold(0.0, f64::max);
    assert!((highest - 0.06).abs() < 1e-15, "{highest}");
}

/// An absolute target lies in the same turn of the 32-bit counter as the axis, and a relative one leads through its end.
#[test]
fn targets_count_from_the_turn_of_the_counter_in_which_the_axis_is() {
    let mut axis = Axis::new(&Params::default());
    // Near the end of the first turn: 2³¹ µm are 2147.483648 m.
    axis.position = 2147.47;
    axis.enable(Mode::ProfilePosition);
    axis.frame.profile_velocity = 100_000;
    axis.frame.controlword = axis.frame.controlword.with(ControlBit::ModeSpecific6, true);
    positions(&mut axis, 20_000, 2000);
    // Doubles at 2 km resolve 5e-13 m.
    assert!((axis.position - 2147.49).abs() < 1e-11, "{}", axis.position);
    assert_eq!(i64::from(axis.actuals().position), 2_147_490_000 - (1 << 32), "the counter has wrapped");
    // 10 mm on, by its absolute position in the turn.
    axis.frame.controlword = axis.frame.controlword.with(ControlBit::ModeSpecific6, false);
    axis.frame.controlword = axis.frame.controlword.with(ControlBit::ModeSpecific4, false);
    axis.cycle();
    let target = axis.actuals().position + 10_000;
    positions(&mut axis, target, 2000);
    assert!((axis.position - 2147.5).abs() < 1e-11, "{}", axis.position);
}

/// The shorter way would lead through the end of the counter.
#[test]
fn an_absolute_target_is_not_reached_through_the_end_of_the_counter() {
    let mut axis = Axis::new(&Params::default());
    axis.position = 2000.0;
    axis.enable(Mode::ProfilePosition);
    axis.frame.profile_velocity = u32::MAX;
    (axis.frame.profile_acceleration, axis.frame.profile_deceleration) = (u32::MAX, u32::MAX);
    positions(&mut axis, -2_000_000_000, 10_000);
    assert!((axis.position + 2000.0).abs() < 1e-9, "{}", axis.position);
}
