//! Bits 12 and 13 of the statusword while the axis is halted: their meaning depends on the mode, not on the halt.
use crate::axis::Axis;
use servobench_cia402::{Command, ControlBit, HaltOption, Mode, StatusBit};
use servobench_drive::Demand;
use servobench_drive::device::{Params, Window};
use servobench_drive::modes::homing::Method;

/// One frame per step, so that bits are seen at every step.
fn params() -> Params {
    let mut params = Params::default();
    params.cycle.steps = 1;
    params
}

impl Axis {
    fn with(&mut self, bit: ControlBit, set: bool) -> [bool; 2] {
        self.frame.controlword = self.frame.controlword.with(bit, set);
        self.step(true);
        self.bits()
    }

    /// Bits 12 and 13.
    fn bits(&self) -> [bool; 2] {
        [self.has(StatusBit::ModeSpecific12), self.has(StatusBit::ModeSpecific13)]
    }
}

/// IEC 61800-7-201, set-point handshake: the drive clears the acknowledgement after the master has cleared bit 4.
#[test]
fn a_set_point_stays_acknowledged_until_its_bit_is_cleared() {
    let mut axis = Axis::enabled(&params(), Mode::ProfilePosition);
    axis.frame.target_position = 10_000;
    assert_eq!(axis.with(ControlBit::ModeSpecific4, true), [true, false]);
    for _ in 0..50 {
        assert_eq!(axis.with(ControlBit::Halt, true), [true, false]);
    }
    assert_eq!(axis.with(ControlBit::ModeSpecific4, false), [false, false]);
    // The next one waits for the end of the halt, and is the target then.
    axis.frame.target_position = -2_000;
    axis.frame.controlword = axis.frame.controlword.with(ControlBit::ModeSpecific5, true);
    for _ in 0..50 {
        assert_eq!(axis.with(ControlBit::ModeSpecific4, true), [false, false]);
    }
    assert_eq!(axis.with(ControlBit::Halt, false), [true, false]);
    axis.cycles(10_000);
    assert!((axis.position + 2e-3).abs() < 1e-12, "{}", axis.position);
}

#[test]
fn a_set_point_that_waits_stays_acknowledged() {
    let mut axis = Axis::enabled(&params(), Mode::ProfilePosition);
    for target in [10_000, 20_000] {
        axis.frame.target_position = target;
        assert_eq!(axis.with(ControlBit::ModeSpecific4, false), [false, false]);
        assert_eq!(axis.with(ControlBit::ModeSpecific4, true), [true, false]);
    }
    axis.with(ControlBit::Halt, true);
    assert_eq!(axis.with(ControlBit::ModeSpecific4, false), [true, false], "no room for another one");
}

/// Oracle: by hand. From 0.1 m/s by 1 m/s² the axis is within the 20 mm/s of its threshold after 80 ms.
#[test]
fn an_axis_that_is_halted_in_profile_velocity_tells_whether_it_stands() {
    let mut params = Params { standstill: Window { width: 0.02, time: 0.0 }, ..params() };
    params.power.halt = HaltOption::SlowDownRamp;
    let mut axis = Axis::enabled(&params, Mode::ProfileVelocity);
    (axis.frame.profile_acceleration, axis.frame.profile_deceleration) = (1_000_000, 1_000_000);
    axis.frame.target_velocity = 100_000;
    axis.cycles(1000);
    assert_eq!(axis.bits(), [false, false], "it moves");
    let stands = (0..1000).position(|_| axis.with(ControlBit::Halt, true)[0]).unwrap();
    assert!((319..=322).contains(&stands), "{stands} steps of 0.25 ms");
    axis.cycles(1000);
    assert_eq!(axis.bits(), [true, false]);
}

/// The time of the threshold (6070h) does not begin anew when a halt is over before the axis stands.
#[test]
fn an_axis_that_never_stood_is_not_said_to_stand() {
    let params = Params { standstill: Window { width: 0.02, time: 0.01 }, ..params() };
    let mut axis = Axis::enabled(&params, Mode::ProfileVelocity);
    axis.frame.target_velocity = 100_000;
    axis.cycles(4000);
    for k in 0..100 {
        assert_eq!(axis.with(ControlBit::Halt, k < 20), [false, false], "step {k}");
    }
}

#[test]
fn a_homed_axis_stays_homed_and_a_failed_search_failed() {
    for (method, is_homed) in [(35, true), (33, false)] {
        let mut params = params();
        params.homing.method = Method::from_number(method).unwrap();
        let mut axis = Axis::enabled(&params, Mode::Homing);
        // A limit switch without an index pulse before it, when the method searches for one.
        axis.measured.negative_limit = !is_homed;
        axis.with(ControlBit::ModeSpecific4, true);
        axis.cycles(1000);
        assert_eq!(axis.bits(), [is_homed, !is_homed], "method {method}");
        for _ in 0..100 {
            assert_eq!(axis.with(ControlBit::Halt, true), [is_homed, !is_homed], "method {method}, halted");
        }
        assert_eq!(axis.with(ControlBit::Halt, false), [is_homed, !is_homed], "method {method}, afterwards");
    }
}

#[test]
fn a_halted_drive_does_not_follow_the_master() {
    use Mode::{CyclicSynchronousPosition, CyclicSynchronousTorque, CyclicSynchronousVelocity};
    for mode in [CyclicSynchronousPosition, CyclicSynchronousVelocity, CyclicSynchronousTorque] {
        let mut axis = Axis::enabled(&params(), mode);
        for is_halted in [false, true, true, false] {
            assert_eq!(axis.with(ControlBit::Halt, is_halted), [!is_halted, false], "{mode:?}");
        }
    }
}

/// The master's feedforward fades with the velocity of the ramp. Oracle: by hand, 0.2 m/s by 10 m/s² of the quick stop.
#[test]
fn what_was_fed_forward_goes_with_the_velocity() {
    let mut axis = Axis::enabled(&Params::default(), Mode::CyclicSynchronousPosition);
    for n in 1..=20 {
        axis.frame.target_position = 200 * n;
        (axis.frame.velocity_offset, axis.frame.torque_offset) = (200_000, 100);
        axis.cycle();
    }
    axis.command(Command::QuickStop);
    let outputs: Vec<_> = (0..30).flat_map(|_| axis.cycle()).collect();
    for (k, outputs) in outputs.iter().enumerate() {
        let Demand::Position { setpoint, velocity_offset, effort_offset } = outputs.demand else {
            assert!(k > 80, "step {k}: {:?}", outputs.demand);
            continue;
        };
        let left = (0.2 - 10.0 * k as f64 * axis.params.period).max(0.0);
        assert!((setpoint.v - left).abs() < 1e-12 && (velocity_offset - left).abs() < 1e-12, "step {k}: {setpoint:?}");
        assert!((effort_offset - 0.1 * left / 0.2).abs() < 1e-12, "step {k}: {effort_offset}");
    }
}
