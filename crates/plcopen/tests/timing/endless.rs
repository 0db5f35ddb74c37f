//! Commands that keep the axis until another one takes it.
use crate::bench::{Bench, LIMITS};
use crate::calls::{at, running, to};
use servobench_base::Setpoint;
use servobench_plcopen::{
    AxisState, BufferMode, FunctionBlock, MoveAbsolute, MoveAbsoluteInputs, MoveContinuousAbsolute,
    MoveContinuousAbsoluteInputs, MoveContinuousRelative, MoveContinuousRelativeInputs, MoveSuperimposed,
    MoveSuperimposedInputs, MoveVelocity, MoveVelocityInputs, TorqueControl, TorqueControlInputs,
};

/// At EndVelocity 0 the axis stands at the position, in Continuous Motion, until another command takes it.
#[test]
fn a_continuous_move_may_end_at_rest() {
    for position in [0.25, -0.173] {
        let (mut bench, mut pass, mut go) =
            (Bench::standstill(), MoveContinuousAbsolute::default(), MoveAbsolute::default());
        let inputs =
            MoveContinuousAbsoluteInputs { execute: true, position, ..MoveContinuousAbsoluteInputs::within(&LIMITS) };
        let mut arrived = None;
        for cycle in 0..2500 {
            let execute = cycle >= 2000;
            let (passed, moved) = bench.cycle(|axis| {
                let passed = pass.step(axis, &inputs);
                (passed, go.step(axis, &MoveAbsoluteInputs { execute, ..to(0.1) }))
            });
            assert!(!passed.error && !moved.error);
            assert!(passed.busy != passed.command_aborted, "{cycle}");
            if passed.in_end_velocity && arrived.is_none() {
                at(&bench, position);
                arrived = Some(cycle);
            }
            assert_eq!(passed.in_end_velocity, arrived.is_some() && !passed.command_aborted, "{cycle}");
            assert_eq!(passed.command_aborted, execute && cycle >= 2000 && !passed.busy);
            if !execute {
                assert_eq!(bench.axis.state(), AxisState::ContinuousMotion);
            }
        }
        assert!(arrived.is_some_and(|cycle| cycle < 1500));
    }
}

/// A buffered command takes over the axis where it passes its position, at rest here, in any blending mode.
#[test]
fn a_continuous_move_to_rest_is_not_blended() {
    let (mut bench, mut pass, mut go) =
        (Bench::standstill(), MoveContinuousAbsolute::default(), MoveAbsolute::default());
    let inputs =
        MoveContinuousAbsoluteInputs { execute: true, position: 0.21, ..MoveContinuousAbsoluteInputs::within(&LIMITS) };
    let behind = MoveAbsoluteInputs { buffer_mode: BufferMode::BlendingHigh, ..to(0.43) };
    let mut aborted_at = None;
    for _ in 0..4000 {
        let passed = bench.cycle(|axis| {
            let passed = pass.step(axis, &inputs);
            go.step(axis, &behind);
            passed
        });
        if passed.command_aborted && aborted_at.is_none() {
            aborted_at = Some(bench.axis.commanded());
        }
    }
    let there = aborted_at.unwrap();
    assert!((there.x - 0.21).abs() < 1e-12 && there.v.abs() < 1e-9, "{there:?}");
    at(&bench, 0.43);
}

/// The outputs of a block do not depend on later commands of other blocks.
#[test]
fn a_block_that_runs_says_so_however_many_others_are_called() {
    let (mut bench, mut run) = (Bench::standstill(), MoveVelocity::default());
    let below = MoveVelocityInputs {
        acceleration: 2.0,
        deceleration: 2.0,
        jerk: Some(20.0),
        snap: Some(400.0),
        ..running(0.3)
    };
    let top = MoveSuperimposedInputs {
        velocity_diff: 0.2,
        acceleration: 2.0,
        deceleration: 2.0,
        ..MoveSuperimposedInputs::within(&LIMITS)
    };
    let top = MoveSuperimposedInputs { jerk: Some(20.0), snap: Some(400.0), distance: 0.01, ..top };
    let mut has_arrived = false;
    for cycle in 0..1500 {
        // A new instance in each cycle, each a command.
        let (outputs, on_top) = bench.cycle(|axis| {
            let on_top = MoveSuperimposed::default().step(axis, &MoveSuperimposedInputs { execute: cycle > 5, ..top });
            (run.step(axis, &below), on_top)
        });
        assert!(!on_top.error, "{cycle}: {on_top:?}");
        assert!(outputs.busy && outputs.active && !outputs.command_aborted, "{cycle}: {outputs:?}");
        has_arrived |= outputs.in_velocity;
        assert_eq!(outputs.in_velocity, has_arrived, "{cycle}");
    }
    assert!(has_arrived);
}

/// By a distance rather than to a position: the same motion, bit for bit.
#[test]
fn a_continuous_relative_move_counts_from_where_it_begins() {
    for (distance, end_velocity) in [(0.31, 0.2), (-0.27, 0.15), (0.18, 0.0)] {
        let (mut bench, mut other) = (Bench::standstill(), Bench::standstill());
        let (mut by, mut to_position) = (MoveContinuousRelative::default(), MoveContinuousAbsolute::default());
        let relative = MoveContinuousRelativeInputs {
            execute: true,
            distance,
            end_velocity,
            ..MoveContinuousRelativeInputs::within(&LIMITS)
        };
        let absolute = MoveContinuousAbsoluteInputs {
            execute: true,
            position: distance,
            end_velocity,
            ..MoveContinuousAbsoluteInputs::within(&LIMITS)
        };
        for cycle in 0..1500 {
            let one = bench.cycle(|axis| by.step(axis, &relative));
            let two = other.cycle(|axis| to_position.step(axis, &absolute));
            assert_eq!((one, bench.axis.commanded()), (two, other.axis.commanded()), "{cycle}");
            assert!(!one.error, "{:?}", by.error());
        }
        assert_eq!(bench.axis.state(), AxisState::ContinuousMotion);
        assert!((bench.axis.commanded().v - end_velocity).abs() < 1e-9);
    }
}

/// A distance after another move counts from the end of that move; so does a longer distance given while it runs.
#[test]
fn a_continuous_relative_move_may_wait_and_change() {
    let (mut bench, mut go, mut by) = (Bench::standstill(), MoveAbsolute::default(), MoveContinuousRelative::default());
    let inputs = MoveContinuousRelativeInputs {
        execute: true,
        distance: 0.2,
        end_velocity: 0.1,
        buffer_mode: BufferMode::Buffered,
        continuous_update: true,
        ..MoveContinuousRelativeInputs::within(&LIMITS)
    };
    let mut passed_at = None;
    for _ in 0..4000 {
        let is_running = bench.axis.commanded().x > 0.3;
        let inputs = MoveContinuousRelativeInputs { distance: if is_running { 0.35 } else { 0.2 }, ..inputs };
        let outputs = bench.cycle(|axis| {
            go.step(axis, &to(0.25));
            by.step(axis, &inputs)
        });
        assert!(!outputs.error, "{:?}", by.error());
        if outputs.in_end_velocity && passed_at.is_none() {
            passed_at = Some(bench.axis.commanded().x);
        }
    }
    // At most a cycle behind the position that is passed, 0.25 m + 0.35 m.
    let passed_at = passed_at.unwrap();
    assert!((0.0..=0.1 * 1e-3 + 1e-12).contains(&(passed_at - 0.6)), "{passed_at}");
}

/// InVelocity is TRUE while the set-point has the commanded velocity (section 2.4.1), a new one from the call that takes it.
#[test]
fn a_changed_velocity_is_not_reached_in_the_cycle_of_its_change() {
    let (mut bench, mut run) = (Bench::standstill(), MoveVelocity::default());
    let mut inputs = MoveVelocityInputs { continuous_update: true, ..running(0.3) };
    let mut step = |inputs: &MoveVelocityInputs| {
        let outputs = bench.cycle(|axis| run.step(axis, inputs));
        let Setpoint { v, a, .. } = bench.axis.commanded();
        let is_there = (v - inputs.velocity).abs() <= 0.0 && a == 0.0;
        assert_eq!((outputs.in_velocity, outputs.active), (is_there, true), "{inputs:?}");
        is_there
    };
    for velocity in [0.3, -0.2, 0.0, 0.4] {
        inputs.velocity = velocity;
        assert!(!step(&inputs), "{velocity}");
        assert!((0..1000).any(|_| step(&inputs)), "{velocity}");
        // Gentler on the way to a velocity that is reached already: nothing to do.
        inputs.acceleration *= 0.9;
        assert!(step(&inputs) && step(&inputs));
    }
}

/// The same of InTorque.
#[test]
fn a_changed_torque_is_not_reached_in_the_cycle_of_its_change() {
    let (mut bench, mut press) = (Bench::standstill(), TorqueControl::default());
    let inputs = TorqueControlInputs {
        execute: true,
        continuous_update: true,
        torque: 1.0,
        torque_ramp: 125.0,
        ..TorqueControlInputs::within(&LIMITS)
    };
    let mut cycles_until_there =
        |inputs: &TorqueControlInputs| (0..100).position(|_| bench.cycle(|axis| press.step(axis, inputs)).in_torque);
    assert_eq!(cycles_until_there(&inputs), Some(8), "an eighth of a newton metre in a cycle");
    let more = TorqueControlInputs { torque: 1.5, ..inputs };
    assert_eq!(cycles_until_there(&more), Some(4));
    let faster = TorqueControlInputs { torque_ramp: 250.0, ..more };
    assert_eq!(cycles_until_there(&faster), Some(0), "it is there already");
}
