//! Figure 3 of Pietrusewicz, Waszczuk & Kubicki (2019), after the standard's figure of MC_MoveAbsolute: two absolute moves, the
//! second after the first (a) and during it (b).
use crate::bench::{Bench, CYCLE_TIME, LIMITS};
use servobench_plcopen::{AxisState, FunctionBlock, MotionOutputs, MoveAbsolute, MoveAbsoluteInputs};

const FIRST: f64 = 0.6;
const SECOND: f64 = 1.0;

/// Outputs of both blocks and the velocity in each cycle, and the final position; `start` decides when the second is executed.
fn run(start: impl Fn(usize, &MotionOutputs) -> bool) -> (Vec<[MotionOutputs; 2]>, Vec<f64>, f64) {
    let mut bench = Bench::standstill();
    let (mut first, mut second) = (MoveAbsolute::default(), MoveAbsolute::default());
    let to = |execute, position| MoveAbsoluteInputs { execute, position, ..MoveAbsoluteInputs::within(&LIMITS) };
    let (mut course, mut velocities, mut started) = (Vec::new(), Vec::new(), false);
    for cycle in 0..4000 {
        let outputs = bench.cycle(|axis| {
            let one = first.step(axis, &to(true, FIRST));
            started |= start(cycle, &one);
            [one, second.step(axis, &to(started, SECOND))]
        });
        course.push(outputs);
        velocities.push(bench.axis.commanded().v);
        if outputs[1].done {
            assert_eq!(bench.axis.state(), AxisState::Standstill);
            return (course, velocities, bench.axis.commanded().x);
        }
    }
    panic!("the second move is never done");
}

#[test]
fn figure_3a_the_second_move_starts_when_the_first_is_done() {
    let (course, velocities, end) = run(|_, first| first.done);
    assert_eq!(end.to_bits(), SECOND.to_bits());
    let done = course.iter().position(|[first, _]| first.done).unwrap();
    // The published box lengths of 1 m are 1, 0.2, 0.1 and 0.05 s; of 0.6 m the first is 0.6 s.
    assert_eq!(done, 950);
    for [first, second] in &course[..done] {
        assert!(first.busy && first.active && !second.busy);
    }
    for [first, second] in &course[done..] {
        assert!(first.done && !first.busy && !first.active && !first.command_aborted);
        assert!(second.busy != second.done && second.active != second.done);
    }
    assert!(velocities[done].abs() == 0.0, "the first has stopped");
}

#[test]
fn figure_3b_the_second_move_takes_over_from_the_first() {
    const TAKEN_OVER: usize = 500;
    let (course, velocities, end) = run(|cycle, _| cycle >= TAKEN_OVER);
    assert_eq!(end.to_bits(), SECOND.to_bits());
    for (cycle, [first, second]) in course.iter().enumerate() {
        assert!(!first.done, "cycle {cycle}");
        assert_eq!(first.busy, cycle <= TAKEN_OVER, "the first was called before the second in the cycle of the abort");
        assert_eq!(first.command_aborted, cycle > TAKEN_OVER, "cycle {cycle}");
        assert_eq!(second.busy, cycle >= TAKEN_OVER && cycle + 1 < course.len(), "cycle {cycle}");
    }
    // It never slows down in between, so that it takes no longer than one move of 1 m would: 1.35 s.
    assert_eq!(course.len() - 1, 1350);
    let moving = &velocities[1..velocities.len() - 1];
    assert!(moving.iter().all(|v| *v > 0.0 && *v <= LIMITS.velocity * (1.0 + 1e-12)));
    let step = LIMITS.acceleration * CYCLE_TIME * (1.0 + 1e-9);
    assert!(velocities.windows(2).all(|pair| (pair[1] - pair[0]).abs() <= step));
}
