//! Rockwell's axis move.
use crate::bench::{Bench, CYCLE_TIME};
use servobench_motion::Limits;
use servobench_motion::rockwell::{Jerk, MaximumJerk, Move, Shape, ShapeKind};
use servobench_plcopen::{
    AxisMove, AxisMoveInputs, AxisMoveOutputs, AxisParams, AxisState, FunctionBlock, Halt, HaltInputs, MoveType,
};

const LIMITS: Limits = Limits { velocity: 1.0, acceleration: 200.0, jerk: 1e9, snap: f64::INFINITY };

fn bench() -> Bench {
    Bench::powered(AxisParams { limits: LIMITS, ..Bench::params() })
}

/// The move of the printed examples: 100 mm at 200 mm/s with 100 m/s².
fn printed(shape: ShapeKind) -> AxisMoveInputs {
    AxisMoveInputs { execute: true, velocity: 0.2, acceleration: 100.0, shape, ..AxisMoveInputs::to(0.1, &LIMITS) }
}

/// Set-points and outputs from the cycle of the edge to that of PC.
fn run(bench: &mut Bench, block: &mut AxisMove, inputs: &AxisMoveInputs) -> Vec<f64> {
    let mut all = Vec::new();
    loop {
        let outputs = bench.cycle(|axis| block.step(axis, inputs));
        assert!(!outputs.failed, "{:?}", block.error());
        all.push(bench.axis.commanded().x);
        let is_over = outputs.complete;
        let expected = AxisMoveOutputs {
            enabled: true,
            begun: true,
            in_process: !is_over,
            active: !is_over,
            complete: is_over,
            ..AxisMoveOutputs::default()
        };
        assert_eq!(outputs, expected, "{}", all.len());
        if is_over {
            return all;
        }
    }
}

/// Ways to give the jerks of acceleration and deceleration: value, part of the time, part of the axis's limit, time.
type Said = [Option<f64>; 4];

/// The printed examples and other ways to give the jerk, in an absolute move, and back by an incremental one.
///
/// Oracle: the generator of `servobench-motion`, whose tests compare it with the printed times and jerks.
#[test]
fn the_axis_follows_the_move_of_the_operands() {
    let none: Said = [None; 4];
    let cases: [(ShapeKind, Said, Said, Shape); 7] = [
        (ShapeKind::Trapezoid, none, none, Shape::Trapezoid),
        (ShapeKind::SCurve, none, none, both(Jerk::PercentOfTime(100.0))),
        (ShapeKind::SCurve, [None, Some(0.25), None, None], none, both(Jerk::PercentOfTime(25.0))),
        (ShapeKind::SCurve, [Some(5e4), None, None, None], none, both(Jerk::Value(5e4))),
        (ShapeKind::SCurve, [None, None, Some(0.0001), None], none, both(Jerk::PercentOfMaximum(0.01))),
        (ShapeKind::SCurve, [None, None, None, Some(0.0013)], none, both(Jerk::Time(0.0013))),
        (
            ShapeKind::SCurve,
            none,
            [None, None, None, Some(0.001)],
            Shape::SCurve { acceleration: Jerk::PercentOfTime(100.0), deceleration: Jerk::Time(0.001) },
        ),
    ];
    for (shape, up, down, expected) in cases {
        let (mut bench, mut block) = (bench(), AxisMove::default());
        let [jerk, jerk_of_time, jerk_of_maximum, jerk_time] = up;
        let [deceleration_jerk, deceleration_jerk_of_time, deceleration_jerk_of_maximum, deceleration_jerk_time] = down;
        let to = AxisMoveInputs {
            deceleration: 80.0,
            jerk,
            jerk_of_time,
            jerk_of_maximum,
            jerk_time,
            deceleration_jerk,
            deceleration_jerk_of_time,
            deceleration_jerk_of_maximum,
            deceleration_jerk_time,
            ..printed(shape)
        };
        let asked = Move { distance: 0.1, speed: 0.2, acceleration: 100.0, deceleration: 80.0, shape: expected };
        let maximum = MaximumJerk { acceleration: LIMITS.jerk, deceleration: LIMITS.jerk };
        let trajectory = asked.plan(&maximum).unwrap();
        let there = run(&mut bench, &mut block, &to);
        let cycles = (trajectory.duration() / CYCLE_TIME - 1e-9).ceil();
        assert!((there.len() as f64 - cycles - 1.0).abs() < 1e-9, "{expected:?}: {cycles}");
        for (k, x) in there.iter().enumerate() {
            let exact = trajectory.at(k as f64 * CYCLE_TIME).x;
            assert!((x - exact).abs() < 1e-14, "{expected:?} {k}: {x} {exact}");
        }
        assert_eq!(there[there.len() - 1].to_bits(), 0.1_f64.to_bits(), "{expected:?}");
        assert_eq!(bench.axis.state(), AxisState::Standstill);
        // DN and PC stay, EN falls with Execute.
        let off = AxisMoveInputs { execute: false, ..to };
        for _ in 0..3 {
            let outputs = bench.cycle(|axis| block.step(axis, &off));
            let stays = AxisMoveOutputs { begun: true, complete: true, ..AxisMoveOutputs::default() };
            assert_eq!(outputs, stays);
        }
        let back = AxisMoveInputs { move_type: MoveType::Incremental, position: -0.04, ..to };
        let way = run(&mut bench, &mut block, &back);
        assert!((way[way.len() - 1] - 0.06).abs() < 1e-15, "{expected:?}");
    }
}

fn both(jerk: Jerk) -> Shape {
    Shape::SCurve { acceleration: jerk, deceleration: jerk }
}

#[test]
fn what_it_refuses_is_named() {
    let s_curve = printed(ShapeKind::SCurve);
    for (inputs, said) in [
        (AxisMoveInputs { velocity: 1.5, ..s_curve }, "MAM: `Speed` must be at most 1, the limit of the axis, got 1.5"),
        (AxisMoveInputs { deceleration: 300.0, ..s_curve }, "MAM: `DecelRate` must be at most 200"),
        (AxisMoveInputs { position: f64::NAN, ..s_curve }, "MAM: "),
        (AxisMoveInputs { velocity: 0.0, ..s_curve }, "MAM: "),
        (AxisMoveInputs { jerk_of_time: Some(1.5), ..s_curve }, "MAM: `jerk_percent_of_time` must be above 0 %"),
        (AxisMoveInputs { jerk_time: Some(-1.0), ..s_curve }, "MAM: "),
        (
            AxisMoveInputs { jerk: Some(1.0), jerk_time: Some(1.0), ..s_curve },
            "MAM: `AccelJerk` must be given in one form",
        ),
        (
            AxisMoveInputs { jerk_time: Some(1.0), ..printed(ShapeKind::Trapezoid) },
            "MAM: `AccelJerk` must be left out with the profile \"trapezoid\"",
        ),
        (AxisMoveInputs { jerk: Some(2e9), ..s_curve }, "MAM: `jerk of the profile` must be at most 1000000000"),
    ] {
        let (mut bench, mut block) = (bench(), AxisMove::default());
        let outputs = bench.cycle(|axis| block.step(axis, &inputs));
        assert!(outputs.failed && !outputs.begun && !outputs.in_process && !outputs.complete, "{inputs:?}");
        let told = block.error().unwrap().to_string();
        assert!(told.starts_with(said), "{told}");
        assert_eq!(bench.axis.state(), AxisState::Standstill);
        // ER falls when Execute rises again.
        bench.cycle(|axis| block.step(axis, &AxisMoveInputs { execute: false, ..inputs }));
        assert!(bench.cycle(|axis| block.step(axis, &s_curve)).begun);
    }
    let params = AxisParams { limits: Limits { jerk: f64::INFINITY, ..LIMITS }, ..Bench::params() };
    let (mut bench, mut block) = (Bench::powered(params), AxisMove::default());
    assert!(bench.cycle(|axis| block.step(axis, &printed(ShapeKind::Trapezoid))).failed);
    let told = block.error().unwrap().to_string();
    assert!(told.contains("an axis without a limit of jerk"), "{told}");
}

/// The block begins at Standstill only; a command that takes over the axis leaves neither PC nor ER.
#[test]
fn it_begins_at_standstill_and_can_be_aborted() {
    let (mut bench, mut block, mut other, mut halt) =
        (bench(), AxisMove::default(), AxisMove::default(), Halt::default());
    let inputs = printed(ShapeKind::SCurve);
    for k in 0..600 {
        let outputs = bench.cycle(|axis| {
            let outputs = block.step(axis, &inputs);
            let refused = other.step(axis, &AxisMoveInputs { execute: k == 100, ..inputs });
            assert_eq!((refused.failed, refused.begun), (k >= 100, false), "{k}");
            halt.step(axis, &HaltInputs { execute: k > 200, ..HaltInputs::within(&LIMITS) });
            outputs
        });
        assert_eq!(outputs.in_process, k <= 201, "{k} {outputs:?}");
        assert!(outputs.begun && !outputs.failed && !outputs.complete, "{k} {outputs:?}");
    }
    assert_eq!(bench.axis.state(), AxisState::Standstill);
}
