//! Homing behind other commands, and commands behind homing.
use crate::bench::{Bench, LIMITS};
use crate::calls::{at, running, to};
use servobench_fieldbus::{Homing, Task};
use servobench_plcopen::{
    AxisParams, AxisState, BufferMode, ErrorId, FunctionBlock, Home, HomeAbsolute, HomeAbsoluteInputs, HomeDirect,
    HomeDirectInputs, HomeInputs, MoveAbsolute, MoveAbsoluteInputs, MoveContinuousAbsolute,
    MoveContinuousAbsoluteInputs, MoveSuperimposed, MoveSuperimposedInputs, MoveVelocity, MoveVelocityInputs, Stop,
    StopInputs,
};

const BLENDING: [BufferMode; 4] =
    [BufferMode::BlendingLow, BufferMode::BlendingPrevious, BufferMode::BlendingNext, BufferMode::BlendingHigh];

fn buffered() -> HomeInputs {
    HomeInputs { execute: true, position: 2.0, buffer_mode: BufferMode::Buffered }
}

fn is_home(bench: &Bench) -> bool {
    bench.command.is_some_and(|command| matches!(command.task, Task::Home { position: 2.0 }))
}

#[test]
fn homing_begins_in_the_cycle_in_which_the_move_before_it_is_done() {
    let mut bench = Bench::standstill();
    let (mut go, mut home) = (MoveAbsolute::default(), Home::default());
    loop {
        let (moved, homed) = bench.cycle(|axis| (go.step(axis, &to(0.25)), home.step(axis, &buffered())));
        assert_eq!((homed.active, is_home(&bench)), (moved.done, moved.done));
        assert!(homed.busy && !homed.error, "{:?}", home.error());
        if moved.done {
            break;
        }
        assert_eq!(bench.axis.state(), AxisState::DiscreteMotion);
    }
    assert_eq!(bench.axis.state(), AxisState::Homing);
    bench.homing = Homing::Attained;
    while !bench.cycle(|axis| home.step(axis, &buffered())).done {}
    assert_eq!((bench.axis.state(), bench.axis.is_homed()), (AxisState::Standstill, true));
    at(&bench, 2.0);
}

#[test]
fn homing_waits_for_a_superimposed_move_too() {
    let mut bench = Bench::standstill();
    let half = servobench_motion::Limits { velocity: 0.5, acceleration: 2.0, jerk: 20.0, snap: 500.0 };
    let (mut go, mut on_top, mut home) = (MoveAbsolute::default(), MoveSuperimposed::default(), Home::default());
    let below = MoveAbsoluteInputs { execute: true, position: 0.1, ..MoveAbsoluteInputs::within(&half) };
    let top = MoveSuperimposedInputs { execute: true, distance: 0.4, ..MoveSuperimposedInputs::within(&half) };
    let mut done = [None; 2];
    for cycle in 0..5000 {
        let (moved, added, homed) =
            bench.cycle(|axis| (go.step(axis, &below), on_top.step(axis, &top), home.step(axis, &buffered())));
        assert!(!added.error && !homed.error, "{:?} {:?}", on_top.error(), home.error());
        assert_eq!((homed.active, is_home(&bench)), (added.done, added.done), "cycle {cycle}");
        done = [done[0].or(moved.done.then_some(cycle)), done[1].or(added.done.then_some(cycle))];
        if homed.active {
            break;
        }
    }
    assert!(done[0] < done[1] && done[0].is_some(), "{done:?}");
}

/// Absolute, on an axis that has no reference before.
#[test]
fn a_move_waits_for_homing_and_begins_in_the_cycle_in_which_it_is_done() {
    for buffer_mode in BLENDING.into_iter().chain([BufferMode::Buffered]) {
        let mut bench = Bench::powered(AxisParams { needs_homing: true, ..Bench::params() });
        let (mut home, mut go, mut now) = (Home::default(), MoveAbsolute::default(), MoveAbsolute::default());
        let homing = HomeInputs { buffer_mode: BufferMode::Aborting, ..buffered() };
        let waiting = MoveAbsoluteInputs { buffer_mode, ..to(2.5) };
        for _ in 0..10 {
            let (homed, moved) = bench.cycle(|axis| (home.step(axis, &homing), go.step(axis, &waiting)));
            assert!(homed.active && moved.busy && !moved.active && !moved.error, "{buffer_mode:?} {:?}", go.error());
        }
        assert_eq!(bench.cycle(|axis| now.step(axis, &to(2.5))).error_id, ErrorId::State, "nothing aborts homing");
        bench.homing = Homing::Attained;
        loop {
            let (homed, moved) = bench.cycle(|axis| (home.step(axis, &homing), go.step(axis, &waiting)));
            assert_eq!(homed.done, moved.active);
            if homed.done {
                break;
            }
        }
        assert_eq!(bench.axis.state(), AxisState::DiscreteMotion);
        at(&bench, 2.0);
        bench.until(AxisState::Standstill);
        at(&bench, 2.5);
    }
}

#[test]
fn homing_blends_with_nothing() {
    for (buffer_mode, name) in BLENDING.into_iter().zip(["Low", "Previous", "Next", "High"]) {
        let (mut bench, mut home) = (Bench::standstill(), Home::default());
        let outputs = bench.cycle(|axis| home.step(axis, &HomeInputs { buffer_mode, ..buffered() }));
        assert_eq!(outputs.error_id, ErrorId::BufferMode);
        assert_eq!(
            home.error().unwrap().to_string(),
            format!(
                "MC_Home: `BufferMode` must be mcAborting or mcBuffered, as homing begins at Standstill, got \
                 mcBlending{name}: correct the input"
            )
        );
        assert_eq!(bench.axis.state(), AxisState::Standstill);
    }
}

/// Behind a command that runs, behind one that waits, and behind one that waits for homing.
#[test]
fn homing_does_not_wait_for_what_never_stands_still() {
    let refused =
        "MC_Home: `BufferMode` must be after a command that ends at Standstill, got mcBuffered: correct the input";
    let (mut bench, mut run, mut home) = (Bench::standstill(), MoveVelocity::default(), Home::default());
    let (_, outputs) = bench.cycle(|axis| (run.step(axis, &running(0.5)), home.step(axis, &buffered())));
    assert_eq!((outputs.error_id, home.error().unwrap().to_string().as_str()), (ErrorId::BufferMode, refused));
    let (mut bench, mut go, mut pass, mut home) =
        (Bench::standstill(), MoveAbsolute::default(), MoveContinuousAbsolute::default(), Home::default());
    let passing = MoveContinuousAbsoluteInputs {
        execute: true,
        position: 0.5,
        buffer_mode: BufferMode::Buffered,
        ..MoveContinuousAbsoluteInputs::within(&LIMITS)
    };
    let (_, waiting, outputs) =
        bench.cycle(|axis| (go.step(axis, &to(0.25)), pass.step(axis, &passing), home.step(axis, &buffered())));
    assert!(waiting.busy && !waiting.error);
    assert_eq!((outputs.error_id, home.error().unwrap().to_string().as_str()), (ErrorId::BufferMode, refused));
    let (mut bench, mut first, mut run, mut home) =
        (Bench::standstill(), Home::default(), MoveVelocity::default(), Home::default());
    let waiting = MoveVelocityInputs { buffer_mode: BufferMode::Buffered, ..running(0.5) };
    let (_, _, outputs) =
        bench.cycle(|axis| (first.step(axis, &buffered()), run.step(axis, &waiting), home.step(axis, &buffered())));
    assert_eq!((outputs.error_id, home.error().unwrap().to_string().as_str()), (ErrorId::BufferMode, refused));
}

#[test]
fn a_stop_takes_homing_away_that_waits() {
    let (mut bench, mut go, mut home, mut stop) =
        (Bench::standstill(), MoveAbsolute::default(), Home::default(), Stop::default());
    for _ in 0..100 {
        bench.cycle(|axis| (go.step(axis, &to(0.25)), home.step(axis, &buffered())));
    }
    let outputs = bench.cycle(|axis| {
        stop.step(axis, &StopInputs { execute: true, ..StopInputs::within(&LIMITS) });
        home.step(axis, &buffered())
    });
    assert!(outputs.command_aborted && !outputs.busy);
    for _ in 0..500 {
        bench.cycle(|axis| stop.step(axis, &StopInputs { execute: false, ..StopInputs::within(&LIMITS) }));
        assert!(!is_home(&bench));
    }
    assert_eq!(bench.axis.state(), AxisState::Standstill);
}

/// Without motion and without the drive: the axis stays at its place, and counts from there.
#[test]
fn a_reference_may_be_given_where_the_axis_stands() {
    let mut bench = Bench::powered(AxisParams { needs_homing: true, ..Bench::params() });
    bench.feedback.position = 0.123;
    let (mut home, mut go) = (HomeDirect::default(), MoveAbsolute::default());
    let inputs = HomeDirectInputs { execute: true, position: 0.7, buffer_mode: BufferMode::Aborting };
    let before = bench.axis.commanded().x;
    let first = bench.cycle(|axis| home.step(axis, &inputs));
    assert!(first.busy && first.active && !first.error, "{:?}", home.error());
    assert_eq!(bench.axis.state(), AxisState::Homing);
    assert!(matches!(bench.command.unwrap().task, Task::Follow(_)));
    let measured = bench.feedback.position;
    assert!(bench.cycle(|axis| home.step(axis, &inputs)).done);
    assert_eq!((bench.axis.state(), bench.axis.is_homed()), (AxisState::Standstill, true));
    // The set-point of the drive is where it was.
    let Task::Follow(sample) = bench.command.unwrap().task else { panic!("follows") };
    assert_eq!(sample.x.to_bits(), before.to_bits());
    assert_eq!((bench.axis.commanded().x - before).to_bits(), (0.7 - measured).to_bits());
    bench.cycle(|axis| go.step(axis, &to(0.9)));
    bench.until(AxisState::Standstill);
    at(&bench, 0.9);
}

#[test]
fn the_encoder_may_be_the_reference() {
    let mut bench = Bench::powered(AxisParams { needs_homing: true, ..Bench::params() });
    let (mut direct, mut absolute) = (HomeDirect::default(), HomeAbsolute::default());
    let given = HomeDirectInputs { execute: true, position: 5.0, buffer_mode: BufferMode::Aborting };
    let taken = HomeAbsoluteInputs { execute: true, buffer_mode: BufferMode::Aborting };
    while !bench.cycle(|axis| direct.step(axis, &given)).done {}
    at(&bench, 5.0);
    while !bench.cycle(|axis| absolute.step(axis, &taken)).done {}
    at(&bench, 0.0);
    assert!(bench.axis.is_homed());
}

/// As MC_Home: not in motion, behind a move that ends, and never blended.
#[test]
fn a_reference_is_given_at_standstill() {
    let (mut bench, mut run, mut home) = (Bench::standstill(), MoveVelocity::default(), HomeDirect::default());
    let inputs = HomeDirectInputs { execute: true, position: 0.5, buffer_mode: BufferMode::Aborting };
    bench.cycle(|axis| run.step(axis, &running(0.5)));
    assert_eq!(bench.cycle(|axis| home.step(axis, &inputs)).error_id, ErrorId::State);
    let (mut bench, mut go, mut home) = (Bench::standstill(), MoveAbsolute::default(), HomeDirect::default());
    let inputs = HomeDirectInputs { buffer_mode: BufferMode::Buffered, ..inputs };
    let mut done = false;
    for _ in 0..1000 {
        done |= bench.cycle(|axis| (go.step(axis, &to(0.25)), home.step(axis, &inputs))).1.done;
    }
    assert!(done);
    at(&bench, 0.5);
    let blended = HomeDirectInputs { buffer_mode: BufferMode::BlendingLow, ..inputs };
    let outputs = bench.cycle(|axis| HomeDirect::default().step(axis, &blended));
    assert_eq!(outputs.error_id, ErrorId::BufferMode);
}
