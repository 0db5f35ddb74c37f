//! Commands repeated on their way, and overrides before a target is passed.
use crate::bench::{Bench, CYCLE_TIME, LIMITS};
use servobench_motion::Limits;
use servobench_plcopen::{
    AxisParams, FunctionBlock, MoveAbsolute, MoveAbsoluteInputs, MoveContinuousAbsolute, MoveContinuousAbsoluteInputs,
    SetOverride, SetOverrideInputs,
};
use servobench_testkit::Random;

/// Size of a random sweep: `SERVOBENCH_SWEEP`, or `usual`.
fn sweep_size(usual: usize) -> usize {
    std::env::var("SERVOBENCH_SWEEP").map_or(usual, |size| size.parse().expect("SERVOBENCH_SWEEP is a whole number"))
}

/// Part of the velocity limit below which a velocity is rounding.
const ROUNDING: f64 = 1e-9;

/// An axis of order 2, 3 or 4 with limits by which it covers a few tenths of a metre in about a second.
fn axis(random: &mut Random) -> (Bench, Limits) {
    let mut around = |value: f64| value * random.decades(-0.3, 0.3);
    let mut limits = Limits {
        velocity: around(LIMITS.velocity),
        acceleration: around(LIMITS.acceleration),
        jerk: around(LIMITS.jerk),
        snap: around(LIMITS.snap),
    };
    let order = random.unit();
    if order < 0.67 {
        limits.snap = f64::INFINITY;
    }
    if order < 0.33 {
        limits.jerk = f64::INFINITY;
    }
    let params = AxisParams { limits, ..Bench::params() };
    (Bench::powered(params), limits)
}

/// Move to a position that is passed at a velocity that the axis can reach from rest on the way.
fn passing(random: &mut Random, limits: &Limits) -> MoveContinuousAbsoluteInputs {
    let sign = random.signed().signum();
    let mut inputs = MoveContinuousAbsoluteInputs::within(limits);
    inputs.deceleration *= random.decades(-0.3, 0.0);
    inputs.position = sign * random.decades(-1.5, 0.0);
    // v²/a, and the time in which the acceleration rises, which is 0.3 s at most.
    let room = inputs.position.abs();
    let fastest = (0.3 * limits.acceleration * room).sqrt().min(2.0 * room).min(inputs.velocity);
    inputs.end_velocity = sign * fastest * (0.05 + 0.95 * random.unit());
    MoveContinuousAbsoluteInputs { execute: true, ..inputs }
}

/// Repeated by new instances while they brake.
#[test]
fn a_move_repeated_on_its_way_passes_its_target_when_it_would_have() {
    let mut random = Random::seeded(10);
    for k in 0..sweep_size(60) {
        let (bench, limits) = axis(&mut random);
        let inputs = passing(&mut random, &limits);
        let every = 1 + k % 4;
        let sign = inputs.position.signum();
        let mut arrived = [None; 2];
        for (repeats, arrived) in [0, 300].into_iter().zip(&mut arrived) {
            let mut bench = bench_of(&bench);
            let mut blocks = vec![MoveContinuousAbsolute::default()];
            for cycle in 0..20_000 {
                let now = bench.axis.commanded();
                // In the cycle in which it is passed it is not ahead any more.
                let is_ahead = sign * (inputs.position - now.x) > 2.0 * CYCLE_TIME * now.v.abs();
                if cycle > 0 && cycle % every == 0 && blocks.len() <= repeats && is_ahead {
                    blocks.push(MoveContinuousAbsolute::default());
                }
                let last = blocks.len() - 1;
                let outputs = bench.cycle(|axis| blocks[last].step(axis, &inputs));
                assert!(!outputs.error, "{k}: {:?}", blocks[last].error());
                let now = bench.axis.commanded();
                assert!(
                    sign * now.v >= -ROUNDING * limits.velocity,
                    "{k}, cycle {cycle}: {now:?} {inputs:?} {limits:?}"
                );
                if outputs.in_end_velocity {
                    *arrived = Some(cycle);
                    break;
                }
            }
        }
        assert!(arrived[0].is_some() && arrived[0] == arrived[1], "{k}: {arrived:?} {inputs:?} {limits:?}");
    }
}

/// The same to rest.
#[test]
fn a_move_to_rest_repeated_on_its_way_is_done_when_it_would_have_been() {
    let mut random = Random::seeded(11);
    for k in 0..sweep_size(30) {
        let (bench, limits) = axis(&mut random);
        let position = random.signed();
        let inputs = MoveAbsoluteInputs { execute: true, position, ..MoveAbsoluteInputs::within(&limits) };
        let mut done = [None; 2];
        for (is_repeated, done) in [false, true].into_iter().zip(&mut done) {
            let (mut bench, mut block) = (bench_of(&bench), MoveAbsolute::default());
            for cycle in 0..20_000 {
                if is_repeated && cycle % 7 == 0 {
                    block = MoveAbsolute::default();
                }
                let outputs = bench.cycle(|axis| block.step(axis, &inputs));
                assert!(!outputs.error, "{k}");
                if outputs.done {
                    *done = Some(cycle);
                    break;
                }
            }
        }
        // One that is repeated in the cycle in which the other is done is done a cycle later.
        let later = done[1].zip(done[0]).map(|(repeated, once): (i32, i32)| repeated - once);
        assert!(later.is_some_and(|later| (0..=1).contains(&later)), "{k}: {done:?}");
    }
}

/// Its velocity at the target may be out of reach.
#[test]
fn an_override_before_a_target_is_passed_never_turns_the_axis_round() {
    let mut random = Random::seeded(12);
    for k in 0..sweep_size(100) {
        let (mut bench, limits) = axis(&mut random);
        let inputs = passing(&mut random, &limits);
        let sign = inputs.position.signum();
        let (mut pass, mut slow) = (MoveContinuousAbsolute::default(), SetOverride::default());
        let often = 1.0 / (1.0 + 300.0 * random.unit());
        let (mut vel_factor, mut is_there) = (1.0, false);
        for cycle in 0..40_000 {
            let is_before = sign * (inputs.position - bench.axis.commanded().x) > 0.0;
            if is_before && random.unit() < often {
                vel_factor = random.decades(-1.5, 0.0);
            }
            let overriding = SetOverrideInputs { enable: true, vel_factor, ..SetOverrideInputs::default() };
            let (outputs, slowed) = bench.cycle(|axis| (pass.step(axis, &inputs), slow.step(axis, &overriding)));
            assert!(!outputs.error && !slowed.error, "{k}");
            let now = bench.axis.commanded();
            assert!(sign * now.v >= -ROUNDING * limits.velocity, "{k}, cycle {cycle}: {now:?} {inputs:?} {limits:?}");
            if outputs.in_end_velocity && !is_before {
                assert!((now.v - vel_factor * inputs.end_velocity).abs() < ROUNDING * limits.velocity, "{k}: {now:?}");
                // At the position or behind it.
                assert!(sign * (now.x - inputs.position) >= -now.v.abs() * CYCLE_TIME, "{k}: {now:?}");
                is_there = true;
                break;
            }
        }
        assert!(is_there, "{k}: {inputs:?} {limits:?}");
    }
}

/// A move that has passed its target on the way to its velocity is not led back to it by another override.
#[test]
fn an_override_behind_the_target_changes_the_velocity_alone() {
    let mut bench = Bench::standstill();
    let (mut pass, mut slow) = (MoveContinuousAbsolute::default(), SetOverride::default());
    let inputs = MoveContinuousAbsoluteInputs {
        execute: true,
        position: 0.5,
        end_velocity: 0.9,
        ..MoveContinuousAbsoluteInputs::within(&LIMITS)
    };
    let (mut vel_factor, mut cycles_behind) = (1.0, 0);
    for _ in 0..6_000 {
        let x = bench.axis.commanded().x;
        if x > 0.48 && cycles_behind == 0 {
            vel_factor = 0.1;
        }
        cycles_behind += usize::from(x > 0.5);
        if cycles_behind == 5 {
            vel_factor = 0.2;
        }
        let overriding = SetOverrideInputs { enable: true, vel_factor, ..SetOverrideInputs::default() };
        let outputs = bench.cycle(|axis| {
            slow.step(axis, &overriding);
            pass.step(axis, &inputs)
        });
        assert!(bench.axis.commanded().v >= 0.0, "{:?}", bench.axis.commanded());
        if outputs.in_end_velocity && cycles_behind > 5 {
            assert!((bench.axis.commanded().v - 0.18).abs() < 1e-12);
            return;
        }
    }
    panic!("never at its velocity");
}

/// The same axis at Standstill once more.
fn bench_of(bench: &Bench) -> Bench {
    Bench::powered(*bench.axis.params())
}
