//! An axis that follows the generator of order 4.
#![expect(clippy::float_cmp, reason = "what is shown is what is followed")]
#[path = "shared/bench.rs"]
mod bench;

use bench::{Bench, CYCLE_TIME, LIMITS};
use servobench_motion::{Order, Profile};
use servobench_plcopen::generator::Mounting;
use servobench_plcopen::{
    AxisState, BlockError, ErrorId, FunctionBlock, Halt, HaltInputs, Profile4th, Profile4thInputs, Profile4thOutputs,
    SetPosition, SetPositionInputs,
};

/// Settling time in cycles.
const SETTLING: usize = 50;
const SETTLING_TIME: f64 = SETTLING as f64 * CYCLE_TIME;

fn to(position: f64) -> Profile4thInputs {
    Profile4thInputs { enable: true, settling_time: SETTLING_TIME, ..Profile4thInputs::to(position, LIMITS) }
}

/// Runs `inputs` until Done: the outputs and the position of the axis in each cycle.
fn moved(bench: &mut Bench, block: &mut Profile4th, inputs: Profile4thInputs) -> Vec<(Profile4thOutputs, f64)> {
    let mut way = Vec::new();
    loop {
        let outputs = bench.cycle(|axis| block.step(axis, &inputs));
        assert!(!outputs.error && !outputs.command_aborted, "{:?}", block.error());
        way.push((outputs, bench.axis.commanded().x));
        if outputs.done && way.len() > 1 {
            return way;
        }
        assert!(way.len() < 10_000);
    }
}

/// Oracle: the samples of the plan, in the table of the generator: the first in the cycle after the edge but one, so that the last
/// is `duration` after that; the settling time from there on.
#[test]
fn a_move_ends_on_its_target_and_the_block_is_ready_when_it_has_settled() {
    let (mut bench, mut block) = (Bench::standstill(), Profile4th::default());
    let mut from = 0.0;
    for position in [0.3, 0.05, -0.4] {
        let way = moved(&mut bench, &mut block, to(position));
        let plan = Profile::plan_sampled(Order::Fourth, position - from, &LIMITS, CYCLE_TIME).unwrap();
        let samples = usize::try_from(plan.samples().unwrap().total()).unwrap();
        let active = way.iter().filter(|(outputs, _)| outputs.active).count();
        assert_eq!(active, samples + 2, "the edge, the start and the samples before the last");
        assert_eq!(way.len(), 2 + samples + SETTLING + 1, "{position}");
        assert!(way[..way.len() - 1].iter().all(|(outputs, _)| outputs.busy && !outputs.ready && !outputs.done));
        assert!(way.last().unwrap().0.ready && !way.last().unwrap().0.busy);
        assert!((way.last().unwrap().1 - position).abs() < 1e-15);
        assert!(way.iter().all(|(outputs, _)| !outputs.active || outputs.busy));
        assert_eq!(bench.axis.state(), AxisState::Standstill);
        from = position;
    }
    // Enable is TRUE all the time: nothing new, no new move.
    for _ in 0..100 {
        let outputs = bench.cycle(|axis| block.step(axis, &to(-0.4)));
        assert!(outputs.done && outputs.ready && !outputs.busy);
        assert_eq!(bench.axis.state(), AxisState::Standstill);
    }
}

/// Oracle: the plan of the order. Limits that the order does not use may have any value.
#[test]
fn a_lower_order_switches_a_lower_derivative() {
    for (number, order) in [(2.0, Order::Second), (3.0, Order::Third)] {
        let (mut bench, mut block) = (Bench::standstill(), Profile4th::default());
        let mut inputs = Profile4thInputs { order: number, ..to(0.3) };
        inputs.limits.snap = f64::NAN;
        let way = moved(&mut bench, &mut block, inputs);
        let plan = Profile::plan_sampled(order, 0.3, &LIMITS, CYCLE_TIME).unwrap();
        let samples = usize::try_from(plan.samples().unwrap().total()).unwrap();
        assert_eq!(way.iter().filter(|(outputs, _)| outputs.active).count(), samples + 2, "{order:?}");
        let largest =
            |of: fn(&Profile4thOutputs) -> f64| way.iter().map(|(outputs, _)| of(outputs).abs()).fold(0.0, f64::max);
        assert!((largest(|outputs| outputs.acceleration) / plan.peaks().acceleration - 1.0).abs() < 1e-9);
        assert_eq!(largest(|outputs| outputs.snap).to_bits(), 0.0_f64.to_bits());
        assert_eq!(largest(|outputs| outputs.jerk) > 0.0, order == Order::Third);
        assert!((way.last().unwrap().1 - 0.3).abs() < 1e-15);
    }
    for wrong in [1.0, 2.5, 5.0, f64::NAN] {
        let (mut bench, mut block) = (Bench::standstill(), Profile4th::default());
        let outputs = bench.cycle(|axis| block.step(axis, &Profile4thInputs { order: wrong, ..to(0.3) }));
        assert!(outputs.error && !outputs.active);
        let message = block.error().unwrap().to_string();
        assert_eq!(message, format!("Profile4th: `ProfileOrder` must be 2, 3 or 4, got {wrong}: correct the input"));
    }
}

/// The block shows the set-points of the axis in the cycle in which the axis gets them.
#[test]
fn the_block_shows_what_the_axis_follows() {
    let (mut bench, mut block) = (Bench::standstill(), Profile4th::default());
    let way = moved(&mut bench, &mut block, to(0.3));
    for (outputs, position) in way.iter().filter(|(outputs, _)| outputs.active) {
        assert_eq!(outputs.position.to_bits(), position.to_bits());
    }
    assert!(way.iter().any(|(outputs, _)| outputs.velocity > 0.0 && outputs.snap != 0.0 && outputs.added == 0.3));
    let (last, _) = way.last().unwrap();
    assert_eq!([last.velocity, last.acceleration, last.jerk, last.snap], [0.0; 4]);
}

#[test]
fn an_axis_mounted_the_other_way_round_goes_the_other_way() {
    let (mut bench, mut block) = (Bench::disabled(Bench::params()), Profile4th::default());
    bench.enable = true;
    bench.until(AxisState::Standstill);
    let inputs = Profile4thInputs { mounting: Mounting::Opposite, ..to(0.2) };
    assert!((moved(&mut bench, &mut block, inputs).last().unwrap().1 + 0.2).abs() < 1e-15);
}

#[test]
fn another_command_takes_the_axis_and_the_block_says_so_until_enable_falls() {
    let (mut bench, mut block, mut halt) = (Bench::standstill(), Profile4th::default(), Halt::default());
    for _ in 0..300 {
        assert!(bench.cycle(|axis| block.step(axis, &to(0.5))).active || bench.axis.state() == AxisState::Standstill);
    }
    assert_eq!(bench.axis.state(), AxisState::DiscreteMotion);
    let before = bench.axis.commanded();
    let inputs = HaltInputs { execute: true, ..HaltInputs::within(&LIMITS) };
    bench.cycle(|axis| (halt.step(axis, &inputs), block.step(axis, &to(0.5))));
    assert!((bench.axis.commanded().v - before.v).abs() <= LIMITS.acceleration * CYCLE_TIME * 1.001);
    while bench.axis.state() != AxisState::Standstill {
        let outputs = bench.cycle(|axis| block.step(axis, &to(0.5)));
        assert!(outputs.command_aborted && !outputs.busy && !outputs.active);
    }
    // The block does not take the axis back, except at a rise of Enable.
    assert!(bench.cycle(|axis| block.step(axis, &to(0.5))).command_aborted);
    assert!(!bench.cycle(|axis| block.step(axis, &Profile4thInputs { enable: false, ..to(0.5) })).command_aborted);
    assert!((moved(&mut bench, &mut block, to(0.5)).last().unwrap().1 - 0.5).abs() < 1e-15);
}

/// MC_SetPosition moves nothing, at any time: the axis covers the commanded distance.
#[test]
fn a_shifted_coordinate_leaves_the_move_as_it_is() {
    for shifted in [0, 1, 2, 100] {
        let (mut bench, mut block, mut set) = (Bench::standstill(), Profile4th::default(), SetPosition::default());
        let mut cycle = 0;
        let done = |bench: &mut Bench, block: &mut Profile4th, set: &mut SetPosition, cycle: i32| {
            let inputs = SetPositionInputs { execute: cycle == shifted, position: 1.0, relative: true };
            bench.cycle(|axis| {
                let outputs = block.step(axis, &to(0.3));
                set.step(axis, &inputs);
                assert!(!outputs.error, "{shifted} {cycle}: {:?} {:?}", block.error(), axis.error());
                outputs.done
            })
        };
        while !done(&mut bench, &mut block, &mut set, cycle) {
            cycle += 1;
        }
        // Before the start the target is one of the new coordinate, in which the axis stands at 1 m.
        let expected = if shifted == 0 { 0.3 } else { 1.3 };
        assert!((bench.axis.commanded().x - expected).abs() < 1e-12, "{shifted}: {:?}", bench.axis.commanded());
    }
}

#[test]
fn what_the_axis_may_not_do_is_refused_at_the_edge() {
    let faster = servobench_motion::Limits { velocity: 2.0, ..LIMITS };
    for (inputs, id) in [
        (Profile4thInputs { limits: faster, ..to(0.5) }, ErrorId::AboveLimit),
        (Profile4thInputs { settling_time: -1.0, ..to(0.5) }, ErrorId::Input),
    ] {
        let (mut bench, mut block) = (Bench::standstill(), Profile4th::default());
        for _ in 0..10 {
            let outputs = bench.cycle(|axis| block.step(axis, &inputs));
            assert!(outputs.error && !outputs.busy && !outputs.ready);
            assert_eq!((outputs.error_id, block.error().map(BlockError::id)), (id, Some(id)));
            assert_eq!(bench.axis.state(), AxisState::Standstill);
        }
    }
    // A refusal of the plan comes a cycle later, and leaves the axis where it is.
    let (mut bench, mut block) = (Bench::standstill(), Profile4th::default());
    bench.cycle(|axis| block.step(axis, &to(f64::NAN)));
    let outputs = bench.cycle(|axis| block.step(axis, &to(f64::NAN)));
    assert_eq!((outputs.error_id, bench.axis.state()), (ErrorId::Plan, AxisState::Standstill));
    assert_eq!(bench.axis.commanded().x.to_bits(), 0.0_f64.to_bits());
}
