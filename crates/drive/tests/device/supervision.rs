//! Faults: their codes, their delays and the reactions of the drive.
use crate::axis::{Axis, setpoint};
use servobench_cia402::{Command, ErrorCode, FaultReactionOption, Mode, PowerState, Source, StatusBit};
use servobench_drive::Demand;
use servobench_drive::device::{Fault, Measured, Params, Window};
use servobench_drive::supervision::Finding;

fn running(params: &Params) -> Axis {
    let mut axis = Axis::enabled(params, Mode::CyclicSynchronousPosition);
    for n in 1..=20 {
        axis.frame.target_position = 200 * n;
        axis.cycle();
    }
    axis
}

/// Every fault is reported by its code, brakes on the quick stop ramp if possible, ends in Fault and is gone after a reset.
#[test]
fn every_fault_has_its_code_and_its_reaction() {
    let following_error = Window { width: 1e-3, time: 0.0 };
    let params = Params { following_error, ..Params::default() };
    for (fault, code) in [
        (Fault::External(0x9000), 0x9000),
        (Fault::MainsMissing, 0x3220),
        (Fault::Overload, 0x2350),
        (Fault::Encoder, 0x7305),
        (Fault::LoadEncoder, 0x7306),
        (Fault::Supervision(Finding::OverVoltage), 0x3210),
        (Fault::Supervision(Finding::UnderVoltage), 0x3220),
        (Fault::Supervision(Finding::LostPhase), 0x3321),
        (Fault::Supervision(Finding::Stall), 0x7121),
        (Fault::Supervision(Finding::Commutation), 0x7122),
        (Fault::Supervision(Finding::OverSpeed), 0x7310),
        (Fault::FollowingError, 0x8611),
        (Fault::FramesMissing, 0x8700),
    ] {
        let mut axis = running(&params);
        let mut with_frames = true;
        match fault {
            Fault::External(code) => axis.fault = Some(code),
            Fault::MainsMissing => axis.main_voltage = false,
            Fault::Overload => axis.measured.is_overloaded = true,
            Fault::Encoder => axis.measured.effort = f64::NAN,
            Fault::LoadEncoder => axis.measured.load_encoder_error = true,
            Fault::Supervision(finding) => axis.measured.finding = Some(finding),
            Fault::FollowingError => axis.measured.following_error = -1.1e-3,
            Fault::FramesMissing => with_frames = false,
        }
        let raised = (0..20).find_map(|k| {
            let outputs = axis.step(with_frames && k % 4 == 0);
            outputs.fault.map(|fault| (fault, outputs))
        });
        let (found, outputs) = raised.unwrap();
        assert_eq!((found, outputs.transition.unwrap().number), (fault, 13));
        assert_eq!(
            (axis.actuals().error_code, axis.state.power()),
            (code, PowerState::FaultReactionActive),
            "{fault:?}"
        );
        let is_off = match fault {
            Fault::Supervision(finding) => finding.leaves_no_brake(),
            fault => matches!(fault, Fault::MainsMissing | Fault::Encoder),
        };
        if is_off {
            assert_eq!(outputs.demand, Demand::Off, "{fault:?}: nothing brakes");
            axis.velocity = 0.0;
        } else if fault == Fault::LoadEncoder {
            let Demand::Velocity { setpoint, .. } = outputs.demand else { panic!("{outputs:?}") };
            assert!((setpoint.v - 0.2).abs() < 1e-12 && (setpoint.a + 10.0).abs() < 1e-12, "{outputs:?}");
        } else {
            let (v, a) = (setpoint(&outputs.demand).v, setpoint(&outputs.demand).a);
            assert!((v - 0.2).abs() < 1e-12 && (a + 10.0).abs() < 1e-12, "{fault:?}: {outputs:?}");
        }
        axis.cycles(100);
        assert_eq!((axis.state.power(), axis.last), (PowerState::Fault, Demand::Off), "{fault:?}");
        // Some faults cannot be reset while their cause is present.
        axis.command(Command::DisableVoltage);
        axis.cycle();
        axis.command(Command::FaultReset);
        axis.cycle();
        let stays = matches!(fault, Fault::External(_) | Fault::Encoder | Fault::LoadEncoder);
        assert_eq!(axis.state.power() == PowerState::Fault, stays, "{fault:?}");
        (axis.fault, axis.main_voltage, axis.measured.effort) = (None, true, 0.0);
        axis.measured = Measured::default();
        axis.command(Command::DisableVoltage);
        axis.cycle();
        axis.command(Command::FaultReset);
        axis.cycle();
        assert_eq!((axis.state.power(), axis.actuals().error_code), (PowerState::SwitchOnDisabled, 0), "{fault:?}");
        axis.enable(Mode::CyclicSynchronousPosition);
        assert_eq!(axis.state.power(), PowerState::OperationEnabled, "{fault:?}");
    }
}

/// From the step at which the encoder fails, no loop gets a demand, for any option code, mode and order of faults: the power stage is
/// off, and Fault is reached at the next step, without waiting for a standstill that cannot be measured.
#[test]
fn without_an_encoder_no_loop_is_closed() {
    for option in FaultReactionOption::CODES {
        for mode in
            [Mode::CyclicSynchronousPosition, Mode::ProfileVelocity, Mode::CyclicSynchronousTorque, Mode::Homing]
        {
            for (other, order) in [(None, "alone"), (Some(0x9000), "with another"), (Some(0x9000), "after another")] {
                let mut params = Params::default();
                params.power.fault_reaction = FaultReactionOption::try_from(*option).unwrap();
                let mut axis = Axis::enabled(&params, mode);
                (axis.frame.target_velocity, axis.frame.target_torque) = (100_000, 100);
                axis.cycles(50);
                axis.velocity = 0.2;
                axis.fault = other;
                if order == "after another" {
                    axis.step(true);
                    assert_eq!(axis.state.power(), PowerState::FaultReactionActive);
                }
                let what = format!("605Eh = {option}, {mode:?}, {order}");
                let velocity = axis.velocity;
                axis.measured.effort = f64::NAN;
                for k in 0..400 {
                    assert_eq!(axis.step(k % 4 == 0).demand, Demand::Off, "{what}, step {k}");
                    if k > 0 {
                        assert_eq!(axis.state.power(), PowerState::Fault, "{what}, step {k}");
                    }
                    // One valid reading does not close the loops again.
                    axis.measured.effort = if k == 100 { 0.0 } else { f64::NAN };
                }
                assert!((axis.velocity - velocity).abs() < 1e-15, "{what}: it coasts");
                assert_eq!(axis.actuals().error_code, other.unwrap_or(0x7305), "{what}: the first fault is told");
            }
        }
    }
}

/// The table of `docs/objects.md`: it has the faults of the drive, and no others as the drive's.
#[test]
fn every_code_of_the_drive_has_its_fault() {
    let of_drive = |error: &&ErrorCode| matches!(error.source(), Source::Drive { .. });
    let mut listed: Vec<u16> = ErrorCode::ALL.iter().filter(of_drive).map(|error| error.code()).collect();
    let mut found = Fault::OWN.map(Fault::code).to_vec();
    listed.sort_unstable();
    found.sort_unstable();
    // Two have the code of under-voltage.
    found.dedup();
    assert_eq!(listed, found);
}

#[test]
fn the_fault_reaction_brakes_as_its_option_code_says() {
    for (option, deceleration) in [
        (FaultReactionOption::Disable, None),
        (FaultReactionOption::SlowDownRamp, Some(1.0)),
        (FaultReactionOption::QuickStopRamp, Some(10.0)),
    ] {
        let mut params = Params::default();
        params.power.fault_reaction = option;
        let mut axis = running(&params);
        axis.fault = Some(0x2310);
        let demand = axis.step(true).demand;
        match deceleration {
            None => assert_eq!(demand, Demand::Off),
            Some(deceleration) => assert!((setpoint(&demand).a + deceleration).abs() < 1e-12, "{demand:?}"),
        }
    }
}

/// Oracle: counted. Bit 13 and the fault come together when the error has been outside for the time-out (IEC 61800-7-201, 6066h).
#[test]
fn the_following_error_may_leave_its_window_for_the_time_out() {
    let params = Params { following_error: Window { width: 1e-3, time: 5e-3 }, ..Params::default() };
    let mut axis = running(&params);
    let mut outside = |steps: usize, error: f64| {
        axis.measured.following_error = error;
        (0..steps).position(|k| {
            axis.frame.target_position = 4000;
            let outputs = axis.step(k % 4 == 0);
            assert_eq!(axis.has(StatusBit::ModeSpecific13), outputs.fault.is_some());
            outputs.fault.is_some()
        })
    };
    assert_eq!(outside(20, 1.5e-3), None, "19 periods");
    assert_eq!(outside(4, 1e-3), None, "within");
    assert_eq!(outside(40, -1.5e-3), Some(20), "20 periods of 0.25 ms");
}

/// Bit 13 reports a lost position until the fault is reset, only that fault and only in the modes that give it this meaning.
#[test]
fn bit_13_tells_a_lost_position_until_the_reset() {
    use PowerState::{Fault as Faulty, FaultReactionActive, SwitchOnDisabled};
    let following_error = Window { width: 1e-3, time: 0.0 };
    let params = Params { following_error, ..Params::default() };
    for (mode, is_lost, told) in [
        (Mode::CyclicSynchronousPosition, true, true),
        (Mode::ProfilePosition, true, true),
        (Mode::Homing, true, false),
        (Mode::CyclicSynchronousPosition, false, false),
    ] {
        let mut axis = Axis::enabled(&params, mode);
        (axis.measured.following_error, axis.fault) = if is_lost { (2e-3, None) } else { (0.0, Some(0x9000)) };
        axis.step(true);
        let shown = |axis: &Axis| (axis.state.power(), axis.has(StatusBit::ModeSpecific13));
        assert_eq!(shown(&axis), (FaultReactionActive, told), "{mode:?}");
        (axis.measured.following_error, axis.fault) = (0.0, None);
        axis.cycles(100);
        assert_eq!(shown(&axis), (Faulty, told), "{mode:?}");
        axis.command(Command::DisableVoltage);
        axis.cycle();
        axis.command(Command::FaultReset);
        axis.cycle();
        assert_eq!(shown(&axis), (SwitchOnDisabled, false), "{mode:?}");
    }
}

#[test]
fn nothing_is_supervised_that_is_not_driven() {
    let params = Params { following_error: Window { width: 1e-3, time: 0.0 }, ..Params::default() };
    let mut axis = Axis::new(&params);
    axis.measured.following_error = 1.0;
    axis.main_voltage = false;
    axis.cycle();
    (0..40).for_each(|_| assert_eq!(axis.step(false).fault, None));
    let mut axis = Axis::enabled(&params, Mode::CyclicSynchronousVelocity);
    axis.measured.following_error = 1.0;
    assert!(axis.cycle().iter().all(|outputs| outputs.fault.is_none()), "there is no position loop");
}

#[test]
fn what_the_master_reads_is_in_drive_units() {
    let mut axis = running(&Params::default());
    (axis.measured.effort, axis.measured.following_error) = (-0.25, 123.4e-6);
    (axis.measured.home, axis.measured.negative_limit) = (true, true);
    axis.step(true);
    let actuals = axis.actuals();
    assert_eq!((actuals.position, actuals.velocity, actuals.torque), (4000, 200_000, -250));
    assert_eq!((actuals.following_error, actuals.digital_inputs), (123, 0b101));
}
