//! Streaming filters against sums over the whole past.
use crate::random::{Random, any_number};
use proptest::prelude::*;
use servobench_base::Setpoint;
use servobench_motion::shape::{Impulses, MovingAverage, ShapingFilter, Vibration};
use servobench_motion::{Limits, Order, Profile};

const TS: f64 = 1.0 / 1024.0;

fn values(s: Setpoint) -> [f64; 5] {
    [s.x, s.v, s.a, s.j, s.s]
}

fn random_setpoint(random: &mut Random) -> Setpoint {
    let [x, v, a, j, s] = std::array::from_fn(|_| random.signed());
    Setpoint { x, v, a, j, s }
}

#[test]
fn with_times_on_the_grid_the_stream_is_the_shaped_trajectory() {
    let limits = Limits { velocity: 1.0, acceleration: 5.0, jerk: 50.0, snap: 1000.0 };
    let plan = Profile::plan(Order::Fourth, -0.4, &limits).unwrap();
    // Half a period of 64 samples, a power of two of them per second: all times are exact.
    let shaper = Impulses::zvdd(&Vibration::new(std::f64::consts::PI / (64.0 * TS), 0.0).unwrap());
    let mut filter = ShapingFilter::<200>::new(&shaper, TS, Setpoint::default()).unwrap();
    let end = plan.duration() + shaper.duration();
    let mut k = 0.0;
    while k * TS < end + 0.1 {
        let [stream, direct] = [filter.next(plan.at(k * TS)).unwrap(), shaper.shape(k * TS, |t| plan.at(t))];
        for (one, other) in values(stream).into_iter().zip(values(direct)).take(4) {
            // Values up to 50, summed in another split: some ulp.
            assert!((one - other).abs() < 1e-12, "sample {k}: {one} {other}");
        }
        if k * TS > end + TS {
            assert_eq!(stream, Setpoint::at_rest(-0.4));
        }
        k += 1.0;
    }
}

/// Impulses between samples: the sum and the first moment are kept, so a constant stays and a ramp lags by ΣA·t.
#[test]
fn split_impulses_keep_sum_and_first_moment() {
    let mut random = Random::seeded(21);
    for _ in 0..500 {
        let vibration = Vibration::new(random.between(50.0, 500.0), random.between(0.0, 0.3)).unwrap();
        let shaper = Impulses::ei(&vibration, 0.05).unwrap();
        let grid = shaper.on_grid(TS).unwrap();
        assert!((grid.iter().map(|i| i.amplitude).sum::<f64>() - 1.0).abs() < 1e-15);
        assert!((grid.delay() - shaper.delay()).abs() < 1e-15);
        let lag: f64 = shaper.iter().map(|i| i.amplitude * i.time).sum();
        let mut filter = ShapingFilter::<256>::new(&shaper, TS, Setpoint::at_rest(-TS)).unwrap();
        for k in 0..400 {
            let out = filter.next(Setpoint { x: f64::from(k) * TS, v: 1.0, ..Setpoint::default() }).unwrap();
            if k > 300 {
                assert!((out.x - (f64::from(k) * TS - lag)).abs() < 1e-14 && (out.v - 1.0).abs() < 1e-15);
            }
        }
        // The price of the grid: a chord instead of a turn of e^((ζ + j√(1−ζ²))·ω·t), (ω·Ts)²/8 of its size at most,
        // seen at the same instant.
        let (decay, late) = (vibration.decay(), grid.duration() - shaper.duration());
        let bound = (vibration.omega_n() * TS).powi(2) / 8.0 * (decay * TS).exp();
        let residual = grid.residual(&vibration) * (decay * late).exp();
        assert!((residual - shaper.residual(&vibration)).abs() < bound);
    }
}

#[test]
fn a_shaper_longer_than_the_memory_is_refused() {
    let shaper = Impulses::zv(&Vibration::new(std::f64::consts::PI / (64.0 * TS), 0.0).unwrap());
    assert!(ShapingFilter::<65>::new(&shaper, TS, Setpoint::default()).is_ok());
    assert_eq!(
        ShapingFilter::<64>::new(&shaper, TS, Setpoint::default()).unwrap_err().to_string(),
        "the filter spans 6.500000000e1 samples, its memory holds 64: take a larger memory, a longer sample time or a \
         higher frequency"
    );
    assert!(ShapingFilter::<64>::new(&shaper, 1e-25, Setpoint::default()).is_err());
    assert!(ShapingFilter::<64>::new(&shaper, f64::NAN, Setpoint::default()).is_err());
    assert!(MovingAverage::over([], Setpoint::default()).is_err());
}

#[test]
fn the_moving_average_is_the_mean_of_the_last_samples() {
    let mut random = Random::seeded(22);
    for length in [1, 2, 3, 7, 64] {
        let rest = random_setpoint(&mut random);
        let mut filter = MovingAverage::over(vec![rest; length], rest).unwrap();
        let mut past = vec![rest; length];
        for _ in 0..1000 {
            let newest = random_setpoint(&mut random);
            past.push(newest);
            let out = filter.next(newest).unwrap();
            for (i, value) in values(out).into_iter().enumerate() {
                let mean = past[past.len() - length..].iter().map(|s| values(*s)[i]).sum::<f64>() / length as f64;
                // Sums of 64 differences of up to 2.
                assert!((value - mean).abs() < 1e-14, "{value} {mean}");
            }
        }
    }
}

#[test]
fn after_a_million_samples_a_rest_is_exactly_the_target() {
    let mut random = Random::seeded(23);
    let mut filter = MovingAverage::over([Setpoint::default(); 61], Setpoint::default()).unwrap();
    for _ in 0..1_000_000 {
        filter.next(random_setpoint(&mut random)).unwrap();
    }
    let target = Setpoint::at_rest(0.1);
    for k in 0..200 {
        let out = filter.next(target).unwrap();
        assert_eq!(out == target, k >= 60, "sample {k}");
    }
}

/// A step through averages of n1 … n4 samples: its fourth differences are the snap of the sampled plan with these lengths.
#[test]
fn four_averages_of_a_step_are_the_sampled_profile() {
    let limits = Limits { velocity: 1.0, acceleration: 5.0, jerk: 50.0, snap: 1000.0 };
    for distance in [0.02, -0.4, 3.0] {
        let plan = Profile::plan_sampled(Order::Fourth, distance, &limits, 0.01).unwrap();
        let boxes = plan.samples().unwrap().boxes;
        let mut filters = boxes.map(|n| {
            MovingAverage::over(vec![Setpoint::default(); usize::try_from(n).unwrap()], Setpoint::default()).unwrap()
        });
        // The forward-Euler cascade of the plan's snap, one sample earlier at each of its four stages.
        let (mut v, mut a, mut j, mut x) = (0.0, 0.0, 0.0, 0.0);
        for k in 0..plan.samples().unwrap().total() + 10 {
            let step = Setpoint::at_rest(distance);
            let out = filters.iter_mut().fold(step, |setpoint, filter| filter.next(setpoint).unwrap());
            j += 0.01 * plan.at(k as f64 * 0.01).s;
            a += 0.01 * j;
            v += 0.01 * a;
            x += 0.01 * v;
            // The cascade sums a thousand roundings four times over.
            assert!((out.x - x).abs() < 1e-11 * distance.abs(), "sample {k} of {boxes:?}: {} {x}", out.x);
        }
        let end =
            filters.iter_mut().fold(Setpoint::at_rest(distance), |setpoint, filter| filter.next(setpoint).unwrap());
        assert_eq!(end, Setpoint::at_rest(distance));
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2_000))]
    #[test]
    fn never_a_non_finite_set_point_and_refusals_change_nothing(
        numbers in proptest::collection::vec([any_number(), any_number(), any_number(), any_number(), any_number()], 1..40),
        length in 1..17_usize,
        sample_time in any_number(),
    ) {
        let shaper = Impulses::zvd(&Vibration::new(std::f64::consts::PI / 5.3, 0.1).unwrap());
        let mut mean = MovingAverage::over(vec![Setpoint::default(); length], Setpoint::default()).unwrap();
        let mut shaped = ShapingFilter::<16>::new(&shaper, 1.0, Setpoint::default()).unwrap();
        prop_assert!(ShapingFilter::<16>::new(&shaper, sample_time, Setpoint::default()).is_err() || sample_time > 0.7);
        for [x, v, a, j, s] in numbers {
            let setpoint = Setpoint { x, v, a, j, s };
            let usable = values(setpoint).iter().all(|y| y.abs() <= 1e150);
            let before = (mean.clone(), shaped);
            match (mean.next(setpoint), shaped.next(setpoint)) {
                (Ok(one), Ok(other)) => {
                    prop_assert!(usable);
                    prop_assert!(values(one).iter().chain(&values(other)).all(|y| y.is_finite()));
                }
                (Err(one), Err(other)) => {
                    prop_assert!(!usable);
                    prop_assert_eq!(one.to_string(), other.to_string());
                    prop_assert!((&mean, &shaped) == (&before.0, &before.1));
                }
                _ => prop_assert!(false, "one filter refuses what the other takes"),
            }
        }
    }
}
