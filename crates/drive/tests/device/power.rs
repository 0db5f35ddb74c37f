//! Power on and off, stops, take-over.
use crate::axis::{Axis, setpoint};
use servobench_cia402::{
    Command, ControlBit, DisableOperationOption, HaltOption, Mode, PowerState, QuickStopOption, ShutdownOption,
    StatusBit,
};
use servobench_drive::Demand;
use servobench_drive::device::Params;

#[test]
fn an_axis_that_was_moved_is_held_where_it_is_when_it_is_enabled() {
    let mut axis = Axis::new(&Params::default());
    axis.position = 0.123;
    axis.enable(Mode::CyclicSynchronousPosition);
    assert_eq!(axis.state.power(), PowerState::OperationEnabled);
    assert_eq!(axis.actuals().mode, 8);
    assert_eq!(axis.actuals().position, 123_000);
    let got = setpoint(&axis.last);
    assert!((got.x - 0.123).abs() < 1e-15 && got.v.abs() < 1e-12, "{got:?}");
}

/// An axis that moves at 0.2 m/s when it is stopped.
fn moving(params: &Params, mode: Mode) -> Axis {
    let mut axis = Axis::enabled(params, mode);
    axis.frame.profile_acceleration = 100_000_000;
    axis.frame.profile_velocity = 200_000;
    axis.frame.target_velocity = 200_000;
    axis.frame.controlword = axis.frame.controlword.with(ControlBit::ModeSpecific4, true);
    for n in 1..=20 {
        axis.frame.target_position = if mode == Mode::ProfilePosition { 100_000 } else { 200 * n };
        axis.cycle();
    }
    assert!((axis.velocity - 0.2).abs() < 1e-12, "{mode:?}: {}", axis.velocity);
    axis.frame.profile_acceleration = 0;
    axis
}

const MODES: [Mode; 4] =
    [Mode::CyclicSynchronousPosition, Mode::CyclicSynchronousVelocity, Mode::ProfilePosition, Mode::ProfileVelocity];

/// Oracle: v = 0.2 m/s − d·t, to standstill after v/d on v²/2d.
fn assert_brakes(axis: &mut Axis, deceleration: f64, what: &str) {
    let (from, h) = (axis.position, axis.params.period);
    let mut stopped_after = None;
    for k in 0..2000 {
        let outputs = axis.step(k % 4 == 0);
        if outputs.demand == Demand::Off {
            break;
        }
        let got = setpoint(&outputs.demand);
        let t = f64::from(k) * h;
        let v = (0.2 - deceleration * t).max(0.0);
        assert!((got.v - v).abs() < 1e-12, "{what}, step {k}: {got:?} {v}");
        if v == 0.0 && stopped_after.is_none() {
            stopped_after = Some(axis.position - from);
        }
    }
    // The axis moves by whole steps: the last one is not cut at the end of the ramp.
    let way = 0.02 / deceleration;
    assert!((stopped_after.unwrap() - way).abs() < 0.5 * deceleration * h * h + 1e-12, "{what}: {stopped_after:?}");
}

#[test]
fn a_quick_stop_brakes_on_its_ramp_and_switches_off_or_stays() {
    for mode in MODES {
        for (option, deceleration, last) in [
            (QuickStopOption::SlowDownRamp, 1.0, PowerState::SwitchOnDisabled),
            (QuickStopOption::QuickStopRamp, 10.0, PowerState::SwitchOnDisabled),
            (QuickStopOption::SlowDownRampAndStay, 1.0, PowerState::QuickStopActive),
            (QuickStopOption::QuickStopRampAndStay, 10.0, PowerState::QuickStopActive),
        ] {
            let mut params = Params::default();
            params.power.quick_stop = option;
            let mut axis = moving(&params, mode);
            axis.command(Command::QuickStop);
            assert_brakes(&mut axis, deceleration, &format!("{mode:?}, {option:?}"));
            assert_eq!(axis.state.power(), last, "{mode:?}, {option:?}");
            assert_eq!(axis.last == Demand::Off, last == PowerState::SwitchOnDisabled);
            if last == PowerState::QuickStopActive {
                assert!(axis.has(StatusBit::TargetReached), "stands");
            }
        }
    }
}

#[test]
fn halt_shutdown_and_disable_operation_brake_as_their_option_codes_say() {
    for mode in MODES {
        let mut params = Params::default();
        params.power.halt = HaltOption::QuickStopRamp;
        params.power.shutdown = ShutdownOption::SlowDownRamp;
        params.power.disable_operation = DisableOperationOption::SlowDownRamp;
        let mut axis = moving(&params, mode);
        axis.frame.controlword = axis.frame.controlword.with(ControlBit::Halt, true);
        assert_brakes(&mut axis, 10.0, &format!("{mode:?}, halt"));
        assert_eq!(axis.state.power(), PowerState::OperationEnabled);
        for (command, last) in
            [(Command::Shutdown, PowerState::ReadyToSwitchOn), (Command::DisableOperation, PowerState::SwitchedOn)]
        {
            let mut axis = moving(&params, mode);
            axis.command(command);
            assert_brakes(&mut axis, 1.0, &format!("{mode:?}, {command:?}"));
            assert_eq!((axis.state.power(), axis.last), (last, Demand::Off), "{mode:?}, {command:?}");
        }
    }
}

#[test]
fn what_is_switched_off_at_once_is_off_in_the_same_step() {
    for (command, option) in [
        (Command::DisableVoltage, None),
        (Command::Shutdown, None),
        (Command::QuickStop, Some(QuickStopOption::Disable)),
    ] {
        let mut params = Params::default();
        params.power.quick_stop = option.unwrap_or_default();
        let mut axis = moving(&params, Mode::CyclicSynchronousPosition);
        axis.command(command);
        assert_eq!(axis.step(true).demand, Demand::Off, "{command:?}");
    }
}

#[test]
fn at_the_current_limit_the_velocity_loop_is_asked_for_standstill() {
    let mut params = Params::default();
    params.power.quick_stop = QuickStopOption::CurrentLimit;
    let mut axis = moving(&params, Mode::CyclicSynchronousPosition);
    axis.command(Command::QuickStop);
    let Demand::Velocity { setpoint, .. } = axis.step(true).demand else { panic!("{:?}", axis.last) };
    assert!(setpoint.v == 0.0 && setpoint.a == 0.0, "{setpoint:?}");
}

/// A mode begins with the set-points of the loops: those of the step before, extrapolated by a period.
#[test]
fn every_change_of_mode_is_without_a_jump() {
    for from in MODES {
        for to in MODES.into_iter().chain([Mode::Homing]).filter(|to| *to != from) {
            let mut axis = moving(&Params::default(), from);
            let (x, v) = (axis.position, axis.velocity);
            axis.frame.mode = to.code();
            axis.frame.target_position = axis.actuals().position + 250;
            let got = setpoint(&axis.step(true).demand);
            assert!((got.x - x).abs() < 1e-12 && (got.v - v).abs() < 1e-12, "{from:?} to {to:?}: {got:?} {x} {v}");
            assert_eq!(axis.actuals().mode, to.code());
        }
    }
}

/// Halted while it brakes without a set-point, and released before standstill: the velocity continues to fall, by at most 1 m/s².
#[test]
fn a_halt_that_is_over_before_the_axis_stands_leaves_no_jump() {
    let mut axis = moving(&Params::default(), Mode::CyclicSynchronousVelocity);
    axis.frame.mode = Mode::ProfilePosition.code();
    let mut last = axis.velocity;
    for k in 0..1000 {
        axis.frame.controlword = axis.frame.controlword.with(ControlBit::Halt, (200..400).contains(&k));
        let v = setpoint(&axis.step(k % 4 == 0).demand).v;
        assert!((0.0..=250e-6 + 1e-12).contains(&(last - v)), "step {k}: {last} {v}");
        last = v;
    }
    assert!(last == 0.0);
}

#[test]
fn a_torque_mode_begins_with_the_effort_that_the_motor_gives() {
    for mode in [Mode::ProfileTorque, Mode::CyclicSynchronousTorque] {
        let mut axis = moving(&Params::default(), Mode::CyclicSynchronousPosition);
        axis.measured.effort = 0.625;
        (axis.frame.mode, axis.frame.target_torque) = (mode.code(), 900);
        assert_eq!(axis.step(true).demand, Demand::Effort(0.625), "{mode:?}");
    }
}

#[test]
fn a_mode_that_the_drive_does_not_have_is_not_switched_to() {
    let mut axis = moving(&Params::default(), Mode::CyclicSynchronousVelocity);
    for code in [0, 2, 5, 11, -1, 127] {
        axis.frame.mode = code;
        axis.cycle();
        assert_eq!(axis.actuals().mode, 9, "{code}");
        assert!((axis.velocity - 0.2).abs() < 1e-12);
    }
}

#[test]
fn without_a_mode_an_enabled_axis_is_held() {
    let mut axis = Axis::new(&Params::default());
    axis.position = 0.01;
    for command in [Command::DisableVoltage, Command::Shutdown, Command::SwitchOn, Command::EnableOperation] {
        axis.command(command);
        axis.cycle();
    }
    assert_eq!((axis.state.power(), axis.actuals().mode), (PowerState::OperationEnabled, 0));
    assert!((setpoint(&axis.last).x - 0.01).abs() < 1e-15);
}

/// Without a mode an axis that moves when it is enabled is braked to standstill, and stays there.
#[test]
fn without_a_mode_an_axis_that_moves_is_stopped() {
    let mut axis = Axis::new(&Params::default());
    axis.velocity = 0.0313;
    for command in [Command::DisableVoltage, Command::Shutdown, Command::SwitchOn, Command::EnableOperation] {
        axis.command(command);
        axis.cycle();
    }
    // 31.3 ms at 1 m/s².
    axis.cycles(40);
    for outputs in axis.cycle() {
        assert!(setpoint(&outputs.demand).v == 0.0, "{outputs:?}");
    }
}

/// Power that returns during the fault reaction: the axis is braked from its present state.
#[test]
fn power_that_comes_back_brakes_the_axis_from_where_it_is() {
    let mut axis = moving(&Params::default(), Mode::CyclicSynchronousPosition);
    axis.main_voltage = false;
    axis.cycles(10);
    assert_eq!((axis.last, axis.state.power()), (Demand::Off, PowerState::FaultReactionActive));
    axis.main_voltage = true;
    let (x, v) = (axis.position, axis.velocity);
    let got = setpoint(&axis.step(true).demand);
    // To an increment of 1 µm.
    assert!((got.x - x).abs() <= 0.5e-6 && (got.v - v).abs() < 1e-15 && v > 0.19, "{got:?} {x} {v}");
}

#[test]
fn a_quick_stop_that_stays_has_forgotten_the_move_when_it_is_over() {
    let mut params = Params::default();
    params.power.quick_stop = QuickStopOption::QuickStopRampAndStay;
    let mut axis = moving(&params, Mode::ProfilePosition);
    axis.command(Command::QuickStop);
    axis.cycles(100);
    let held = axis.position;
    axis.command(Command::EnableOperation);
    axis.cycles(100);
    assert_eq!(axis.state.power(), PowerState::OperationEnabled);
    assert!((axis.position - held).abs() < 1e-15 && held < 0.05, "{held} {}", axis.position);
}

/// Oracle: slopes, 1 m/s² on the ramp of the halt and 10 m/s² on that of the quick stop.
#[test]
fn a_harder_stop_takes_over_from_a_softer_one() {
    let mut axis = moving(&Params::default(), Mode::CyclicSynchronousPosition);
    axis.frame.controlword = axis.frame.controlword.with(ControlBit::Halt, true);
    axis.cycles(25);
    assert!((axis.velocity - 0.175).abs() < 1e-12, "{}", axis.velocity);
    axis.command(Command::QuickStop);
    axis.cycles(10);
    assert!((axis.velocity - 0.075).abs() < 1e-12, "{}", axis.velocity);
}

/// An axis that sticks is at standstill before its ramp ends: 0.2 m/s at 1 m/s² takes 0.2 s but for the last millisecond, at 1 mm/s.
#[test]
fn a_stop_is_not_over_before_its_ramp() {
    let mut params = Params::default();
    params.power.shutdown = ShutdownOption::SlowDownRamp;
    params.standstill.time = 0.0;
    let mut axis = moving(&params, Mode::CyclicSynchronousPosition);
    axis.command(Command::Shutdown);
    let steps = (0..2000).position(|k| {
        axis.velocity = 0.0;
        axis.step(k % 4 == 0).demand == Demand::Off
    });
    assert!((795..=801).contains(&steps.unwrap()), "{steps:?}");
}
