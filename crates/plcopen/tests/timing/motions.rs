//! What each of the other motion blocks does.
use crate::bench::{Bench, LIMITS};
use servobench_fieldbus::{Homing, Task};
use servobench_plcopen::{
    AxisError, AxisParams, AxisState, BufferMode, Direction, ErrorId, FunctionBlock, Home, HomeInputs, MoveAbsolute,
    MoveAbsoluteInputs, MoveAdditive, MoveAdditiveInputs, MoveContinuousAbsolute, MoveContinuousAbsoluteInputs,
    MoveRelative, MoveRelativeInputs, MoveSuperimposed, MoveSuperimposedInputs, MoveVelocity, MoveVelocityInputs,
    Power, PowerInputs, ReadActualPosition, ReadAxisError, ReadInputs, ReadStatus, SetOverride, SetOverrideInputs,
    SetPosition, SetPositionInputs, TorqueControl, TorqueControlInputs,
};

fn to(position: f64) -> MoveAbsoluteInputs {
    MoveAbsoluteInputs { execute: true, position, ..MoveAbsoluteInputs::within(&LIMITS) }
}

fn running(velocity: f64) -> MoveVelocityInputs {
    MoveVelocityInputs { execute: true, velocity, ..MoveVelocityInputs::within(&LIMITS) }
}

fn at(bench: &Bench, x: f64) {
    assert_eq!(bench.axis.commanded().x.to_bits(), x.to_bits(), "{} {x}", bench.axis.commanded().x);
}

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
fn a_superimposed_move_adds_its_distance_and_leaves_the_other_alone() {
    let mut bench = Bench::standstill();
    let (mut go, mut on_top) = (MoveAbsolute::default(), MoveSuperimposed::default());
    let below = MoveAbsoluteInputs {
        velocity: 0.5,
        acceleration: 2.0,
        deceleration: 2.0,
        jerk: Some(20.0),
        snap: Some(500.0),
        ..to(1.0)
    };
    let top = MoveSuperimposedInputs {
        execute: true,
        distance: 0.125,
        velocity_diff: 0.25,
        acceleration: 2.0,
        deceleration: 2.0,
        jerk: Some(20.0),
        snap: Some(500.0),
        ..MoveSuperimposedInputs::within(&LIMITS)
    };
    let (mut below_done, mut top_done, mut highest) = (None, None, 0.0_f64);
    for cycle in 0..4000 {
        let (below, top) = bench.cycle(|axis| {
            let below = go.step(axis, &below);
            (below, on_top.step(axis, &MoveSuperimposedInputs { execute: cycle >= 500, ..top }))
        });
        assert!(!below.command_aborted && !below.error && !top.error);
        below_done = below_done.or(below.done.then_some(cycle));
        if top.done && top_done.is_none() {
            assert_eq!(top.covered_distance.to_bits(), 0.125_f64.to_bits());
            top_done = Some(cycle);
        }
        highest = highest.max(bench.axis.commanded().v);
    }
    at(&bench, 1.125);
    assert!((highest - 0.75).abs() < 1e-9, "{highest}");
    assert!(top_done < below_done);
    assert_eq!(bench.axis.state(), AxisState::Standstill);
}

#[test]
fn superimposed_moves_add_up_and_each_counts_for_itself() {
    let mut bench = Bench::standstill();
    let below = MoveVelocityInputs {
        acceleration: 2.0,
        deceleration: 2.0,
        jerk: Some(20.0),
        snap: Some(500.0),
        ..running(0.5)
    };
    let top = MoveSuperimposedInputs {
        execute: true,
        distance: 0.125,
        velocity_diff: 0.25,
        acceleration: 2.0,
        deceleration: 2.0,
        jerk: Some(20.0),
        snap: Some(500.0),
        ..MoveSuperimposedInputs::within(&LIMITS)
    };
    // The third replaces the second on its way: it counts from where that one has come to.
    let (mut go, mut alone) = (MoveVelocity::default(), Bench::standstill());
    let (mut reference, mut blocks) = (MoveVelocity::default(), [MoveSuperimposed::default(); 3]);
    let mut replaced = 0.0;
    for cycle in 0..4000 {
        alone.cycle(|axis| reference.step(axis, &below));
        let covered = bench.cycle(|axis| {
            go.step(axis, &below);
            let step = |(block, start): (&mut MoveSuperimposed, usize)| {
                block.step(axis, &MoveSuperimposedInputs { execute: cycle >= start, ..top })
            };
            let outputs: Vec<_> = blocks.iter_mut().zip([500, 1500, 1800]).map(step).collect();
            assert!(outputs.iter().all(|outputs| !outputs.error));
            [outputs[1].covered_distance, outputs[2].covered_distance]
        });
        if cycle == 1800 {
            replaced = covered[0];
            assert!(replaced > 0.01 && covered[1] == 0.0, "{covered:?}");
        }
    }
    let added = bench.axis.commanded().x - alone.axis.commanded().x;
    // The one that was replaced is asked at its call, a cycle after the set-point from which the third goes on.
    assert!((added - (0.25 + replaced)).abs() < 1e-12, "{added} {replaced}");
    assert!((bench.axis.commanded().v - 0.5).abs() < 1e-12);
}

#[test]
fn a_lower_acceleration_factor_is_for_braking_too() {
    let mut bench = Bench::standstill();
    let (mut go, mut slow) = (MoveAbsolute::default(), SetOverride::default());
    let mut last = 0.0;
    for _ in 0..4000 {
        bench.cycle(|axis| {
            slow.step(axis, &SetOverrideInputs { enable: true, acc_factor: 0.5, ..SetOverrideInputs::default() });
            go.step(axis, &to(1.0));
        });
        let v = bench.axis.commanded().v;
        assert!((v - last).abs() <= 0.5 * LIMITS.acceleration * 1e-3 * (1.0 + 1e-9));
        last = v;
    }
    at(&bench, 1.0);
}

#[test]
fn an_abort_takes_the_superimposed_move_along() {
    let mut bench = Bench::standstill();
    let (mut go, mut on_top, mut other) =
        (MoveVelocity::default(), MoveSuperimposed::default(), MoveAbsolute::default());
    let below = MoveVelocityInputs {
        acceleration: 2.0,
        deceleration: 2.0,
        jerk: Some(20.0),
        snap: Some(500.0),
        ..running(0.5)
    };
    let top = MoveSuperimposedInputs {
        execute: true,
        distance: 0.5,
        velocity_diff: 0.25,
        acceleration: 2.0,
        deceleration: 2.0,
        jerk: Some(20.0),
        snap: Some(500.0),
        ..MoveSuperimposedInputs::within(&LIMITS)
    };
    for _ in 0..600 {
        bench.cycle(|axis| (go.step(axis, &below), on_top.step(axis, &top)));
    }
    bench.cycle(|axis| other.step(axis, &to(1.0)));
    let (below, top) = bench.cycle(|axis| (go.step(axis, &below), on_top.step(axis, &top)));
    assert!(below.command_aborted && top.command_aborted);
    bench.until(AxisState::Standstill);
    at(&bench, 1.0);
}

#[test]
fn two_motions_together_may_not_exceed_the_axis() {
    let mut bench = Bench::standstill();
    let (mut go, mut on_top) = (MoveAbsolute::default(), MoveSuperimposed::default());
    let top = MoveSuperimposedInputs { execute: true, distance: 0.1, ..MoveSuperimposedInputs::within(&LIMITS) };
    let outputs = bench.cycle(|axis| {
        go.step(axis, &to(1.0));
        on_top.step(axis, &top)
    });
    assert_eq!(outputs.error_id, ErrorId::SumAboveLimit);
    assert_eq!(
        on_top.error().unwrap().to_string(),
        "MC_MoveSuperimposed: `Velocity` and that of the other motion must together be at most 1, the limit of the axis, \
         got 2: lower one of them"
    );
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

/// What waits is judged again when its turn comes.
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
        "MC_MoveAbsolute: `Position` 0.5 means nothing on an axis without a reference: execute MC_Home first"
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

#[test]
fn an_override_holds_the_axis_and_lets_it_go_on() {
    let mut bench = Bench::standstill();
    let (mut go, mut slow) = (MoveAbsolute::default(), SetOverride::default());
    let (mut last, mut held) = (bench.axis.commanded(), 0);
    for cycle in 0..8000 {
        let vel_factor = match cycle {
            0..300 => 1.0,
            300..1000 => 0.25,
            1000..2000 => 0.0,
            _ => 0.5,
        };
        let done = bench.cycle(|axis| {
            let inputs = SetOverrideInputs { enable: true, vel_factor, ..SetOverrideInputs::default() };
            assert!(slow.step(axis, &inputs).enabled);
            go.step(axis, &to(1.0)).done
        });
        let now = bench.axis.commanded();
        // A cycle of jerk and of snap at their limits; the margin is rounding.
        assert!((now.a - last.a).abs() <= LIMITS.jerk * 1e-3 * (1.0 + 1e-9), "cycle {cycle}");
        assert!((now.j - last.j).abs() <= LIMITS.snap * 1e-3 * (1.0 + 1e-9), "cycle {cycle}");
        held += usize::from(now.v.abs() < 1e-12 && bench.axis.state() == AxisState::DiscreteMotion);
        if (700..1000).contains(&cycle) {
            assert!((now.v - 0.25).abs() < 1e-12);
        }
        last = now;
        if done {
            assert!(held > 500, "{held}");
            return at(&bench, 1.0);
        }
    }
    panic!("never done");
}

#[test]
fn factors_outside_their_range_are_refused() {
    let mut bench = Bench::standstill();
    let mut slow = SetOverride::default();
    let inputs = SetOverrideInputs { enable: true, acc_factor: 0.0, ..SetOverrideInputs::default() };
    assert_eq!(bench.cycle(|axis| slow.step(axis, &inputs)).error_id, ErrorId::Input);
    let message = slow.error().unwrap().to_string();
    assert_eq!(message, "MC_SetOverride: `AccFactor` must be above 0 and at most 1, got 0: correct the input");
}

/// Oracle: whole turns and the direction, from 350° to 10° and so on; in turns of 1.
#[test]
fn each_direction_goes_its_way_round_a_modulo_axis() {
    for (direction, from, position, unwrapped) in [
        (Direction::Positive, 0.9, 0.1, 1.1),
        (Direction::Negative, 0.9, 0.1, 0.1),
        (Direction::Shortest, 0.9, 0.1, 1.1),
        (Direction::Shortest, 0.1, 0.9, -0.1),
        (Direction::Shortest, 0.25, 0.75, 0.75),
        (Direction::Positive, 0.5, 0.5, 0.5),
        (Direction::Negative, 0.5, 0.5, 0.5),
        (Direction::Current, 0.3, 0.2, 1.2),
        (Direction::Current, -0.3, 0.2, -0.8),
    ] {
        let mut bench = Bench::powered(AxisParams { modulo: Some(1.0), ..Bench::params() });
        let (mut there, mut go) = (MoveRelative::default(), MoveAbsolute::default());
        let way = MoveRelativeInputs { execute: true, distance: from, ..MoveRelativeInputs::within(&LIMITS) };
        bench.cycle(|axis| there.step(axis, &way));
        bench.until(AxisState::Standstill);
        bench.cycle(|axis| go.step(axis, &MoveAbsoluteInputs { direction, ..to(position) }));
        assert_eq!(go.error(), None);
        bench.until(AxisState::Standstill);
        let x = bench.axis.commanded().x;
        assert!((x - unwrapped).abs() < 1e-12, "{direction:?} from {from} to {position}: {x}");
        bench.cycle(|_| ());
        let seen = bench.axis.actual().position;
        assert!((seen - position).abs() < 1e-12, "{seen}");
    }
}

#[test]
fn a_place_before_the_stop_is_gone_to_in_the_next_turn() {
    let mut bench = Bench::powered(AxisParams { modulo: Some(1.0), ..Bench::params() });
    let (mut run, mut go) = (MoveVelocity::default(), MoveAbsolute::default());
    for _ in 0..1000 {
        bench.cycle(|axis| run.step(axis, &running(1.0)));
    }
    let now = bench.axis.commanded().x;
    let position = (now + 0.05).rem_euclid(1.0);
    bench.cycle(|axis| go.step(axis, &MoveAbsoluteInputs { direction: Direction::Positive, ..to(position) }));
    let mut lowest = f64::INFINITY;
    while bench.axis.state() != AxisState::Standstill {
        bench.cycle(|_| ());
        lowest = lowest.min(bench.axis.commanded().v);
    }
    assert!(lowest >= 0.0, "it never turns back: {lowest}");
    assert!((bench.axis.commanded().x - (now + 1.05)).abs() < 1e-9);
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
