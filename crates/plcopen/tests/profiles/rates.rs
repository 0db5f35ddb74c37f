//! Tables of velocities and accelerations.
use crate::bench::{Bench, CYCLE_TIME};
use servobench_plcopen::{
    AccelerationProfile, AccelerationProfileInputs, AxisState, FunctionBlock, Pair, ProfileOutputs, VelocityProfile,
    VelocityProfileInputs,
};

fn pairs<const N: usize>(pairs: [(f64, f64); N]) -> [Pair; N] {
    pairs.map(|(delta_time, value)| Pair { delta_time, value })
}

/// Commanded velocities and positions from the cycle after the edge on, until the profile is completed.
fn followed(bench: &mut Bench, mut step: impl FnMut(&mut servobench_plcopen::Axis) -> ProfileOutputs) -> Vec<[f64; 2]> {
    let first = bench.cycle(&mut step);
    assert!(first.busy && first.active && !first.profile_completed);
    let mut way = Vec::new();
    loop {
        let outputs = bench.cycle(&mut step);
        let at = bench.axis.commanded();
        way.push([at.x, at.v]);
        assert!(!outputs.error && !outputs.command_aborted, "{outputs:?}");
        if outputs.profile_completed {
            assert!(!outputs.busy && !outputs.active);
            return way;
        }
        assert!(way.len() < 10_000);
    }
}

/// Oracle: areas by hand; scaled by 2 in time, 0.5 in velocity and moved by 0.1 m/s.
#[test]
fn velocities_go_in_straight_lines_and_the_last_one_is_kept() {
    let table = pairs([(0.05, 0.2), (0.1, 0.2), (0.05, -0.4)]);
    let inputs = VelocityProfileInputs {
        execute: true,
        time_scale: 2.0,
        velocity_scale: 0.5,
        offset: 0.1,
        ..VelocityProfileInputs::along(&table)
    };
    let (mut bench, mut block) = (Bench::standstill(), VelocityProfile::new([Pair::default(); 4]));
    let way = followed(&mut bench, |axis| block.step(axis, &inputs));
    // To 0.2 m/s in 0.1 s, that for 0.2 s, to −0.1 m/s in 0.1 s.
    assert_eq!(way.len(), 400);
    let exact = |t: f64| match t {
        t if t <= 0.1 => [t * t, 2.0 * t],
        t if t <= 0.3 => [0.01 + 0.2 * (t - 0.1), 0.2],
        _ => [0.05 + 0.2 * (t - 0.3) - 1.5 * (t - 0.3) * (t - 0.3), 0.2 - 3.0 * (t - 0.3)],
    };
    for (k, found) in way.iter().enumerate() {
        let expected = exact((k + 1) as f64 * CYCLE_TIME);
        assert!((0..2).all(|i| (found[i] - expected[i]).abs() < 1e-14), "{k}: {found:?} {expected:?}");
    }
    for _ in 0..100 {
        bench.cycle(|axis| block.step(axis, &inputs));
        assert_eq!(bench.axis.state(), AxisState::ContinuousMotion);
    }
    let at = bench.axis.commanded();
    assert!((at.v + 0.1).abs() < 1e-15 && (at.x - (0.055 - 0.01)).abs() < 1e-14 && at.a == 0.0, "{at:?}");
}

/// Oracle: areas by hand. The acceleration rises to 2 m/s² in 0.1 s, jumps to −1 m/s² after 0.1 s more, and is zero 0.1 s later.
#[test]
fn accelerations_go_in_straight_lines_and_end_at_zero() {
    let table = pairs([(0.1, 2.0), (0.1, 2.0), (0.0, -1.0), (0.1, -1.0)]);
    let inputs = AccelerationProfileInputs { execute: true, ..AccelerationProfileInputs::along(&table) };
    let (mut bench, mut block) = (Bench::standstill(), AccelerationProfile::new([Pair::default(); 4]));
    let way = followed(&mut bench, |axis| block.step(axis, &inputs));
    assert_eq!(way.len(), 300);
    let exact = |t: f64| match t {
        t if t <= 0.1 => [20.0 * t * t * t / 6.0, 10.0 * t * t],
        t if t <= 0.2 => [1.0 / 300.0 + 0.1 * (t - 0.1) + (t - 0.1) * (t - 0.1), 0.1 + 2.0 * (t - 0.1)],
        _ => [7.0 / 300.0 + 0.3 * (t - 0.2) - 0.5 * (t - 0.2) * (t - 0.2), 0.3 - (t - 0.2)],
    };
    for (k, found) in way.iter().enumerate() {
        let expected = exact((k + 1) as f64 * CYCLE_TIME);
        assert!((0..2).all(|i| (found[i] - expected[i]).abs() < 1e-14), "{k}: {found:?} {expected:?}");
    }
    bench.cycle(|axis| block.step(axis, &inputs));
    let at = bench.axis.commanded();
    assert!((at.v - 0.2).abs() < 1e-14 && at.a == 0.0, "{at:?}");
    assert_eq!(bench.axis.state(), AxisState::ContinuousMotion);
}

/// A first pair without time must match the initial velocity of the axis.
#[test]
fn a_first_pair_without_time_is_where_the_axis_must_be() {
    for (first, is_kept) in [(0.0, true), (0.5, false)] {
        let table = pairs([(0.0, first), (0.2, 0.5)]);
        let inputs = VelocityProfileInputs { execute: true, ..VelocityProfileInputs::along(&table) };
        let (mut bench, mut block) = (Bench::standstill(), VelocityProfile::new([Pair::default(); 4]));
        let outputs = bench.cycle(|axis| block.step(axis, &inputs));
        assert_eq!((outputs.active, outputs.error), (is_kept, !is_kept), "{first}");
        assert_eq!(bench.axis.state() == AxisState::Standstill, !is_kept);
    }
}
