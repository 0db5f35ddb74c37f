//! The rules of Execute, one by one (PLCopen part 1, section 2.4.1).
use crate::bench::{Bench, LIMITS};
use servobench_plcopen::{
    Axis, AxisState, BufferMode, ErrorId, FunctionBlock, Halt, HaltInputs, MotionOutputs, MoveAbsolute,
    MoveAbsoluteInputs, MoveVelocity, MoveVelocityInputs, Stop, StopInputs, StopOutputs,
};

fn to(execute: bool, position: f64) -> MoveAbsoluteInputs {
    MoveAbsoluteInputs { execute, position, ..MoveAbsoluteInputs::within(&LIMITS) }
}

fn exclusive(outputs: MotionOutputs) {
    let MotionOutputs { done, busy, active, command_aborted, error, error_id } = outputs;
    assert!([done, busy, command_aborted, error].iter().filter(|set| **set).count() <= 1, "{outputs:?}");
    assert!(busy || !active, "{outputs:?}");
    assert_eq!(error, error_id != ErrorId::None, "{outputs:?}");
}

/// Outputs of a new block over `cycles`, called with the `execute` of each cycle.
fn outputs(bench: &mut Bench, cycles: usize, position: f64, execute: impl Fn(usize) -> bool) -> Vec<MotionOutputs> {
    let mut block = MoveAbsolute::default();
    (0..cycles)
        .map(|cycle| bench.cycle(|axis| block.step(axis, &to(execute(cycle), position))))
        .inspect(|outputs| exclusive(*outputs))
        .collect()
}

#[test]
fn busy_and_active_rise_with_execute() {
    let course = outputs(&mut Bench::standstill(), 3, 0.1, |cycle| cycle >= 1);
    assert_eq!(course[0], MotionOutputs::default());
    assert!(course[1].busy && course[1].active);
}

#[test]
fn done_stays_until_execute_falls() {
    let course = outputs(&mut Bench::standstill(), 1500, 0.1, |cycle| cycle < 1400);
    let done = course.iter().position(|outputs| outputs.done).unwrap();
    assert!(course[done..1400].iter().all(|outputs| outputs.done));
    assert!(course[1400..].iter().all(|outputs| *outputs == MotionOutputs::default()));
}

#[test]
fn done_lasts_one_cycle_when_execute_fell_before() {
    let course = outputs(&mut Bench::standstill(), 1500, 0.1, |cycle| cycle < 2);
    assert!(course[2].busy, "a falling edge does not end the motion");
    assert_eq!(course.iter().filter(|outputs| outputs.done).count(), 1);
    assert_eq!(course.last(), Some(&MotionOutputs::default()));
}

#[test]
fn inputs_are_taken_over_at_the_edge_only() {
    let mut bench = Bench::standstill();
    let mut block = MoveAbsolute::default();
    for cycle in 0..1500 {
        bench.cycle(|axis| block.step(axis, &to(true, if cycle == 0 { 0.1 } else { 0.7 })));
    }
    assert_eq!(bench.axis.commanded().x.to_bits(), 0.1_f64.to_bits());
}

#[test]
fn continuous_update_takes_over_what_changes() {
    let mut bench = Bench::standstill();
    let mut block = MoveAbsolute::default();
    let mut done = Vec::new();
    for cycle in 0..1500 {
        let inputs = MoveAbsoluteInputs { continuous_update: true, ..to(true, if cycle < 100 { 0.1 } else { 0.2 }) };
        done.push(bench.cycle(|axis| block.step(axis, &inputs)).done);
    }
    assert_eq!(bench.axis.commanded().x.to_bits(), 0.2_f64.to_bits());
    assert!(done[1499] && !done[99]);
}

#[test]
fn a_refusal_says_what_is_wrong_until_execute_falls() {
    let mut bench = Bench::standstill();
    let mut block = MoveAbsolute::default();
    let refused = |velocity| MoveAbsoluteInputs { velocity, ..to(true, 0.1) };
    let outputs = bench.cycle(|axis| block.step(axis, &refused(-1.0)));
    assert_eq!(outputs.error_id, ErrorId::Input);
    exclusive(outputs);
    let message = block.error().unwrap().to_string();
    assert_eq!(message, "MC_MoveAbsolute: `Velocity` must be positive, from 1e-15 to 1e15, got -1: correct the input");
    assert!(bench.cycle(|axis| block.step(axis, &refused(-1.0))).error, "level of Execute");
    assert_eq!(bench.cycle(|axis| block.step(axis, &to(false, 0.1))), MotionOutputs::default());
    assert_eq!(block.error(), None);
    let outputs = bench.cycle(|axis| block.step(axis, &refused(2.0)));
    assert_eq!(outputs.error_id, ErrorId::AboveLimit);
    assert_eq!(
        block.error().unwrap().to_string(),
        "MC_MoveAbsolute: `Velocity` must be at most 1, the limit of the axis, got 2: lower it or raise the limit"
    );
    assert_eq!(bench.axis.state(), AxisState::Standstill, "errors of blocks are not errors of the axis");
}

/// The new command is refused; the one before continues, though no block reports it any more.
#[test]
fn an_edge_that_is_refused_leaves_the_motion_before_alone() {
    let (mut bench, mut block) = (Bench::standstill(), MoveAbsolute::default());
    for cycle in 0..100 {
        bench.cycle(|axis| block.step(axis, &to(cycle < 50, 0.1)));
    }
    let outputs = bench.cycle(|axis| block.step(axis, &MoveAbsoluteInputs { velocity: -1.0, ..to(true, 0.2) }));
    assert_eq!((outputs.error_id, outputs.busy), (ErrorId::Input, false));
    assert_eq!(bench.axis.state(), AxisState::DiscreteMotion);
    bench.until(AxisState::Standstill);
    assert_eq!(bench.axis.commanded().x.to_bits(), 0.1_f64.to_bits());
    assert!(bench.cycle(|axis| block.step(axis, &to(true, 0.2))).error, "no Done of the one before");
}

#[test]
fn two_blocks_in_one_cycle_resolve_in_the_order_of_their_calls() {
    let mut bench = Bench::standstill();
    let (mut first, mut second) = (MoveAbsolute::default(), MoveAbsolute::default());
    let both = |first: &mut MoveAbsolute, second: &mut MoveAbsolute, axis: &mut Axis| {
        [first.step(axis, &to(true, 0.1)), second.step(axis, &to(true, 0.2))]
    };
    let [one, two] = bench.cycle(|axis| both(&mut first, &mut second, axis));
    assert!(one.active && two.active, "the first was called before it was aborted");
    let [one, two] = bench.cycle(|axis| both(&mut first, &mut second, axis));
    assert!(one.command_aborted && two.active);
    bench.until(AxisState::Standstill);
    assert_eq!(bench.axis.commanded().x.to_bits(), 0.2_f64.to_bits());
}

#[test]
fn a_buffered_command_is_busy_and_not_active_until_its_turn() {
    let mut bench = Bench::standstill();
    let (mut first, mut second) = (MoveAbsolute::default(), MoveAbsolute::default());
    let mut course = Vec::new();
    for _ in 0..3000 {
        let outputs = bench.cycle(|axis| {
            let buffered = MoveAbsoluteInputs { buffer_mode: BufferMode::Buffered, ..to(true, 0.2) };
            [first.step(axis, &to(true, 0.1)), second.step(axis, &buffered)]
        });
        outputs.into_iter().for_each(exclusive);
        course.push((outputs, bench.axis.commanded()));
    }
    let done = course.iter().position(|([first, _], _)| first.done).unwrap();
    assert!(course[..done].iter().all(|([_, second], _)| second.busy && !second.active));
    assert!(course[done].0[1].active, "in the cycle in which the first is done");
    assert_eq!(course[done].1.x.to_bits(), 0.1_f64.to_bits());
    assert_eq!(course.last().unwrap().1.x.to_bits(), 0.2_f64.to_bits());
}

#[test]
fn stop_holds_the_axis_until_execute_falls() {
    let mut bench = Bench::standstill();
    let (mut go, mut stop) = (MoveVelocity::default(), Stop::default());
    let run = MoveVelocityInputs { execute: true, velocity: 0.5, ..MoveVelocityInputs::within(&LIMITS) };
    let halted = |execute| StopInputs { execute, ..StopInputs::within(&LIMITS) };
    for _ in 0..400 {
        bench.cycle(|axis| go.step(axis, &run));
    }
    assert_eq!(bench.axis.state(), AxisState::ContinuousMotion);
    let mut done = None;
    for cycle in 0..600 {
        let (_, stopped) = bench.cycle(|axis| (go.step(axis, &run), stop.step(axis, &halted(true))));
        assert_eq!(
            [stopped.done, stopped.busy, stopped.command_aborted, stopped.error].map(usize::from).iter().sum::<usize>(),
            1
        );
        assert_eq!(bench.axis.state(), AxisState::Stopping);
        if stopped.done && done.is_none() {
            done = Some(cycle);
        }
    }
    assert!(done.is_some_and(|cycle| cycle > 50), "{done:?}");
    assert!(!bench.cycle(|axis| go.step(axis, &MoveVelocityInputs { execute: false, ..run })).busy);
    let refused = bench.cycle(|axis| go.step(axis, &run));
    assert_eq!(refused.error_id, ErrorId::State);
    assert_eq!(
        go.error().unwrap().to_string(),
        "MC_MoveVelocity: the state of the axis, Stopping, does not allow it: wait for Done of MC_Stop and reset its Execute"
    );
    assert_eq!(bench.cycle(|axis| stop.step(axis, &halted(false))), StopOutputs::default());
    assert_eq!(bench.axis.state(), AxisState::Standstill);
}

/// Execute falls while the axis brakes, and rises again before standstill: a second edge of the same instance.
#[test]
fn a_stop_that_is_executed_again_while_it_brakes_holds_the_axis_again() {
    let mut bench = Bench::standstill();
    let (mut go, mut stop, mut other) = (MoveVelocity::default(), Stop::default(), Stop::default());
    let run = MoveVelocityInputs { execute: true, velocity: 0.5, ..MoveVelocityInputs::within(&LIMITS) };
    for _ in 0..400 {
        bench.cycle(|axis| go.step(axis, &run));
    }
    let stopping = |execute| StopInputs { execute, ..StopInputs::within(&LIMITS) };
    for execute in [true, true, false, true] {
        let outputs = bench.cycle(|axis| stop.step(axis, &stopping(execute)));
        assert!(outputs.busy && !outputs.error, "{execute} {outputs:?}");
    }
    assert_eq!(bench.cycle(|axis| other.step(axis, &stopping(true))).error_id, ErrorId::State, "another instance");
    let mut outputs = StopOutputs::default();
    for _ in 0..1000 {
        outputs = bench.cycle(|axis| stop.step(axis, &stopping(true)));
    }
    assert!(outputs.done);
    assert_eq!((bench.axis.state(), bench.axis.commanded().v.to_bits()), (AxisState::Stopping, 0));
    bench.cycle(|axis| stop.step(axis, &stopping(false)));
    assert_eq!(bench.axis.state(), AxisState::Standstill);
}

#[test]
fn halt_can_be_taken_over_on_the_way() {
    let mut bench = Bench::standstill();
    let (mut go, mut halt, mut back) = (MoveVelocity::default(), Halt::default(), MoveAbsolute::default());
    let run = MoveVelocityInputs { execute: true, velocity: 0.5, ..MoveVelocityInputs::within(&LIMITS) };
    for _ in 0..400 {
        bench.cycle(|axis| go.step(axis, &run));
    }
    let halting = HaltInputs { execute: true, ..HaltInputs::within(&LIMITS) };
    assert!(bench.cycle(|axis| halt.step(axis, &halting)).active);
    assert_eq!(bench.axis.state(), AxisState::DiscreteMotion);
    bench.cycle(|axis| back.step(axis, &to(true, 0.0)));
    assert!(bench.cycle(|axis| halt.step(axis, &halting)).command_aborted);
    bench.until(AxisState::Standstill);
    assert_eq!(bench.axis.commanded().x.to_bits(), 0.0_f64.to_bits());
}
