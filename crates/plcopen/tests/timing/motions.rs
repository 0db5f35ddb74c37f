//! Effects of the other motion blocks.
use crate::bench::{Bench, LIMITS};
use crate::calls::{at, running, to};
use servobench_fieldbus::{AxisFeedback, Fault, Homing, Task};
use servobench_plcopen::{
    AxisError, AxisParams, AxisState, BufferMode, ErrorId, FunctionBlock, Home, HomeInputs, MoveAbsolute,
    MoveAbsoluteInputs, MoveAdditive, MoveAdditiveInputs, MoveContinuousAbsolute, MoveContinuousAbsoluteInputs,
    MoveRelative, MoveRelativeInputs, MoveVelocity, Power, PowerInputs, ReadActualPosition, ReadAxisError, ReadInputs,
    ReadStatus, SetOverride, SetOverrideInputs, SetPosition, SetPositionInputs, TorqueControl, TorqueControlInputs,
};

#[test]
fn a_relative_move_counts_from_where_it_begins() {
    let mut bench = Bench::standstill();
    let (mut go, mut further) = (MoveAbsolute::default(), MoveRelative::default());
    bench.cycle(|axis| go.step(axis, &to(0.5)));
    for _ in 0..300 {
        bench.cycle(|_| ());
    }
    let begun = bench.axis.commanded().x;
    // The cycle of the call is the next one.
    let inputs = MoveRelativeInputs { execute: true, distance: 0.25, ..MoveRelativeInputs::within(&LIMITS) };
    bench.cycle(|axis| further.step(axis, &inputs));
    let called = bench.axis.commanded().x;
    assert!(called > begun);
    bench.until(AxisState::Standstill);
    at(&bench, called + 0.25);
}

#[test]
fn an_additive_move_counts_from_the_last_target() {
    let mut bench = Bench::standstill();
    let (mut go, mut further) = (MoveAbsolute::default(), MoveAdditive::default());
    bench.cycle(|axis| go.step(axis, &to(0.5)));
    for _ in 0..300 {
        bench.cycle(|_| ());
    }
    let inputs = MoveAdditiveInputs { execute: true, distance: 0.25, ..MoveAdditiveInputs::within(&LIMITS) };
    bench.cycle(|axis| further.step(axis, &inputs));
    bench.until(AxisState::Standstill);
    at(&bench, 0.75);
}

#[test]
fn a_continuous_move_keeps_its_end_velocity() {
    let mut bench = Bench::standstill();
    let mut go = MoveContinuousAbsolute::default();
    let inputs = MoveContinuousAbsoluteInputs {
        execute: true,
        position: 0.5,
        end_velocity: -0.2,
        ..MoveContinuousAbsoluteInputs::within(&LIMITS)
    };
    let mut first = None;
    for cycle in 0..3000 {
        let outputs = bench.cycle(|axis| go.step(axis, &inputs));
        if outputs.in_end_velocity && first.is_none() {
            first = Some((cycle, bench.axis.commanded().x));
        }
    }
    let (_, x) = first.unwrap();
    // In the first cycle after the passage: 0.2 m/s for 1 ms at most.
    assert!(x <= 0.5 && x > 0.5 - 0.2e-3 - 1e-12, "{x}");
    assert_eq!(bench.axis.commanded().v.to_bits(), (-0.2_f64).to_bits());
    assert_eq!(bench.axis.state(), AxisState::ContinuousMotion);
}

#[test]
fn a_position_that_was_passed_is_not_gone_back_to() {
    let mut bench = Bench::standstill();
    let (mut go, mut slow) = (MoveContinuousAbsolute::default(), SetOverride::default());
    for cycle in 0..3000 {
        let velocity = if cycle < 2500 { 0.4 } else { 0.5 };
        let inputs = MoveContinuousAbsoluteInputs {
            execute: true,
            continuous_update: true,
            position: 0.5,
            end_velocity: 0.2,
            velocity,
            ..MoveContinuousAbsoluteInputs::within(&LIMITS)
        };
        let vel_factor = if cycle < 2000 { 1.0 } else { 0.5 };
        bench.cycle(|axis| {
            slow.step(axis, &SetOverrideInputs { enable: true, vel_factor, ..SetOverrideInputs::default() });
            go.step(axis, &inputs);
        });
        assert!(bench.axis.commanded().v >= 0.0, "cycle {cycle}");
    }
    assert!((bench.axis.commanded().v - 0.1).abs() < 1e-12);
}

#[test]
fn an_additive_move_that_is_updated_goes_on_counting_from_the_last_target() {
    let mut bench = Bench::standstill();
    let (mut go, mut further) = (MoveAbsolute::default(), MoveAdditive::default());
    for _ in 0..300 {
        bench.cycle(|axis| go.step(axis, &to(0.5)));
    }
    for cycle in 0..3000 {
        let distance = if cycle < 300 { 0.25 } else { 0.5 };
        let inputs = MoveAdditiveInputs {
            execute: true,
            continuous_update: true,
            distance,
            ..MoveAdditiveInputs::within(&LIMITS)
        };
        bench.cycle(|axis| further.step(axis, &inputs));
    }
    at(&bench, 1.0);
}

/// A buffered command is checked again when its turn comes.
#[test]
fn a_command_that_is_not_permitted_any_more_when_its_turn_comes_halts_the_axis() {
    let mut bench = Bench::standstill();
    let (mut go, mut back) = (MoveVelocity::default(), MoveAbsolute::default());
    let returning = MoveAbsoluteInputs { buffer_mode: BufferMode::Buffered, ..to(-1.0) };
    let mut refused = false;
    for cycle in 0..1000 {
        bench.permits_negative = cycle < 10;
        let outputs = bench.cycle(|axis| {
            go.step(axis, &running(0.8));
            back.step(axis, &returning)
        });
        refused |= outputs.error_id == ErrorId::NotPermitted;
    }
    assert!(refused);
    assert_eq!(bench.axis.state(), AxisState::Standstill);
    assert_eq!(bench.axis.commanded().v.to_bits(), 0.0_f64.to_bits());
}

/// The same with a third command buffered, which takes its place.
#[test]
fn the_next_command_takes_the_place_of_one_that_is_not_permitted_any_more() {
    for buffer_mode in [BufferMode::Buffered, BufferMode::BlendingPrevious] {
        let mut bench = Bench::standstill();
        let (mut go, mut back, mut on) = (MoveAbsolute::default(), MoveAbsolute::default(), MoveAbsolute::default());
        let returning = MoveAbsoluteInputs { buffer_mode: BufferMode::Buffered, ..to(-1.0) };
        let further = MoveAbsoluteInputs { buffer_mode, ..to(0.75) };
        for cycle in 0..5000 {
            bench.permits_negative = cycle < 10;
            let (first, refused, outputs) =
                bench.cycle(|axis| (go.step(axis, &to(0.25)), back.step(axis, &returning), on.step(axis, &further)));
            let expected = if first.done { ErrorId::NotPermitted } else { ErrorId::None };
            assert_eq!((refused.error_id, refused.command_aborted), (expected, false), "{cycle}");
            assert_eq!(outputs.active || outputs.done, first.done, "{cycle}");
            if outputs.done {
                break;
            }
        }
        assert_eq!(bench.axis.state(), AxisState::Standstill);
        at(&bench, 0.75);
    }
}

#[test]
fn an_effort_rises_on_its_ramp_and_a_move_takes_over_from_the_actual_state() {
    let mut bench = Bench::standstill();
    let (mut press, mut back) = (TorqueControl::default(), MoveAbsolute::default());
    let inputs = TorqueControlInputs {
        execute: true,
        torque: -2.0,
        torque_ramp: 10.0,
        velocity: 0.5,
        ..TorqueControlInputs::within(&LIMITS)
    };
    let mut reached = None;
    for cycle in 0..400 {
        (bench.feedback.position, bench.feedback.velocity) = (0.1 * f64::from(cycle) * 1e-3, 0.1);
        let outputs = bench.cycle(|axis| press.step(axis, &inputs));
        assert!(matches!(bench.command.unwrap().task, Task::Effort(_)));
        reached = reached.or(outputs.in_torque.then_some(cycle));
    }
    assert_eq!(reached, Some(200), "2 N·m at 10 N·m/s, a step per cycle after the first");
    bench.cycle(|axis| back.step(axis, &to(0.0)));
    let Some(Task::Follow(sample)) = bench.command.map(|command| command.task) else { panic!("no set-point") };
    assert!((sample.x - 0.0399).abs() < 1e-12 && (sample.v - 0.1).abs() < 1e-12, "{sample:?}");
    bench.until(AxisState::Standstill);
    at(&bench, 0.0);
}

#[test]
fn an_effort_that_runs_away_is_an_error_of_the_axis() {
    let mut bench = Bench::standstill();
    let (mut press, mut read) = (TorqueControl::default(), ReadAxisError);
    let inputs =
        TorqueControlInputs { execute: true, torque: 1.0, velocity: 0.5, ..TorqueControlInputs::within(&LIMITS) };
    bench.cycle(|axis| press.step(axis, &inputs));
    bench.feedback.velocity = 0.6;
    let outputs = bench.cycle(|axis| press.step(axis, &inputs));
    assert_eq!(outputs.error_id, ErrorId::Overspeed);
    assert_eq!(bench.axis.error(), Some(&AxisError::Overspeed { velocity: 0.6, limit: 0.5 }));
    assert_eq!(bench.cycle(|axis| read.step(axis, &ReadInputs { enable: true })).axis_error_id, ErrorId::Overspeed);
    assert!(bench.axis.commanded().v > 0.0 && bench.axis.commanded().v < 0.6, "it brakes from its actual velocity");
}

#[test]
fn homing_gives_the_reference_that_absolute_moves_need() {
    let mut bench = Bench::powered(AxisParams { needs_homing: true, ..Bench::params() });
    let (mut go, mut home) = (MoveAbsolute::default(), Home::default());
    assert_eq!(bench.cycle(|axis| go.step(axis, &to(0.5))).error_id, ErrorId::NotHomed);
    assert_eq!(
        go.error().unwrap().to_string(),
        "MC_MoveAbsolute: `Position` 0.5 has no meaning on an axis without a reference: execute MC_Home first"
    );
    let homing = HomeInputs { execute: true, position: 2.0, ..HomeInputs::default() };
    bench.feedback.homing = Homing::Attained;
    for _ in 0..10 {
        assert!(bench.cycle(|axis| home.step(axis, &homing)).active);
    }
    bench.homing = Homing::Attained;
    bench.cycle(|axis| home.step(axis, &homing));
    assert!(bench.cycle(|axis| home.step(axis, &homing)).done);
    at(&bench, 2.0);
    bench.cycle(|axis| go.step(axis, &MoveAbsoluteInputs { execute: false, ..to(0.5) }));
    assert!(bench.cycle(|axis| go.step(axis, &to(0.5))).active);
}

#[test]
fn a_shifted_position_moves_nothing() {
    let mut bench = Bench::standstill();
    let (mut go, mut set, mut back) = (MoveAbsolute::default(), SetPosition::default(), MoveAbsolute::default());
    bench.cycle(|axis| go.step(axis, &to(0.5)));
    for _ in 0..400 {
        bench.cycle(|_| ());
    }
    let inputs = SetPositionInputs { execute: true, position: 10.0, relative: true };
    let before = bench.axis.commanded();
    assert!(bench.cycle(|axis| set.step(axis, &inputs)).done);
    assert!((bench.axis.commanded().x - before.x - 10.0).abs() < 1.1e-3, "the shift, and what it moves in a cycle");
    bench.until(AxisState::Standstill);
    at(&bench, 10.5);
    assert_eq!(
        bench.cycle(|axis| ReadActualPosition.step(axis, &ReadInputs { enable: true })).value.to_bits(),
        10.5_f64.to_bits()
    );
    bench.cycle(|axis| back.step(axis, &to(10.0)));
    bench.until(AxisState::Standstill);
    let Some(Task::Follow(sample)) = bench.command.map(|command| command.task) else { panic!("no set-point") };
    assert_eq!(sample.x.to_bits(), 0.0_f64.to_bits());
}

/// Section 3.17 of the standard: actual and commanded position by the same value, so that the following error stays.
#[test]
fn a_position_that_is_set_leaves_the_following_error_as_it_is() {
    let mut bench = Bench::standstill();
    let (mut go, mut set) = (MoveAbsolute::default(), SetPosition::default());
    for _ in 0..400 {
        bench.cycle(|axis| go.step(axis, &to(0.5)));
    }
    // The drive is 0.01 m behind the set-point of this cycle.
    bench.axis.begin(&bench.feedback);
    let lagging = AxisFeedback { position: bench.axis.commanded().x - 0.01, ..bench.feedback };
    bench.axis.begin(&lagging);
    let error = bench.axis.commanded().x - lagging.position;
    set.step(&mut bench.axis, &SetPositionInputs { execute: true, position: 7.0, relative: false });
    assert_eq!(bench.axis.actual().position.to_bits(), 7.0_f64.to_bits());
    assert!((bench.axis.commanded().x - 7.0 - error).abs() < 1e-14);
}

/// MC_SetPosition moves nothing, so it is permitted in every state in which the drive is not about to set the position.
#[test]
fn a_position_is_set_in_any_state_but_homing() {
    for (fault, state) in [(None, AxisState::Standstill), (Some(Fault::Drive(0x7305)), AxisState::ErrorStop)] {
        let (mut bench, mut set) = (Bench::standstill(), SetPosition::default());
        bench.feedback.fault = fault;
        let inputs = SetPositionInputs { execute: true, position: 3.0, relative: false };
        assert!(bench.cycle(|axis| set.step(axis, &inputs)).done);
        assert_eq!((bench.axis.state(), bench.axis.actual().position.to_bits()), (state, 3.0_f64.to_bits()));
    }
    let (mut bench, mut home, mut set) = (Bench::standstill(), Home::default(), SetPosition::default());
    let inputs = SetPositionInputs { execute: true, position: 3.0, relative: false };
    let homing = HomeInputs { execute: true, ..HomeInputs::default() };
    let (_, outputs) = bench.cycle(|axis| (home.step(axis, &homing), set.step(axis, &inputs)));
    assert_eq!(outputs.error_id, ErrorId::State);
}

#[test]
fn a_direction_that_is_not_permitted_is_refused_and_stopped_in() {
    let mut bench = Bench::standstill();
    let (mut back, mut forth) = (MoveAbsolute::default(), MoveAbsolute::default());
    let permitted = |enable_positive| PowerInputs { enable: true, enable_positive, enable_negative: false };
    let cycle = |bench: &mut Bench, positive, block: &mut MoveAbsolute, position| {
        bench.cycle(|axis| {
            Power.step(axis, &permitted(positive));
            block.step(axis, &to(position))
        })
    };
    assert_eq!(cycle(&mut bench, true, &mut back, -0.5).error_id, ErrorId::NotPermitted);
    assert_eq!(
        back.error().unwrap().to_string(),
        "MC_MoveAbsolute: leads in a direction that MC_Power does not permit: set `EnableNegative` of MC_Power"
    );
    for _ in 0..300 {
        assert!(cycle(&mut bench, true, &mut forth, 0.5).active);
    }
    cycle(&mut bench, false, &mut forth, 0.5);
    // MC_Power of the bench permits both before the block of the program takes it back: the watch looks at the next begin.
    bench.axis.begin(&bench.feedback);
    assert_eq!(bench.axis.state(), AxisState::ErrorStop);
    assert!(matches!(bench.axis.error(), Some(AxisError::PermissionLost { input: "EnablePositive", .. })));
}

#[test]
fn the_state_is_one_output() {
    let mut bench = Bench::standstill();
    let outputs = bench.cycle(|axis| ReadStatus.step(axis, &ReadInputs { enable: true }));
    assert_eq!((outputs.valid, outputs.state), (true, Some(AxisState::Standstill)));
    let outputs = bench.cycle(|axis| ReadStatus.step(axis, &ReadInputs::default()));
    assert_eq!((outputs.valid, outputs.state), (false, None));
}
