//! MC_MoveSuperimposed: a motion on top of another.
use crate::bench::{Bench, LIMITS};
use crate::calls::{at, running, to};
use servobench_plcopen::{
    AxisState, ErrorId, FunctionBlock, HaltSuperimposed, HaltSuperimposedInputs, MoveAbsolute, MoveAbsoluteInputs,
    MoveSuperimposed, MoveSuperimposedInputs, MoveVelocity, MoveVelocityInputs,
};

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
    // The third replaces the second on its way: it counts from the distance that the second has reached.
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
    // The replaced block reports at its call, a cycle after the set-point from which the third continues.
    assert!((added - (0.25 + replaced)).abs() < 1e-12, "{added} {replaced}");
    assert!((bench.axis.commanded().v - 0.5).abs() < 1e-12);
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

/// The motion on top brakes with the given limits and stays where it stops; the motion below is the same as without it.
#[test]
fn a_superimposed_move_is_halted_and_the_one_below_goes_on() {
    let (mut bench, mut alone) = (Bench::standstill(), Bench::standstill());
    let (mut go, mut reference) = (MoveVelocity::default(), MoveVelocity::default());
    let (mut on_top, mut halt) = (MoveSuperimposed::default(), HaltSuperimposed::default());
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
    let halting = HaltSuperimposedInputs { execute: true, deceleration: 1.7, jerk: Some(18.0), snap: Some(450.0) };
    let (mut covered, mut done_at) = (0.0, None);
    for cycle in 0..3000 {
        alone.cycle(|axis| reference.step(axis, &below));
        let (outputs, halted) = bench.cycle(|axis| {
            go.step(axis, &below);
            let outputs = on_top.step(axis, &MoveSuperimposedInputs { execute: cycle >= 500, ..top });
            let execute = cycle >= 1000;
            (outputs, halt.step(axis, &HaltSuperimposedInputs { execute, ..halting }))
        });
        assert!(!outputs.error && !halted.error, "{:?} {:?}", on_top.error(), halt.error());
        assert_eq!(outputs.command_aborted, cycle > 1000, "{cycle}");
        let added = bench.axis.commanded().v - alone.axis.commanded().v;
        let gained = bench.axis.commanded().a - alone.axis.commanded().a;
        assert!(gained >= -1.7 - 1e-9, "{gained}");
        if halted.done && done_at.is_none() {
            done_at = Some(cycle);
            covered = bench.axis.commanded().x - alone.axis.commanded().x;
            assert!(added.abs() < 1e-12, "{added}");
        }
    }
    // From 0.25 m/s with 1.7 m/s² and 18 m/s³: v/a + a/j = 0.241 s, and some for the snap.
    let braking = f64::from(done_at.unwrap() - 1000) * 1e-3;
    assert!((0.241..0.300).contains(&braking), "{braking}");
    assert!((bench.axis.commanded().x - alone.axis.commanded().x - covered).abs() < 1e-12);
    assert_eq!(bench.axis.state(), AxisState::ContinuousMotion);
}

#[test]
fn nothing_to_halt_is_done_at_once() {
    let (mut bench, mut halt) = (Bench::standstill(), HaltSuperimposed::default());
    let inputs = HaltSuperimposedInputs { execute: true, deceleration: 1.0, jerk: None, snap: None };
    assert!(bench.cycle(|axis| halt.step(axis, &inputs)).done);
    let mut bench = Bench::disabled(Bench::params());
    let outputs = bench.cycle(|axis| HaltSuperimposed::default().step(axis, &inputs));
    assert_eq!(outputs.error_id, ErrorId::State);
}

/// At Standstill the motion on top is the only one: halted, the axis is at Standstill again; a new one takes over from the halt.
#[test]
fn a_halted_superimposed_move_leaves_standstill_behind() {
    let (mut bench, mut on_top, mut halt) =
        (Bench::standstill(), MoveSuperimposed::default(), HaltSuperimposed::default());
    let top = MoveSuperimposedInputs { execute: true, distance: 0.5, ..MoveSuperimposedInputs::within(&LIMITS) };
    let halting = HaltSuperimposedInputs { execute: true, deceleration: 4.0, jerk: Some(40.0), snap: Some(900.0) };
    for _ in 0..300 {
        bench.cycle(|axis| on_top.step(axis, &top));
    }
    bench.cycle(|axis| halt.step(axis, &halting));
    for _ in 0..20 {
        assert!(bench.cycle(|axis| halt.step(axis, &halting)).busy);
    }
    let mut again = MoveSuperimposed::default();
    let outputs = bench.cycle(|axis| again.step(axis, &top));
    assert!(outputs.busy, "{:?}", again.error());
    assert!(bench.cycle(|axis| halt.step(axis, &halting)).command_aborted);
    let mut last = HaltSuperimposed::default();
    bench.cycle(|axis| last.step(axis, &halting));
    bench.until(AxisState::Standstill);
    assert!(bench.cycle(|axis| last.step(axis, &halting)).done);
    assert!(bench.axis.commanded().x > 0.0 && bench.axis.commanded().x < 0.9);
}
