//! Every arrow of the state diagram by its number, and every absent one.
#[path = "../shared/bench.rs"]
mod bench;
mod lead;

use bench::{Bench, CYCLE_TIME, LIMITS};
use lead::{execute, led_to};
use servobench_fieldbus::{Fault, Homing, Power};
use servobench_motion::pvt::Knot;
use servobench_plcopen::AxisState::{
    self, ContinuousMotion, Disabled, DiscreteMotion, ErrorStop, Homing as HomingState, Standstill, Stopping,
};
use servobench_plcopen::{
    ARROWS, AxisError, BlockName, Cause, ErrorId, FunctionBlock, MoveVelocity, MoveVelocityInputs, Pair,
    PositionProfile, PositionProfileInputs, Reset, ResetInputs, Stop, StopInputs, TimePosition,
};

const FAULT: Fault = Fault::Drive(0x7305);

#[test]
fn arrow_1_is_an_error_of_the_axis_in_any_state() {
    for state in ARROWS[0].from {
        let mut bench = led_to(*state);
        bench.feedback.fault = Some(FAULT);
        bench.cycle(|_| ());
        assert_eq!(bench.axis.state(), ErrorStop, "{state}");
        assert_eq!(bench.axis.error(), Some(&AxisError::DriveFault { fault: FAULT }));
    }
}

#[test]
fn arrow_1_is_a_loss_of_power_that_nobody_asked_for() {
    for state in [Standstill, HomingState, DiscreteMotion, ContinuousMotion, Stopping] {
        let mut bench = led_to(state);
        bench.feedback.power = Power::Off;
        bench.cycle(|_| ());
        assert_eq!(bench.axis.state(), ErrorStop, "{state}");
        assert_eq!(bench.axis.error(), Some(&AxisError::PowerLost { state }));
    }
}

#[test]
fn arrow_2_is_an_enable_that_falls() {
    for state in ARROWS[1].from {
        let mut bench = led_to(*state);
        bench.enable = false;
        bench.cycle(|_| ());
        assert_eq!(bench.axis.state(), Disabled, "{state}");
        assert!(!bench.command.unwrap().power);
        assert_eq!(bench.axis.error(), None);
    }
}

#[test]
fn an_error_outlasts_an_enable_that_falls() {
    let mut bench = led_to(ErrorStop);
    bench.enable = false;
    bench.cycle(|_| ());
    assert_eq!(bench.axis.state(), ErrorStop);
}

/// Removes the fault and resets.
fn reset(bench: &mut Bench) {
    let mut block = Reset::default();
    bench.feedback.fault = None;
    for _ in 0..1000 {
        if bench.cycle(|axis| block.step(axis, &ResetInputs { execute: true })).done {
            return;
        }
        assert!(bench.command.unwrap().reset || bench.axis.error().is_none());
    }
    panic!("no reset in {}", bench.axis.state());
}

#[test]
fn arrow_3_is_a_reset_without_power() {
    let mut bench = led_to(ErrorStop);
    bench.enable = false;
    bench.cycle(|_| ());
    bench.feedback.power = Power::Off;
    reset(&mut bench);
    assert_eq!((bench.axis.state(), bench.axis.error()), (Disabled, None));
}

#[test]
fn arrow_4_is_a_reset_with_power() {
    let mut bench = led_to(ErrorStop);
    bench.feedback.power = Power::On;
    reset(&mut bench);
    assert_eq!((bench.axis.state(), bench.axis.error()), (Standstill, None));
}

#[test]
fn a_reset_waits_for_the_fault_to_go_and_the_axis_to_stop() {
    let mut bench = led_to(ContinuousMotion);
    let velocity = bench.axis.commanded().v;
    assert!(velocity > 0.1);
    bench.feedback.fault = Some(FAULT);
    bench.cycle(|_| ());
    bench.feedback.power = Power::On;
    let mut block = Reset::default();
    for _ in 0..20 {
        assert!(bench.cycle(|axis| block.step(axis, &ResetInputs { execute: true })).busy);
        bench.feedback.power = Power::On;
    }
    bench.feedback.fault = None;
    let mut cycles = 0;
    while bench.cycle(|axis| block.step(axis, &ResetInputs { execute: true })).busy {
        cycles += 1;
        assert_eq!(bench.axis.state(), ErrorStop);
    }
    assert!(cycles > 10, "it brakes after the fault is gone: {cycles}");
    assert_eq!(bench.axis.commanded().v.to_bits(), 0.0_f64.to_bits());
}

#[test]
fn arrow_5_is_power_that_is_there() {
    let mut bench = Bench::disabled(Bench::params());
    bench.cycle(|_| ());
    assert_eq!(bench.axis.state(), Disabled);
    bench.enable = true;
    bench.cycle(|_| ());
    assert_eq!(bench.axis.state(), Disabled, "asked for, but not there yet");
    bench.cycle(|_| ());
    assert_eq!(bench.axis.state(), Standstill);
}

#[test]
fn arrow_6_is_a_stop_that_is_done_and_released() {
    let mut bench = led_to(ContinuousMotion);
    let mut stop = Stop::default();
    let inputs = |execute| StopInputs { execute, ..StopInputs::within(&LIMITS) };
    bench.cycle(|axis| stop.step(axis, &inputs(true)));
    let released = bench.cycle(|axis| stop.step(axis, &inputs(false)));
    assert!(released.busy);
    assert_eq!(bench.axis.state(), Stopping, "released, but not done");
    while bench.axis.state() == Stopping {
        bench.cycle(|axis| stop.step(axis, &inputs(false)));
    }
    assert_eq!((bench.axis.state(), bench.axis.commanded().v.to_bits()), (Standstill, 0));
}

#[test]
fn arrow_7_is_homing_at_standstill() {
    let mut bench = led_to(Standstill);
    assert_eq!(execute(&mut bench, BlockName::Home), Ok(()));
    assert_eq!(bench.axis.state(), HomingState);
}

#[test]
fn arrow_8_is_the_done_of_homing() {
    let mut bench = led_to(HomingState);
    bench.homing = Homing::Attained;
    bench.until(Standstill);
    assert!(bench.axis.is_homed());
}

#[test]
fn homing_that_fails_is_an_error_of_the_axis() {
    let mut bench = led_to(HomingState);
    bench.homing = Homing::Failed;
    bench.until(ErrorStop);
    assert_eq!(bench.axis.error(), Some(&AxisError::HomingFailed));
    assert!(!bench.axis.is_homed());
}

#[test]
fn arrow_8_is_the_done_of_a_discrete_motion() {
    led_to(DiscreteMotion).until(Standstill);
}

/// Oracle: the table of `execute`, 0.15 m and then 0.3 m, half a second each, from where the axis is.
#[test]
fn arrow_8_is_the_done_of_a_table_of_positions() {
    for state in [Standstill, DiscreteMotion, ContinuousMotion] {
        let (mut bench, mut block) = (led_to(state), profile());
        let from = bench.axis.commanded();
        let start = from.x + from.v * CYCLE_TIME;
        let pairs = [Pair { delta_time: 0.5, value: 0.15 }, Pair { delta_time: 0.5, value: 0.3 }];
        run(&mut bench, &mut block, &along(&pairs, 0.0), DiscreteMotion);
        assert_eq!(bench.axis.state(), Standstill, "after {state}");
        // The distance of the first cycle, by the acceleration of the axis.
        assert!((bench.axis.commanded().x - start - 0.3).abs() < LIMITS.acceleration * CYCLE_TIME * CYCLE_TIME);
        assert_eq!(execute(&mut bench, BlockName::Home), Ok(()), "after {state}");
    }
}

#[test]
fn arrow_15_is_the_done_of_a_table_of_positions_with_a_velocity() {
    let (mut bench, mut block) = (led_to(Standstill), profile());
    let pairs = [Pair { delta_time: 0.5, value: 0.1 }, Pair { delta_time: 0.5, value: 0.2 }];
    run(&mut bench, &mut block, &along(&pairs, 0.2), DiscreteMotion);
    assert_eq!(bench.axis.state(), ContinuousMotion);
    for _ in 0..100 {
        bench.cycle(|_| ());
    }
    assert!((bench.axis.commanded().v - 0.2).abs() < 1e-12);
    assert_eq!(execute(&mut bench, BlockName::Home), Err(ErrorId::State));
}

fn profile() -> PositionProfile<[Knot; 3], [f64; 3]> {
    PositionProfile::new([Knot::default(); 3], [0.0; 3])
}

fn along(pairs: &[Pair], end_velocity: f64) -> PositionProfileInputs<'_> {
    let time_position = TimePosition { pairs, is_absolute: false };
    PositionProfileInputs { execute: true, time_position, end_velocity, ..PositionProfileInputs::along(pairs) }
}

/// Runs until Done, in `state` all the time.
fn run(
    bench: &mut Bench,
    block: &mut PositionProfile<[Knot; 3], [f64; 3]>,
    inputs: &PositionProfileInputs<'_>,
    state: AxisState,
) {
    while !bench.cycle(|axis| block.step(axis, inputs)).done {
        assert_eq!((block.error(), bench.axis.state()), (None, state));
    }
}

#[test]
fn arrows_7_and_9_to_14_are_the_blocks() {
    for arrow in &ARROWS[6..14] {
        for (cause, state) in arrow.causes.iter().flat_map(|cause| arrow.from.iter().map(move |state| (cause, state))) {
            let Cause::Block(block) = cause else { continue };
            let mut bench = led_to(*state);
            assert_eq!(execute(&mut bench, *block), Ok(()), "{} in {state}", cause.name());
            assert_eq!(bench.axis.state(), arrow.to, "{} in {state}", cause.name());
        }
    }
}

#[test]
fn every_absent_arrow_is_refused() {
    let mut refusals = 0;
    for state in AxisState::ALL {
        for block in BlockName::ALL.iter().copied().filter(|block| block.is_command() || *block == BlockName::Reset) {
            let is_drawn =
                |cause| ARROWS.iter().any(|arrow| arrow.from.contains(&state) && arrow.causes.contains(&cause));
            if is_drawn(Cause::Block(block)) || (block == BlockName::Reset && is_drawn(Cause::ResetPowered)) {
                continue;
            }
            let mut bench = led_to(state);
            assert_eq!(execute(&mut bench, block), Err(ErrorId::State), "{block} in {state}");
            assert_eq!(bench.axis.state(), state, "{block}");
            refusals += 1;
        }
    }
    // 21 blocks in 7 states, less the 51 that the diagram draws.
    assert_eq!(refusals, 21 * 7 - 51);
}

/// While the drive searches for its reference, only MC_Stop and power off end the search.
#[test]
fn arrow_16_is_taken_from_steps_of_homing_but_not_from_a_search_of_the_drive() {
    for cause in ARROWS[15].causes {
        let Cause::Block(block) = *cause else { panic!("a block: {}", cause.name()) };
        let mut bench = led_to(Standstill);
        assert_eq!(execute(&mut bench, BlockName::StepBlock), Ok(()));
        assert_eq!(bench.axis.state(), HomingState);
        assert_eq!(execute(&mut bench, block), Ok(()), "{block}");
        assert_eq!(bench.axis.state(), HomingState, "{block}");
        let mut bench = led_to(HomingState);
        assert_eq!(execute(&mut bench, block), Err(ErrorId::State), "{block}");
    }
}

#[test]
fn a_motion_without_an_end_is_never_done() {
    let mut bench = led_to(Standstill);
    let mut go = MoveVelocity::default();
    let inputs = MoveVelocityInputs { execute: true, velocity: 0.3, ..MoveVelocityInputs::within(&LIMITS) };
    let mut reached = 0;
    for _ in 0..1000 {
        reached += usize::from(bench.cycle(|axis| go.step(axis, &inputs)).in_velocity);
    }
    assert_eq!(bench.axis.state(), ContinuousMotion);
    assert!(reached > 700, "{reached}");
}

#[test]
fn a_reset_waits_for_the_power_to_be_as_it_is_asked_for() {
    let mut bench = led_to(ErrorStop);
    bench.feedback.fault = None;
    bench.enable = false;
    let mut block = Reset::default();
    for _ in 0..5 {
        bench.feedback.power = Power::On;
        assert!(bench.cycle(|axis| block.step(axis, &ResetInputs { execute: true })).busy);
        assert_eq!(bench.axis.state(), ErrorStop);
    }
    bench.feedback.power = Power::Off;
    assert!(bench.cycle(|axis| block.step(axis, &ResetInputs { execute: true })).done);
    assert_eq!(bench.axis.state(), Disabled);
}

#[test]
fn a_reset_that_is_asked_for_again_is_an_edge_again() {
    let mut bench = led_to(ErrorStop);
    let mut signals = Vec::new();
    let mut block = Reset::default();
    for execute in [true, true, false, true, true] {
        bench.cycle(|axis| block.step(axis, &ResetInputs { execute }));
        signals.push(bench.command.unwrap().reset);
    }
    assert_eq!(signals, [true, true, true, false, true]);
}

#[test]
fn power_that_goes_while_the_axis_brakes_in_an_error_leaves_it_where_it_is() {
    let mut bench = led_to(ContinuousMotion);
    bench.feedback.fault = Some(FAULT);
    bench.cycle(|_| ());
    bench.feedback.power = Power::On;
    bench.cycle(|_| ());
    assert!(bench.axis.commanded().v > 0.0, "it brakes");
    (bench.feedback.power, bench.feedback.position) = (Power::Off, 0.7);
    bench.cycle(|_| ());
    let commanded = bench.axis.commanded();
    assert_eq!((commanded.x.to_bits(), commanded.v.to_bits()), (0.7_f64.to_bits(), 0));
}
