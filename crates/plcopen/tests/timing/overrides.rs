//! MC_SetOverride: slower, and on again.
use crate::bench::{Bench, LIMITS};
use crate::calls::{at, to};
use servobench_plcopen::{AxisState, ErrorId, FunctionBlock, MoveAbsolute, SetOverride, SetOverrideInputs};

#[test]
fn a_lower_acceleration_factor_is_for_braking_too() {
    let mut bench = Bench::standstill();
    let (mut go, mut slow) = (MoveAbsolute::default(), SetOverride::default());
    let mut last = 0.0;
    for _ in 0..4000 {
        bench.cycle(|axis| {
            slow.step(axis, &SetOverrideInputs { enable: true, acc_factor: 0.5, ..SetOverrideInputs::default() });
            go.step(axis, &to(1.0));
        });
        let v = bench.axis.commanded().v;
        assert!((v - last).abs() <= 0.5 * LIMITS.acceleration * 1e-3 * (1.0 + 1e-9));
        last = v;
    }
    at(&bench, 1.0);
}

#[test]
fn an_override_holds_the_axis_and_lets_it_go_on() {
    let mut bench = Bench::standstill();
    let (mut go, mut slow) = (MoveAbsolute::default(), SetOverride::default());
    let (mut last, mut held) = (bench.axis.commanded(), 0);
    for cycle in 0..8000 {
        let vel_factor = match cycle {
            0..300 => 1.0,
            300..1000 => 0.25,
            1000..2000 => 0.0,
            _ => 0.5,
        };
        let done = bench.cycle(|axis| {
            let inputs = SetOverrideInputs { enable: true, vel_factor, ..SetOverrideInputs::default() };
            assert!(slow.step(axis, &inputs).enabled);
            go.step(axis, &to(1.0)).done
        });
        let now = bench.axis.commanded();
        // A cycle of jerk and of snap at their limits; the margin is rounding.
        assert!((now.a - last.a).abs() <= LIMITS.jerk * 1e-3 * (1.0 + 1e-9), "cycle {cycle}");
        assert!((now.j - last.j).abs() <= LIMITS.snap * 1e-3 * (1.0 + 1e-9), "cycle {cycle}");
        held += usize::from(now.v.abs() < 1e-12 && bench.axis.state() == AxisState::DiscreteMotion);
        if (700..1000).contains(&cycle) {
            assert!((now.v - 0.25).abs() < 1e-12);
        }
        last = now;
        if done {
            assert!(held > 500, "{held}");
            return at(&bench, 1.0);
        }
    }
    panic!("never done");
}

#[test]
fn factors_outside_their_range_are_refused() {
    let mut bench = Bench::standstill();
    let mut slow = SetOverride::default();
    let inputs = SetOverrideInputs { enable: true, acc_factor: 0.0, ..SetOverrideInputs::default() };
    assert_eq!(bench.cycle(|axis| slow.step(axis, &inputs)).error_id, ErrorId::Input);
    let message = slow.error().unwrap().to_string();
    assert_eq!(message, "MC_SetOverride: `AccFactor` must be from 1e-6 to 1, got 0: correct the input");
}

/// A block with Enable continues after an error: section 2.2.3.
#[test]
fn an_override_that_is_refused_acts_again_once_it_is_corrected() {
    let (mut bench, mut slow) = (Bench::standstill(), SetOverride::default());
    for acc_factor in [1.0, 0.0, 0.5] {
        let inputs = SetOverrideInputs { enable: true, acc_factor, ..SetOverrideInputs::default() };
        let outputs = bench.cycle(|axis| slow.step(axis, &inputs));
        let is_wrong = acc_factor == 0.0;
        assert!(outputs.busy && outputs.error == is_wrong && outputs.enabled != is_wrong, "{outputs:?}");
    }
}
