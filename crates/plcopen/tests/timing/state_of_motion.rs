//! `MC_ReadMotionState` and `MC_ReadAxisInfo`.
use crate::bench::{Bench, LIMITS};
use crate::calls::{running, to};
use servobench_fieldbus::{Fault, LinkFault, Switches};
use servobench_plcopen::{
    FunctionBlock, MoveAbsolute, MoveVelocity, ReadAxisInfo, ReadInputs, ReadMotionState, TorqueControl,
    TorqueControlInputs,
};

const ENABLE: ReadInputs = ReadInputs { enable: true };

/// A move of order 4 speeds up, cruises and slows down, each once.
#[test]
fn a_move_speeds_up_cruises_and_slows_down() {
    for (distance, is_positive) in [(1.03, true), (-0.97, false)] {
        let (mut bench, mut go, mut read) = (Bench::standstill(), MoveAbsolute::default(), ReadMotionState::default());
        let mut phases: Vec<&str> = Vec::new();
        for _ in 0..3000 {
            let (set, outputs) = bench.cycle(|axis| {
                go.step(axis, &to(distance));
                (axis.commanded(), read.step(axis, &ENABLE))
            });
            let flags = [outputs.constant_velocity, outputs.accelerating, outputs.decelerating];
            assert_eq!(flags.into_iter().filter(|flag| *flag).count(), 1, "{outputs:?}");
            assert_eq!(outputs.direction_positive, is_positive && set.v.abs() > 1e-6, "{set:?}");
            assert_eq!(outputs.direction_negative, !is_positive && set.v.abs() > 1e-6, "{set:?}");
            let phase = match flags {
                [true, ..] if set.v.abs() > 0.5 => "cruises",
                [true, ..] => "rests",
                [_, true, _] => "speeds up",
                _ => "slows down",
            };
            if phases.last() != Some(&phase) {
                phases.push(phase);
            }
        }
        assert_eq!(phases, ["rests", "speeds up", "cruises", "slows down", "rests"]);
    }
}

/// At a reversal it slows down to the turning point and speeds up after it.
#[test]
fn a_reversal_slows_down_first() {
    let (mut bench, mut run, mut back, mut read) =
        (Bench::standstill(), MoveVelocity::default(), MoveVelocity::default(), ReadMotionState::default());
    let mut seen = Vec::new();
    for cycle in 0..2000 {
        let (v, outputs) = bench.cycle(|axis| {
            run.step(axis, &running(0.4));
            if cycle > 800 {
                back.step(axis, &running(-0.4));
            }
            (axis.commanded().v, read.step(axis, &ENABLE))
        });
        if outputs.decelerating {
            assert!(v > 0.0, "{v}");
            seen.push(cycle);
        }
        assert!(!(outputs.accelerating && v > 0.0 && cycle > 820), "{cycle}");
    }
    assert!(seen.len() > 50);
}

/// Under torque control there is no set-point to follow: the actual velocity counts.
#[test]
fn by_a_torque_the_actual_velocity_counts() {
    let (mut bench, mut torque, mut read) = (Bench::standstill(), TorqueControl::default(), ReadMotionState::default());
    let inputs = TorqueControlInputs { execute: true, torque: 0.2, ..TorqueControlInputs::within(&LIMITS) };
    for (velocity, expected) in [
        (0.0, [true, false, false]),
        (0.1, [false, true, false]),
        (0.1, [true, false, false]),
        (0.05, [false, false, true]),
    ] {
        bench.feedback.velocity = velocity;
        let outputs = bench.cycle(|axis| {
            torque.step(axis, &inputs);
            read.step(axis, &ENABLE)
        });
        let flags = [outputs.constant_velocity, outputs.accelerating, outputs.decelerating];
        assert_eq!(flags, expected, "{velocity}");
    }
}

#[test]
fn an_axis_says_what_is_with_it() {
    let mut bench = Bench::standstill();
    bench.feedback.switches = Switches { negative_limit: false, home: true, positive_limit: true };
    bench.feedback.has_warning = true;
    let info = bench.cycle(|axis| ReadAxisInfo.step(axis, &ENABLE));
    assert!(info.valid && info.home_abs_switch && info.limit_switch_pos && !info.limit_switch_neg && info.axis_warning);
    assert!(info.communication_ready && info.ready_for_power_on && info.power_on && !info.is_homed && !info.simulation);
    bench.feedback.fault = Some(Fault::Link(LinkFault::DriveTimeout));
    let info = bench.cycle(|axis| ReadAxisInfo.step(axis, &ENABLE));
    assert!(!info.communication_ready && !info.ready_for_power_on);
    bench.feedback.fault = Some(Fault::Drive(0x7305));
    let info = bench.cycle(|axis| ReadAxisInfo.step(axis, &ENABLE));
    assert!(info.communication_ready && !info.ready_for_power_on);
    assert!(!bench.cycle(|axis| ReadAxisInfo.step(axis, &ReadInputs { enable: false })).valid);
}
