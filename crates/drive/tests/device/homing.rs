//! Homing through the drive: the zero of the axis moves, the axis does not.
use crate::axis::{Axis, setpoint};
use servobench_cia402::{ControlBit, Mode, StatusBit};
use servobench_drive::device::Params;

/// Oracle: by hand. Method 35 takes the present position as the reference, which gets the home offset.
#[test]
fn the_reference_gets_the_home_offset_and_the_loops_see_no_jump() {
    let mut axis = Axis::new(&Params::default());
    axis.position = 0.0321;
    axis.enable(Mode::Homing);
    assert_eq!(axis.actuals().position, 32_100);
    axis.frame.home_offset = 5_000;
    axis.frame.controlword = axis.frame.controlword.with(ControlBit::ModeSpecific4, true);
    for _ in 0..10 {
        for outputs in axis.cycle() {
            assert!((setpoint(&outputs.demand).x - 0.0321).abs() < 1e-15, "{outputs:?}");
        }
    }
    assert!(axis.has(StatusBit::ModeSpecific12) && axis.has(StatusBit::TargetReached), "homed");
    assert_eq!(axis.actuals().position, 5_000);
    // From now on targets count from there.
    axis.frame.mode = Mode::CyclicSynchronousPosition.code();
    axis.frame.target_position = 5_200;
    axis.cycle();
    assert!((axis.position - 0.0323).abs() < 1e-15, "{}", axis.position);
    axis.cycle();
    assert_eq!(axis.actuals().position, 5_200);
}

/// Oracle: the drawing of method 33: towards the negative side to the next index pulse, at the speed for zero.
#[test]
fn an_index_pulse_is_the_zero_where_it_came() {
    let mut params = Params::default();
    params.homing.method = servobench_drive::modes::homing::Method::from_number(33).unwrap();
    let mut axis = Axis::new(&params);
    axis.position = 1.5e-3;
    axis.enable(Mode::Homing);
    axis.frame.controlword = axis.frame.controlword.with(ControlBit::ModeSpecific4, true);
    let pulse = 1.234e-3;
    for k in 0..4000 {
        let before = axis.position;
        axis.step(k % 4 == 0);
        axis.measured.index = (axis.position <= pulse && pulse < before).then(|| params.units.increments(pulse));
    }
    assert!(axis.has(StatusBit::ModeSpecific12) && axis.has(StatusBit::TargetReached), "homed");
    // The axis has braked behind the pulse by 5 mm/s: 12.5 µm at 1 m/s².
    let (shown, behind) = (axis.actuals().position, (axis.position - pulse) * 1e6);
    assert!((f64::from(shown) - behind).abs() <= 0.5 && (-16.0..-12.0).contains(&behind), "{shown} {behind}");
}

/// The switch turns on while the axis brakes for the halt: the search begins anew, on the switch.
#[test]
fn a_switch_that_is_passed_during_a_halt_is_found_all_the_same() {
    let mut params = Params::default();
    params.homing.method = servobench_drive::modes::homing::Method::from_number(19).unwrap();
    params.homing.switch_speed = 0.1;
    params.profile.deceleration = 1.0;
    let mut axis = Axis::new(&params);
    axis.enable(Mode::Homing);
    let run = axis.frame.controlword.with(ControlBit::ModeSpecific4, true);
    // 0.1 m/s brakes within 5 mm: from 18 mm to 23 mm.
    let edge = 0.02;
    let mut is_halted = false;
    for k in 0..40_000 {
        is_halted |= axis.position > 0.018;
        axis.frame.controlword = run.with(ControlBit::Halt, is_halted && k < 4000);
        axis.measured.home = axis.position >= edge;
        axis.step(k % 4 == 0);
        if axis.has(StatusBit::ModeSpecific12) && axis.has(StatusBit::TargetReached) {
            break;
        }
    }
    assert!(axis.has(StatusBit::ModeSpecific12) && !axis.has(StatusBit::ModeSpecific13));
    // A period at the speed for zero late, and rounded to a unit of the bus.
    let late = params.homing.zero_speed * params.period * 1e6 + 1.0;
    let shown = f64::from(axis.actuals().position);
    assert!((shown - (axis.position - edge) * 1e6).abs() <= late, "{shown} at {}", axis.position);
}
