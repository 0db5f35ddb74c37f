//! Averages in continuous time against the planned profile, and sines against their transfer function.
use crate::random::{Random, any_number};
use proptest::prelude::*;
use servobench_base::Setpoint;
use servobench_motion::shape::{MovingAverages, Vibration};
use servobench_motion::{Limits, Order, Profile};

/// Largest relative differences of x, v, a, j from a plan with the same moving averages; of s away from switching instants.
fn differences<const N: usize>(order: Order, distance: f64, limits: &Limits) -> [f64; 5] {
    let plan = Profile::plan(order, distance, limits).unwrap();
    let lengths: Vec<_> = plan.boxes().collect();
    let averages = MovingAverages::<N>::new(lengths.try_into().unwrap()).unwrap();
    assert!((averages.duration() - plan.duration()).abs() <= 1e-15 * plan.duration());
    let peaks = plan.peaks();
    let scales = [distance.abs(), peaks.velocity, peaks.acceleration, peaks.jerk, peaks.snap];
    let mut largest = [0.0_f64; 5];
    for k in 0..500 {
        let t = (f64::from(k) + 0.37) / 499.0 * plan.duration();
        let [one, other] = [averages.of_step(t, distance).unwrap(), plan.at(t)];
        let pairs = [(one.x, other.x), (one.v, other.v), (one.a, other.a), (one.j, other.j), (one.s, other.s)];
        let near = plan.segments().any(|s| (t - s.start).abs() < 1e-12 * plan.duration());
        for (i, (one, other)) in pairs.into_iter().enumerate().take(if near { N } else { N + 1 }) {
            largest[i] = largest[i].max((one - other).abs() / scales[i]);
        }
    }
    let end = averages.of_step(averages.duration(), distance).unwrap();
    assert_eq!(end, Setpoint::at_rest(distance));
    largest
}

#[test]
fn averages_of_a_step_are_the_boxes_profile() {
    let mut random = Random::seeded(31);
    for _ in 0..200 {
        let limits = Limits {
            velocity: random.between(0.1, 3.0),
            acceleration: random.between(1.0, 30.0),
            jerk: random.between(10.0, 2000.0),
            snap: random.between(1e3, 1e5),
        };
        let distance = random.signed();
        let [x, v, a, j, s] = differences::<4>(Order::Fourth, distance, &limits);
        // Rounding of time, some ulp of the duration, over the shortest average that spreads a derivative.
        assert!(x < 1e-13 && v < 1e-13 && a < 1e-12 && j < 1e-11 && s < 1e-12, "{x:e} {v:e} {a:e} {j:e} {s:e}");
        let [x, v, a, j, _] = differences::<3>(Order::Third, distance, &limits);
        assert!(x < 1e-13 && v < 1e-13 && a < 1e-12 && j < 1e-12, "{x:e} {v:e} {a:e} {j:e}");
        let [x, v, a, ..] = differences::<2>(Order::Second, distance, &limits);
        assert!(x < 1e-13 && v < 1e-13 && a < 1e-12, "{x:e} {v:e} {a:e}");
    }
}

/// Lengths that differ by 1e11: where truncated powers would lose all digits.
#[test]
fn very_different_lengths_lose_nothing() {
    let limits = Limits { velocity: 1e-3, acceleration: 1.0, jerk: 1e4, snap: 1e12 };
    let [x, v, ..] = differences::<4>(Order::Fourth, 1.0, &limits);
    assert!(x < 1e-14 && v < 1e-12, "{x:e} {v:e}");
}

/// A sine is passed with the gain ∏ sin(ωT/2)/(ωT/2), which is the residual of an undamped mode of that frequency.
#[test]
fn what_is_left_of_an_undamped_mode_is_the_transfer_function() {
    let mut random = Random::seeded(32);
    for _ in 0..1000 {
        let lengths = [random.between(0.1, 1.0), random.between(0.1, 1.0), 0.4];
        let averages = MovingAverages::new(lengths).unwrap();
        let w = random.between(1.0, 20.0);
        let gain: f64 = lengths.iter().map(|length| (w * length / 2.0).sin() / (w * length / 2.0)).product();
        assert!((averages.residual(&Vibration::new(w, 0.0).unwrap()) - gain.abs()).abs() < 1e-14);
    }
}

/// The residual of one average of a damped mode by quadrature of `(ω_n/T)∫e^(−ζω(T−τ))·…` in midpoints, order two.
#[test]
fn the_residual_of_an_average_is_that_of_many_small_impulses() {
    let (vibration, length) = (Vibration::new(7.0, 0.15).unwrap(), 0.6);
    let averages = MovingAverages::new([length]).unwrap();
    let midpoints = |n: i32| {
        let (mut re, mut im) = (0.0, 0.0);
        for i in 0..n {
            let t = (f64::from(i) + 0.5) / f64::from(n) * length;
            let size = (-0.15 * 7.0 * (length - t)).exp() / f64::from(n);
            re += size * (7.0 * (1.0_f64 - 0.15 * 0.15).sqrt() * t).cos();
            im += size * (7.0 * (1.0_f64 - 0.15 * 0.15).sqrt() * t).sin();
        }
        re.hypot(im)
    };
    let error = |n| midpoints(n) - averages.residual(&vibration);
    assert!((error(100) / error(200) - 4.0).abs() < 0.01, "{} {}", error(100), error(200));
    // A whole number of undamped periods leaves nothing.
    let whole = MovingAverages::new([0.123, 4.0 * std::f64::consts::PI / 7.0]).unwrap();
    assert!(whole.residual(&Vibration::new(7.0, 0.0).unwrap()) < 1e-15);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(5_000))]
    #[test]
    fn any_lengths_are_refused_or_give_numbers(
        lengths in [any_number(), any_number(), any_number(), any_number()],
        distance in any_number(), t in any_number(), zeta in 0.0..1.0_f64, omega_n in any_number(),
    ) {
        let Ok(averages) = MovingAverages::new(lengths) else { return Ok(()) };
        for t in [t, t * averages.duration(), 0.3 * averages.duration(), 0.0, averages.duration().next_down()] {
            if let Ok(s) = averages.of_step(t, distance) {
                prop_assert!([s.x, s.v, s.a, s.j, s.s].iter().all(|y| y.is_finite()), "{s:?}");
                prop_assert!(s.x.abs() <= distance.abs() && s.x * distance >= 0.0);
            }
        }
        if let Ok(vibration) = Vibration::new(omega_n, zeta) {
            prop_assert!(averages.residual(&vibration) <= 1.0 + 1e-12);
        }
    }
}
