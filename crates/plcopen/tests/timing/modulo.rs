//! The ways round a modulo axis.
use crate::bench::{Bench, LIMITS};
use crate::calls::{running, to};
use servobench_plcopen::{
    AxisParams, AxisState, Direction, FunctionBlock, MoveAbsolute, MoveAbsoluteInputs, MoveRelative,
    MoveRelativeInputs, MoveVelocity,
};

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

/// Section 3.5 of the standard: where there is one way only, the input is ignored.
#[test]
fn a_direction_says_nothing_on_an_axis_with_ends() {
    for direction in [Direction::Positive, Direction::Negative, Direction::Shortest, Direction::Current] {
        let (mut bench, mut go) = (Bench::standstill(), MoveAbsolute::default());
        for position in [0.5, -0.25] {
            bench.cycle(|axis| go.step(axis, &MoveAbsoluteInputs { direction, ..to(position) }));
            assert_eq!(go.error(), None);
            bench.until(AxisState::Standstill);
            assert_eq!(bench.axis.commanded().x.to_bits(), position.to_bits(), "{direction:?}");
            bench.cycle(|axis| go.step(axis, &MoveAbsoluteInputs { execute: false, ..to(position) }));
        }
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
