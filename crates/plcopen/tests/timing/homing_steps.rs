//! Steps of homing: against an obstacle, and away from it.
use crate::bench::{Bench, CYCLE_TIME, LIMITS};
use crate::calls::{at, to};
use servobench_fieldbus::Task;
use servobench_plcopen::{
    Axis, AxisError, AxisParams, AxisState, BufferMode, Direction, ErrorId, FinishHoming, FinishHomingInputs,
    FunctionBlock, HomeDirect, HomeDirectInputs, MotionOutputs, MoveAbsolute, MoveAbsoluteInputs, StepBlock,
    StepBlockInputs, Stop, StopInputs,
};

/// Position of the obstacle (m), and force of the drive per following error (N/m).
const OBSTACLE: f64 = 0.1;
const GAIN: f64 = 1e3;
/// Force limit of the search (N), and the least force that counts as reaching it.
const FORCE: f64 = 2.0;
const ENOUGH: f64 = 0.95 * FORCE;

fn search() -> StepBlockInputs {
    StepBlockInputs { execute: true, position: 3.0, ..StepBlockInputs::pushing(FORCE, &LIMITS) }
}

fn away(distance: f64) -> FinishHomingInputs {
    FinishHomingInputs { execute: true, distance, ..FinishHomingInputs::within(&LIMITS) }
}

/// Runs a cycle of an axis that an obstacle holds: the drive gives the force of its position loop, within its limit.
fn cycle<T>(bench: &mut Bench, obstacle: f64, program: impl FnOnce(&mut Axis) -> T) -> T {
    let answer = bench.cycle(program);
    let command = bench.command.unwrap();
    let Task::Follow(sample) = command.task else { panic!("follows: {:?}", command.task) };
    let ahead = sample.x - obstacle;
    bench.feedback.effort = 0.0;
    bench.feedback.following_error = 0.0;
    if ahead > 0.0 {
        (bench.feedback.position, bench.feedback.velocity, bench.feedback.following_error) = (obstacle, 0.0, ahead);
        bench.feedback.effort = (GAIN * ahead).min(command.effort_limit.unwrap_or(f64::INFINITY));
    }
    answer
}

/// Runs a search until it is done, and calls `watch` in every cycle.
fn searched(bench: &mut Bench, inputs: &StepBlockInputs, mut watch: impl FnMut(&Bench, &MotionOutputs)) -> usize {
    let mut block = StepBlock::default();
    for cycles in 1..10_000 {
        let outputs = cycle(bench, OBSTACLE, |axis| block.step(axis, inputs));
        assert!(!outputs.error, "{:?}", block.error());
        watch(bench, &outputs);
        if outputs.done {
            return cycles;
        }
    }
    panic!("never done")
}

/// Oracle: the obstacle. The set-point stays where the force is reached, and is back at the obstacle when the step is done.
#[test]
fn a_step_is_done_at_the_obstacle_and_leaves_the_axis_in_homing() {
    let mut bench = Bench::powered(AxisParams { needs_homing: true, ..Bench::params() });
    let (mut furthest, mut held) = (0.0_f64, None);
    searched(&mut bench, &search(), |bench, outputs| {
        furthest = furthest.max(bench.axis.sent().x - OBSTACLE);
        assert_eq!(bench.command.unwrap().effort_limit, Some(FORCE));
        assert_eq!(bench.axis.state(), AxisState::Homing);
        if bench.feedback.effort >= ENOUGH && held.is_none() {
            held = Some(outputs.active);
        }
    });
    assert_eq!(held, Some(true));
    // The force is reached 1.9 mm behind the obstacle; the axis detects it a cycle later, at 0.1 m/s.
    assert!((furthest - ENOUGH / GAIN).abs() < 0.1 * 2.0 * CYCLE_TIME, "{furthest}");
    assert!((bench.axis.sent().x - OBSTACLE).abs() < 1e-12);
    assert!(!bench.axis.is_homed());
    at(&bench, 3.0);
    let mut finish = FinishHoming::default();
    let mut last = cycle(&mut bench, OBSTACLE, |axis| finish.step(axis, &away(-0.05)));
    assert_eq!(bench.command.unwrap().effort_limit, None, "the limit is lifted when the axis leaves the obstacle");
    while !last.done {
        assert!(last.active && !bench.axis.is_homed() && bench.axis.state() == AxisState::Homing);
        last = cycle(&mut bench, OBSTACLE, |axis| finish.step(axis, &away(-0.05)));
    }
    assert_eq!((bench.axis.state(), bench.axis.is_homed()), (AxisState::Standstill, true));
    assert!((bench.axis.commanded().x - 2.95).abs() < 1e-12);
}

/// Oracle: the cycles themselves. Held and slow for 50 ms means 51 such cycles; the rest is the way back.
#[test]
fn an_obstacle_holds_the_axis_for_the_time_without_a_break() {
    let lasting = |time: f64, interrupted: bool| {
        let (mut bench, mut block) = (Bench::standstill(), StepBlock::default());
        let inputs = StepBlockInputs { detection_velocity_time: time, ..search() };
        let (mut told, mut breaks) = (0, 0);
        loop {
            let before = bench.axis.sent().x;
            let outputs = cycle(&mut bench, OBSTACLE, |axis| block.step(axis, &inputs));
            if bench.axis.sent().x < before || outputs.done {
                return told;
            }
            told += usize::from(bench.feedback.effort >= ENOUGH);
            if interrupted && told == 30 && breaks == 0 {
                (told, breaks) = (0, 1);
                bench.feedback.velocity = 0.5;
            }
        }
    };
    assert_eq!(lasting(0.05, false), 51);
    assert_eq!(lasting(0.05, true), 51, "counted anew");
    assert_eq!(lasting(0.0504, false), 52, "a part of a cycle is one");
}

#[test]
fn a_search_ends_at_its_limits_of_time_and_distance() {
    for (inputs, input, limit) in [
        (StepBlockInputs { time_limit: 0.3, ..search() }, "TimeLimit", 0.3),
        (StepBlockInputs { distance_limit: 0.02, ..search() }, "DistanceLimit", 0.02),
    ] {
        let (mut bench, mut block) = (Bench::standstill(), StepBlock::default());
        let mut cycles = 0;
        let outputs = loop {
            let outputs = cycle(&mut bench, 1e9, |axis| block.step(axis, &inputs));
            if !outputs.busy {
                break outputs;
            }
            cycles += 1;
        };
        assert_eq!(outputs.error_id, ErrorId::NoObstacle);
        assert_eq!(bench.axis.error(), Some(&AxisError::NoObstacle { input, limit }));
        assert!(input != "TimeLimit" || cycles == 300, "{cycles}");
        assert!(input != "DistanceLimit" || (bench.feedback.position - 0.02).abs() < 1e-3);
        assert_eq!((bench.axis.state(), bench.command.unwrap().effort_limit), (AxisState::ErrorStop, None));
    }
}

#[test]
fn what_cannot_be_an_obstacle_is_refused() {
    let refused = |inputs: StepBlockInputs| {
        let (mut bench, mut block) = (Bench::standstill(), StepBlock::default());
        let id = bench.cycle(|axis| block.step(axis, &inputs)).error_id;
        assert_eq!(bench.axis.state(), AxisState::Standstill);
        (id, block.error().unwrap().to_string())
    };
    for direction in [Direction::Shortest, Direction::Current] {
        assert_eq!(refused(StepBlockInputs { direction, ..search() }).0, ErrorId::Direction);
    }
    for (inputs, name) in [
        (StepBlockInputs { torque_limit: 0.0, ..search() }, "TorqueLimit"),
        (StepBlockInputs { torque_tolerance: Some(-1.0), ..search() }, "TorqueTolerance"),
        (StepBlockInputs { detection_velocity_limit: f64::NAN, ..search() }, "DetectionVelocityLimit"),
        (StepBlockInputs { detection_velocity_time: -1e-3, ..search() }, "DetectionVelocityTime"),
        (StepBlockInputs { time_limit: f64::NAN, ..search() }, "TimeLimit"),
        (StepBlockInputs { distance_limit: -1.0, ..search() }, "DistanceLimit"),
        (StepBlockInputs { position: f64::INFINITY, ..search() }, "SetPosition"),
    ] {
        let (id, message) = refused(inputs);
        assert_eq!(id, ErrorId::Input, "{name}");
        assert!(message.contains(&format!("`{name}`")), "{message}");
    }
    assert_eq!(refused(StepBlockInputs { velocity: 2.0, ..search() }).0, ErrorId::AboveLimit);
    assert_eq!(refused(StepBlockInputs { buffer_mode: BufferMode::BlendingLow, ..search() }).0, ErrorId::BufferMode);
    let (mut bench, mut block) = (Bench::standstill(), StepBlock::default());
    bench.permits_negative = false;
    let inputs = StepBlockInputs { direction: Direction::Negative, ..search() };
    assert_eq!(bench.cycle(|axis| block.step(axis, &inputs)).error_id, ErrorId::NotPermitted);
}

/// The end of homing waits for the step, a move for the end of homing; a move cannot wait for a step, which ends in Homing.
#[test]
fn steps_the_end_of_homing_and_moves_wait_for_each_other() {
    let mut bench = Bench::powered(AxisParams { needs_homing: true, ..Bench::params() });
    let (mut step, mut early, mut finish, mut go) =
        (StepBlock::default(), MoveAbsolute::default(), FinishHoming::default(), MoveAbsolute::default());
    let waiting = FinishHomingInputs { buffer_mode: BufferMode::Buffered, ..away(-0.05) };
    let then = MoveAbsoluteInputs { buffer_mode: BufferMode::BlendingNext, ..to(2.5) };
    let refused = cycle(&mut bench, OBSTACLE, |axis| (step.step(axis, &search()), early.step(axis, &then))).1;
    assert_eq!(refused.error_id, ErrorId::State);
    let mut seen = Vec::new();
    for _ in 0..10_000 {
        let (stepped, finished, moved) = cycle(&mut bench, OBSTACLE, |axis| {
            (step.step(axis, &search()), finish.step(axis, &waiting), go.step(axis, &then))
        });
        assert!(!stepped.error && !finished.error && !moved.error, "{:?} {:?}", finish.error(), go.error());
        assert_eq!(
            [stepped.active, finished.active, moved.active].iter().filter(|active| **active).count(),
            usize::from(!moved.done)
        );
        seen.push(bench.axis.state());
        if moved.done {
            break;
        }
    }
    seen.dedup();
    assert_eq!(seen, [AxisState::Homing, AxisState::DiscreteMotion, AxisState::Standstill]);
    assert!(bench.axis.is_homed());
    at(&bench, 2.5);
}

/// Zero is a distance too; HomeDirect ends homing where the axis stands; without a step that found something nothing is homed.
#[test]
fn homing_ends_where_the_axis_stands() {
    let mut bench = Bench::standstill();
    searched(&mut bench, &search(), |_, _| ());
    let mut finish = FinishHoming::default();
    while !cycle(&mut bench, OBSTACLE, |axis| finish.step(axis, &away(0.0))).done {}
    assert_eq!((bench.axis.state(), bench.axis.is_homed()), (AxisState::Standstill, true));
    at(&bench, 3.0);

    searched(&mut bench, &search(), |_, _| ());
    let (mut direct, given) =
        (HomeDirect::default(), HomeDirectInputs { execute: true, position: 7.0, ..HomeDirectInputs::default() });
    while !cycle(&mut bench, OBSTACLE, |axis| direct.step(axis, &given)).done {}
    assert_eq!((bench.axis.state(), bench.axis.is_homed()), (AxisState::Standstill, true));
    at(&bench, 7.0);

    let (mut step, mut finish) = (StepBlock::default(), FinishHoming::default());
    let backwards = StepBlockInputs { direction: Direction::Negative, ..search() };
    for _ in 0..100 {
        cycle(&mut bench, OBSTACLE, |axis| step.step(axis, &backwards));
    }
    loop {
        let (stepped, finished) =
            cycle(&mut bench, OBSTACLE, |axis| (step.step(axis, &backwards), finish.step(axis, &away(0.0))));
        if finished.done {
            break;
        }
        assert!(stepped.busy || stepped.command_aborted);
    }
    assert_eq!((bench.axis.state(), bench.axis.is_homed()), (AxisState::Standstill, false));
}

/// The set-point continues from the position at which the axis is held, not from behind the obstacle.
#[test]
fn a_stop_while_the_axis_is_held_leaves_nothing_that_pushes() {
    let (mut bench, mut step, mut stop) = (Bench::standstill(), StepBlock::default(), Stop::default());
    let lasting = StepBlockInputs { detection_velocity_time: 1.0, ..search() };
    while bench.feedback.effort < ENOUGH {
        cycle(&mut bench, OBSTACLE, |axis| step.step(axis, &lasting));
    }
    cycle(&mut bench, OBSTACLE, |axis| step.step(axis, &lasting));
    assert!(bench.axis.sent().x > OBSTACLE + 1e-3);
    let inputs = StopInputs { execute: true, ..StopInputs::within(&LIMITS) };
    let stepped = cycle(&mut bench, OBSTACLE, |axis| {
        stop.step(axis, &inputs);
        step.step(axis, &lasting)
    });
    assert!(stepped.command_aborted);
    assert!((bench.axis.sent().x - OBSTACLE).abs() < 1e-12 && bench.feedback.effort < 1e-9);
    assert_eq!((bench.axis.state(), bench.command.unwrap().effort_limit), (AxisState::Stopping, None));
}
