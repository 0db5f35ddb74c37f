//! Tables of positions.
use crate::bench::{Bench, CYCLE_TIME};
use servobench_motion::pvt::Knot;
use servobench_plcopen::{
    AxisParams, AxisState, Follow, FunctionBlock, MoveVelocity, MoveVelocityInputs, Pair, PositionProfile,
    PositionProfileInputs, TimePosition,
};

const PAIRS: [Pair; 4] = [
    Pair { delta_time: 0.5, value: 0.1 },
    Pair { delta_time: 0.3, value: 0.2 },
    Pair { delta_time: 0.4, value: 0.15 },
    Pair { delta_time: 0.6, value: 0.3 },
];
const FOLLOWED: [Follow; 3] = [Follow::Plateaus(Some(0.3)), Follow::Plateaus(Some(0.5)), Follow::Spline];

/// Time from the edge (s) and position of each pair.
fn points(time_scale: f64, place: impl Fn(f64) -> f64) -> Vec<(f64, f64)> {
    let mut t = 0.0;
    let point = |pair: &Pair| {
        t += time_scale * pair.delta_time;
        (t, place(pair.value))
    };
    PAIRS.iter().map(point).collect()
}

/// Every position is met at its time; from cycle to cycle the limits of the axis are kept (the bench checks that).
#[test]
fn each_position_is_met_at_its_time() {
    for follow in FOLLOWED {
        for is_absolute in [true, false] {
            let mut bench = Bench::disabled(Bench::params());
            (bench.feedback.position, bench.enable) = (0.07, true);
            bench.until(AxisState::Standstill);
            let mut block = PositionProfile::new([Knot::default(); 5], [0.0; 5]);
            let start = if is_absolute { 0.0 } else { 0.07 };
            let inputs = PositionProfileInputs {
                execute: true,
                time_position: TimePosition { pairs: &PAIRS, is_absolute },
                time_scale: 2.0,
                position_scale: -0.5,
                offset: 0.02,
                follow,
                ..PositionProfileInputs::along(&PAIRS)
            };
            let points = points(2.0, |value| start - 0.5 * value + 0.02);
            let mut met = 0;
            for k in 0.. {
                let outputs = bench.cycle(|axis| block.step(axis, &inputs));
                let (at, t) = (bench.axis.commanded(), f64::from(k) * CYCLE_TIME);
                if let Some((_, x)) = points.iter().find(|point| (point.0 - t).abs() < 1e-9) {
                    assert!((at.x - x).abs() < 1e-13, "{follow:?} {t} s: {} {x}", at.x);
                    met += 1;
                }
                let is_over = met == points.len();
                assert_eq!(
                    (outputs.done, outputs.busy, outputs.error),
                    (is_over, !is_over, false),
                    "{k} {:?}",
                    block.error()
                );
                if is_over {
                    break;
                }
            }
            let at = bench.axis.commanded();
            let end = points[points.len() - 1].1;
            assert!((at.x - end).abs() < 1e-15 && at.v.to_bits() == 0 && at.a.to_bits() == 0, "{at:?} {end}");
            assert_eq!(bench.axis.state(), AxisState::Standstill);
        }
    }
}

/// The profile begins at the velocity of the axis and ends at the commanded one, without jumps of the velocity.
#[test]
fn it_begins_with_the_velocity_of_the_axis_and_ends_with_the_one_asked_for() {
    for follow in FOLLOWED {
        let mut bench = Bench::standstill();
        let limits = crate::bench::LIMITS;
        let mut run = MoveVelocity::default();
        let inputs = MoveVelocityInputs { execute: true, velocity: 0.2, ..MoveVelocityInputs::within(&limits) };
        while !bench.cycle(|axis| run.step(axis, &inputs)).in_velocity {}
        let mut block = PositionProfile::new([Knot::default(); 5], [0.0; 5]);
        let inputs = PositionProfileInputs {
            execute: true,
            time_position: TimePosition { pairs: &PAIRS, is_absolute: false },
            follow,
            end_velocity: 0.25,
            ..PositionProfileInputs::along(&PAIRS)
        };
        let mut before = bench.axis.commanded();
        let start = before.x + 0.2 * CYCLE_TIME;
        loop {
            let outputs = bench.cycle(|axis| block.step(axis, &inputs));
            let at = bench.axis.commanded();
            assert!(!outputs.error, "{:?}", block.error());
            assert!((at.v - before.v).abs() <= limits.acceleration * CYCLE_TIME * (1.0 + 1e-9), "{before:?} {at:?}");
            before = at;
            if outputs.done {
                break;
            }
        }
        assert!((before.v - 0.25).abs() < 1e-13 && (before.x - start - 0.3).abs() < 1e-12, "{before:?} {start}");
        bench.cycle(|axis| block.step(axis, &inputs));
        let at = bench.axis.commanded();
        assert!((at.x - before.x - 0.25 * CYCLE_TIME).abs() < 1e-14, "{at:?}");
        assert_eq!(bench.axis.state(), AxisState::ContinuousMotion);
    }
}

#[test]
fn an_absolute_table_needs_a_reference() {
    let mut bench = Bench::powered(AxisParams { needs_homing: true, ..Bench::params() });
    let mut block = PositionProfile::new([Knot::default(); 5], [0.0; 5]);
    let inputs = PositionProfileInputs { execute: true, ..PositionProfileInputs::along(&PAIRS) };
    assert!(bench.cycle(|axis| block.step(axis, &inputs)).error);
    let refused = block.error().unwrap().to_string();
    assert!(refused.starts_with("MC_PositionProfile: `Position` 0.1 has no meaning"), "{refused}");
    let relative = TimePosition { pairs: &PAIRS, is_absolute: false };
    bench.cycle(|axis| block.step(axis, &PositionProfileInputs { execute: false, ..inputs }));
    let inputs = PositionProfileInputs { time_position: relative, ..inputs };
    assert!(bench.cycle(|axis| block.step(axis, &inputs)).active);
}
