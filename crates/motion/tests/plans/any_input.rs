//! Any bit pattern as input: an answer or a refusal, never a panic, never a set-point that is no number.
use proptest::prelude::*;
use servobench_motion::{Limits, Order, Profile};

/// Any `f64`, with the patterns that break arithmetic more often than chance would bring them.
fn any_number() -> impl Strategy<Value = f64> {
    const SPECIAL: [f64; 16] = [
        0.0,
        -0.0,
        1.0,
        -1.0,
        f64::INFINITY,
        f64::NEG_INFINITY,
        f64::NAN,
        f64::MAX,
        f64::MIN,
        f64::MIN_POSITIVE,
        5e-324,
        1e-30,
        1e30,
        -1e30,
        9_007_199_254_740_992.0,
        1e-9,
    ];
    prop_oneof![
        any::<u64>().prop_map(f64::from_bits),
        (-31.0..31.0_f64).prop_map(|exponent| 10.0_f64.powf(exponent)),
        (0..SPECIAL.len()).prop_map(|i| SPECIAL[i]),
    ]
}

fn check(plan: &Profile, t: f64) -> Result<(), TestCaseError> {
    let duration = plan.duration();
    prop_assert!(duration >= 0.0 && duration.is_finite());
    let segments: Vec<_> = plan.segments().collect();
    prop_assert_eq!(segments.is_empty(), plan.distance() == 0.0);
    let edges = segments.iter().flat_map(|s| [s.start, s.start.next_down(), s.start + s.length / 2.0]);
    for t in [t, t * duration, 0.0, duration, duration.next_down(), 0.5 * duration].into_iter().chain(edges) {
        let s = plan.at(t);
        prop_assert!([s.x, s.v, s.a, s.j, s.s].iter().all(|value| value.is_finite()), "at {t:e}: {s:?}");
        prop_assert!(s.x.abs() <= plan.distance().abs(), "at {t:e}: {s:?}");
    }
    let peaks = plan.peaks();
    prop_assert!(peaks.velocity.is_finite() && peaks.acceleration.is_finite());
    prop_assert!(plan.times().unwrap().t_a >= 0.0 && plan.cruise() >= 0.0);
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(20_000))]
    #[test]
    fn never_a_panic_never_a_non_finite_set_point(
        order in (0..3_usize).prop_map(|i| [Order::Second, Order::Third, Order::Fourth][i]),
        distance in any_number(),
        limits in [any_number(), any_number(), any_number(), any_number()],
        sample_time in any_number(),
        t in any_number(),
        longer in any_number(),
    ) {
        let [velocity, acceleration, jerk, snap] = limits.map(f64::abs);
        let limits = Limits { velocity, acceleration, jerk, snap };
        for plan in [Profile::plan(order, distance, &limits), Profile::plan_sampled(order, distance, &limits, sample_time.abs())] {
            match plan {
                Ok(plan) => {
                    check(&plan, t)?;
                    if let Ok(stretched) = plan.stretched_to(longer) {
                        check(&stretched, t)?;
                    }
                }
                Err(e) => prop_assert!(e.to_string().len() > 20),
            }
        }
    }

    #[test]
    fn negative_limits_and_times_are_refused(value in any_number()) {
        let limits = Limits { velocity: 1.0, acceleration: 1.0, jerk: 1.0, snap: 1.0 };
        let wrong = -value.abs();
        for limits in [Limits { velocity: wrong, ..limits }, Limits { snap: wrong, ..limits }] {
            prop_assert!(Profile::plan(Order::Fourth, 1.0, &limits).is_err());
        }
        prop_assert!(Profile::plan_sampled(Order::Fourth, 1.0, &limits, wrong).is_err());
    }
}
