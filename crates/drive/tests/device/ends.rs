//! Limit switches and software limits.
use crate::axis::{Axis, setpoint};
use servobench_cia402::{ControlBit, Mode, StatusBit};
use servobench_drive::Demand;
use servobench_drive::device::{Limits, Params};

/// Bits 11 and 12.
fn bits(axis: &Axis) -> [bool; 2] {
    [axis.has(StatusBit::InternalLimitActive), axis.has(StatusBit::ModeSpecific12)]
}

/// Oracle: from 0.2 m/s by the 10 m/s² of the quick stop the axis needs 2 mm.
#[test]
fn a_limit_switch_stops_the_axis_in_its_direction_and_lets_it_go_back() {
    for sign in [1, -1] {
        let mut axis = Axis::enabled(&Params::default(), Mode::CyclicSynchronousPosition);
        let mut target = 0;
        let mut follow = |axis: &mut Axis, step: i32, cycles: i32| {
            for _ in 0..cycles {
                target += sign * step;
                axis.frame.target_position = target;
                axis.cycle();
            }
        };
        follow(&mut axis, 200, 20);
        // Limited (bit 11), follows the command value (bit 12).
        assert_eq!(bits(&axis), [false, true]);
        let at_switch = axis.position;
        (axis.measured.positive_limit, axis.measured.negative_limit) = (sign > 0, sign < 0);
        follow(&mut axis, 200, 40);
        let way = f64::from(sign) * (axis.position - at_switch);
        assert!((way - 2e-3).abs() < 1e-12 && axis.velocity == 0.0, "{way}");
        assert_eq!(bits(&axis), [true, false]);
        // Back: held until the targets are on the near side of the axis, then followed.
        follow(&mut axis, -200, 20);
        assert!((f64::from(sign) * (axis.position - at_switch) - 2e-3).abs() < 1e-12);
        assert_eq!(bits(&axis), [true, false]);
        follow(&mut axis, -200, 30);
        assert_eq!(bits(&axis), [false, true]);
        assert!((axis.position - f64::from(axis.frame.target_position) * 1e-6).abs() < 1e-15);
    }
}

/// The switch of the other end stops nothing.
#[test]
fn a_limit_switch_does_not_keep_the_axis_from_leaving_it() {
    let mut axis = Axis::enabled(&Params::default(), Mode::ProfileVelocity);
    axis.measured.negative_limit = true;
    axis.frame.target_velocity = 100_000;
    axis.cycles(200);
    assert!((axis.velocity - 0.1).abs() < 1e-15 && !axis.has(StatusBit::InternalLimitActive));
}

#[test]
fn velocities_and_efforts_are_held_at_a_switch_too() {
    for mode in [Mode::ProfileVelocity, Mode::CyclicSynchronousVelocity, Mode::CyclicSynchronousTorque] {
        let mut axis = Axis::enabled(&Params::default(), mode);
        (axis.frame.target_velocity, axis.frame.target_torque) = (100_000, 100);
        axis.cycles(200);
        axis.velocity = 0.1;
        axis.measured.positive_limit = true;
        axis.cycles(200);
        assert!(matches!(axis.last, Demand::Velocity { .. }) && setpoint(&axis.last).v == 0.0, "{mode:?}");
        assert!(axis.has(StatusBit::InternalLimitActive));
        // In profile velocity bit 12 means standstill; a cyclic mode does not follow the master here.
        assert_eq!(axis.has(StatusBit::ModeSpecific12), mode == Mode::ProfileVelocity, "{mode:?}");
        (axis.frame.target_velocity, axis.frame.target_torque) = (-100_000, -100);
        axis.cycles(200);
        assert_eq!(axis.has(StatusBit::ModeSpecific12), mode != Mode::ProfileVelocity, "{mode:?}");
        match axis.last {
            Demand::Effort(effort) => assert!((effort + 0.1).abs() < 1e-15),
            demand => assert!((setpoint(&demand).v + 0.1).abs() < 1e-15, "{mode:?}: {demand:?}"),
        }
    }
}

#[test]
fn cyclic_targets_beyond_the_software_limits_are_cut() {
    let limits = Limits { position: Some([-1e-3, 2e-3]), ..Params::default().limits };
    let mut axis = Axis::enabled(&Params { limits, ..Params::default() }, Mode::CyclicSynchronousPosition);
    for (target, reached) in [(1500, 1500), (2500, 2000), (2000, 2000), (-500, -500), (-4000, -1000), (0, 0)] {
        axis.frame.target_position = target;
        axis.cycle();
        assert_eq!(bits(&axis), [target != reached, target == reached], "{target}");
        assert!((axis.position - f64::from(reached) * 1e-6).abs() < 1e-15, "{target}: {}", axis.position);
    }
}

/// Oracle: the quick stop begins when the axis is at the limit: 5 mm and the 0.5 mm of 0.1 m/s by 10 m/s².
#[test]
fn a_velocity_that_leads_beyond_a_software_limit_is_braked_there() {
    let limits = Limits { position: Some([-5e-3, 5e-3]), ..Params::default().limits };
    let mut axis = Axis::enabled(&Params { limits, ..Params::default() }, Mode::CyclicSynchronousVelocity);
    axis.frame.target_velocity = 100_000;
    axis.cycles(100);
    // Seen at the first step behind the limit, 25 µm later at most.
    assert!((5.5e-3..5.53e-3).contains(&axis.position), "{}", axis.position);
    assert!(setpoint(&axis.last).v == 0.0);
}

/// A master that sees the switch halts the axis by the deceleration of the profile, which is gentler than the quick stop.
#[test]
fn a_halt_at_a_limit_switch_does_not_make_the_way_longer() {
    let mut axis = Axis::enabled(&Params::default(), Mode::CyclicSynchronousPosition);
    let mut at_switch = 0.0;
    for n in 1..=22 {
        if n == 21 {
            (at_switch, axis.measured.positive_limit) = (axis.position, true);
        }
        axis.frame.target_position = 200 * n;
        axis.cycle();
    }
    axis.frame.controlword = axis.frame.controlword.with(ControlBit::Halt, true);
    axis.cycles(40);
    let way = axis.position - at_switch;
    assert!((way - 2e-3).abs() < 1e-12 && axis.velocity == 0.0, "{way}");
    assert!(axis.has(StatusBit::InternalLimitActive));
}

/// Directions in which a drive moves at 0.1 m/s, with switches wired and read as given, beyond the positive end or in between. The
/// master sees the inputs as they are.
#[test]
fn a_switch_is_met_by_its_input_and_by_how_that_is_read() {
    for (is_closed, reverse_switches, is_beyond) in
        [false, true].into_iter().flat_map(|a| [false, true].map(|b| [false, true].map(|c| (a, b, c)))).flatten()
    {
        let level = |is_met: bool| is_met != is_closed;
        for sign in [1, -1] {
            let params = Params { reverse_switches, ..Params::default() };
            let mut axis = Axis::new(&params);
            (axis.measured.negative_limit, axis.measured.home) = (level(false), level(false));
            axis.measured.positive_limit = level(is_beyond);
            axis.enable(Mode::ProfileVelocity);
            axis.frame.target_velocity = sign * 100_000;
            axis.cycles(200);
            let is_met = if is_closed == reverse_switches { is_beyond && sign > 0 } else { !(is_beyond && sign > 0) };
            let what = format!("{is_closed} {reverse_switches} {is_beyond} {sign}");
            assert_eq!((axis.velocity == 0.0, bits(&axis)[0]), (is_met, is_met), "{what}");
            let inputs = if is_closed { 0b111 } else { 0 } ^ u32::from(is_beyond) << 1;
            assert_eq!(axis.actuals().digital_inputs, inputs, "{what}");
        }
    }
}
