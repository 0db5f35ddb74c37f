//! Guarantees of each interpolation mode: the samples it meets, continuity, exactness, delay.
use crate::random::{Random, any_number};
use proptest::prelude::*;
use servobench_base::Setpoint;
use servobench_motion::PlanError;
use servobench_motion::interpolate::{Interpolator, Interval, Mode, Sample};

const PERIOD: f64 = 0.25;

fn random_samples(random: &mut Random, count: usize) -> Vec<Sample> {
    let mut one = || Sample { x: random.signed(), v: random.signed(), a: random.signed(), torque: random.signed() };
    (0..count).map(|_| one()).collect()
}

/// The intervals that a stream of samples opens, each with the number of the sample at its start.
fn intervals(mode: Mode, samples: &[Sample]) -> Vec<(usize, Interval)> {
    let mut stream = Interpolator::new(mode, PERIOD).unwrap();
    let mut all = Vec::new();
    for (k, sample) in samples.iter().enumerate() {
        stream.push(*sample).unwrap();
        if let Some(interval) = stream.interval() {
            all.push((k - mode.delay_samples(), *interval));
        }
    }
    assert_eq!(all.len(), samples.len() + 1 - mode.points());
    all
}

fn values(s: Setpoint) -> [f64; 5] {
    [s.x, s.v, s.a, s.j, s.s]
}

/// Number of leading quantities of (x, v, a) that a mode takes over from the samples.
fn met(mode: Mode) -> usize {
    match mode {
        Mode::Linear => 1,
        Mode::Cubic => 2,
        Mode::Quintic | Mode::AllLinear | Mode::AllCubic => 3,
        Mode::CubicBSpline | Mode::QuinticBSpline => 0,
    }
}

#[test]
fn samples_are_met_by_the_modes_that_promise_it() {
    let samples = random_samples(&mut Random::seeded(1), 2000);
    for mode in Mode::ALL {
        for (start, interval) in intervals(mode, &samples) {
            for (sample, fraction) in [(samples[start], 0.0), (samples[start + 1], 1.0)] {
                let command = interval.at(fraction).unwrap();
                let wanted = [sample.x, sample.v, sample.a];
                // Of the order of the terms that are summed: up to 12 for x, 500 for v = dx/dt, 10 000 for a, some
                // roundings of 2e-16 each.
                let tolerances = [1e-14, 1e-12, 1e-11];
                for ((is, wanted), tolerance) in
                    values(command.setpoint).into_iter().zip(wanted).zip(tolerances).take(met(mode))
                {
                    assert!((is - wanted).abs() < tolerance, "{mode:?}: {is} for {wanted}");
                }
                if met(mode) == 0 {
                    assert!((command.setpoint.x - sample.x).abs() < 1.5, "{mode:?} leaves the range of the samples");
                }
                assert!((command.torque - sample.torque).abs() < 1e-15, "{mode:?}: torque is linear in every mode");
            }
            let [t0, t1] = [samples[start].torque, samples[start + 1].torque];
            assert!((interval.at(0.3).unwrap().torque - (0.7 * t0 + 0.3 * t1)).abs() < 1e-15);
        }
    }
}

/// Limits from both sides at the knots: the continuous quantities of a mode are continuous, the next derivative of position is not.
#[test]
fn continuity_class_of_each_mode() {
    let samples = random_samples(&mut Random::seeded(2), 500);
    // The first that jumps, of x, v, a, j, s; 5 when none of these does.
    let first_jump = |mode| match mode {
        Mode::Linear => 1,
        Mode::Cubic => 2,
        Mode::Quintic | Mode::CubicBSpline | Mode::AllLinear | Mode::AllCubic => 3,
        Mode::QuinticBSpline => 5,
    };
    for mode in Mode::ALL {
        let mut largest = [0.0_f64; 5];
        for pair in intervals(mode, &samples).windows(2) {
            let [before, after] = [pair[0].1.at(1.0).unwrap(), pair[1].1.at(0.0).unwrap()];
            for ((jump, before), after) in largest.iter_mut().zip(values(before.setpoint)).zip(values(after.setpoint)) {
                *jump = jump.max((before - after).abs());
            }
        }
        for (k, jump) in largest.into_iter().enumerate() {
            // A derivative of order k carries k factors of 1/T = 4 and coefficients up to 120 times some rounding.
            let rounding = 1e-13 * 4_f64.powi(i32::try_from(k).unwrap());
            if k < first_jump(mode) {
                assert!(jump < rounding, "{mode:?}: derivative {k} jumps by {jump:e}");
            } else if k == first_jump(mode) && mode != Mode::Linear {
                assert!(jump > 0.1, "{mode:?}: derivative {k} is smoother than stated ({jump:e})");
            }
        }
    }
    // All linear: the slope of the position jumps, which is not the reported velocity.
    let slopes: Vec<_> = intervals(Mode::AllLinear, &samples)
        .iter()
        .map(|(_, interval)| interval.at(1.0).unwrap().setpoint.x - interval.at(0.0).unwrap().setpoint.x)
        .collect();
    assert!(slopes.windows(2).any(|pair| (pair[0] - pair[1]).abs() > 0.1));
}

/// Derivative of a polynomial of degree 6 or less by the central stencil of order 6, which is exact for it.
fn slope(interval: &Interval, of: fn(Setpoint) -> f64, u: f64) -> f64 {
    let h = 0.05;
    let y = |k: f64| of(interval.at(u + k * h).unwrap().setpoint);
    (45.0 * (y(1.0) - y(-1.0)) - 9.0 * (y(2.0) - y(-2.0)) + y(3.0) - y(-3.0)) / (60.0 * h * PERIOD)
}

#[test]
fn velocity_and_acceleration_are_derivatives_where_stated() {
    let samples = random_samples(&mut Random::seeded(3), 100);
    for mode in Mode::ALL {
        let (mut of_x, mut of_v) = (0.0_f64, 0.0_f64);
        for (_, interval) in intervals(mode, &samples) {
            for u in [0.2, 0.5, 0.83] {
                let s = interval.at(u).unwrap().setpoint;
                of_x = of_x.max((slope(&interval, |s| s.x, u) - s.v).abs());
                of_v = of_v.max((slope(&interval, |s| s.v, u) - s.a).abs());
                // Values up to 2000 (v divided by T twice, coefficients of 30), the stencil loses two digits.
                assert!((slope(&interval, |s| s.a, u) - s.j).abs() < 1e-8, "{mode:?}: j is da/dt");
                assert!((slope(&interval, |s| s.j, u) - s.s).abs() < 1e-7, "{mode:?}: s is dj/dt");
            }
        }
        let of_x_holds = !matches!(mode, Mode::AllLinear | Mode::AllCubic);
        assert_eq!(of_x < 1e-10, of_x_holds, "{mode:?}: v differs from dx/dt by {of_x:e}");
        assert_eq!(of_v < 1e-9, mode != Mode::AllLinear, "{mode:?}: a differs from dv/dt by {of_v:e}");
    }
}

/// A polynomial of time and its derivatives.
struct Power(Vec<f64>);

impl Power {
    fn at(&self, t: f64) -> [f64; 3] {
        let term = |k: usize| {
            self.0.iter().enumerate().skip(k).map(move |(n, c)| {
                let factor: usize = (n - k + 1..=n).product();
                c * factor as f64 * t.powi(i32::try_from(n - k).unwrap())
            })
        };
        [term(0).sum(), term(1).sum(), term(2).sum()]
    }

    fn samples(&self, count: usize) -> Vec<Sample> {
        let sample = |k: usize| {
            let [x, v, a] = self.at(k as f64 * PERIOD);
            Sample { x, v, a, torque: 0.0 }
        };
        (0..count).map(sample).collect()
    }

    /// Largest difference of the output, read as soon as it can be, from the input `delay` periods before.
    fn error(&self, mode: Mode, delay: f64) -> f64 {
        let mut stream = Interpolator::new(mode, PERIOD).unwrap();
        let mut largest = 0.0_f64;
        for (k, sample) in self.samples(12).into_iter().enumerate() {
            stream.push(sample).unwrap();
            for u in [0.0, 0.1, 0.5, 0.9] {
                if let Ok(command) = stream.at(u) {
                    let [x, ..] = self.at((k as f64 + u - delay) * PERIOD);
                    largest = largest.max((command.setpoint.x - x).abs());
                }
            }
        }
        largest
    }
}

#[test]
fn polynomials_of_the_promised_degree_are_reproduced_and_no_higher_ones() {
    let mut random = Random::seeded(4);
    for mode in Mode::ALL {
        let degree = match mode {
            Mode::Linear | Mode::CubicBSpline | Mode::QuinticBSpline | Mode::AllLinear => 1,
            Mode::Cubic | Mode::AllCubic => 3,
            Mode::Quintic => 5,
        };
        for _ in 0..200 {
            let mut power = Power((0..=degree).map(|_| random.signed()).collect());
            let delay = mode.delay_samples() as f64;
            // Values up to 3⁵ = 243 times six terms: 1e-11 is some hundred of their roundings.
            assert!(power.error(mode, delay) < 1e-11, "{mode:?}: {:e}", power.error(mode, delay));
            power.0.push(1.0);
            assert!(power.error(mode, delay) > 1e-6, "{mode:?} is exact above its degree");
        }
    }
}

/// The shift between input and output, measured on a ramp by position and on a parabola by velocity.
#[test]
fn delay_is_what_it_states() {
    for mode in Mode::ALL {
        let mut stream = Interpolator::new(mode, PERIOD).unwrap();
        let ramp = Power(vec![0.3, 2.0]);
        for (k, sample) in ramp.samples(9).into_iter().enumerate() {
            stream.push(sample).unwrap();
            assert_eq!(stream.at(0.0).is_ok(), k + 1 >= mode.points());
            for u in [0.0, 0.25, 0.75] {
                if let Ok(command) = stream.at(u) {
                    let shift = k as f64 + u - (command.setpoint.x - 0.3) / 2.0 / PERIOD;
                    assert!((shift - mode.delay_samples() as f64).abs() < 1e-13, "{mode:?}: {shift}");
                }
            }
        }
        let parabola = Power(vec![0.0, 0.0, 0.5]);
        let mut stream = Interpolator::new(mode, PERIOD).unwrap();
        for (k, sample) in parabola.samples(9).into_iter().enumerate() {
            stream.push(sample).unwrap();
            // The slope of a chord is that of the parabola in its middle.
            for u in if mode == Mode::Linear { &[0.5][..] } else { &[0.0, 0.25, 0.5, 0.75] } {
                if let Ok(command) = stream.at(*u) {
                    let shift = k as f64 + u - command.setpoint.v / PERIOD;
                    assert!((shift - mode.delay_samples() as f64).abs() < 1e-12, "{mode:?}: {shift}");
                    let t = (k as f64 + u - mode.delay_samples() as f64) * PERIOD;
                    let off = command.setpoint.x - 0.5 * t * t;
                    let wanted = match mode {
                        Mode::CubicBSpline => PERIOD * PERIOD / 6.0,
                        Mode::QuinticBSpline => PERIOD * PERIOD / 4.0,
                        // A chord above a parabola.
                        Mode::Linear | Mode::AllLinear => PERIOD * PERIOD * u * (1.0 - u) / 2.0,
                        Mode::Cubic | Mode::Quintic | Mode::AllCubic => 0.0,
                    };
                    assert!((off - wanted).abs() < 1e-14, "{mode:?}: off by {off}, not {wanted}");
                }
            }
        }
    }
}

/// B-spline of `degree` on the knots i, i + 1, … by the recursion of Cox and de Boor.
fn cox_de_boor(degree: u32, i: f64, t: f64) -> f64 {
    if degree == 0 {
        return if i <= t && t < i + 1.0 { 1.0 } else { 0.0 };
    }
    let n = f64::from(degree);
    (t - i) / n * cox_de_boor(degree - 1, i, t) + (i + n + 1.0 - t) / n * cox_de_boor(degree - 1, i + 1.0, t)
}

#[test]
fn b_splines_equal_the_cox_de_boor_recursion() {
    let samples = random_samples(&mut Random::seeded(5), 60);
    for (mode, degree) in [(Mode::CubicBSpline, 3), (Mode::QuinticBSpline, 5)] {
        for (start, interval) in intervals(mode, &samples) {
            for u in [0.0, 0.125, 0.5, 0.7, 0.999] {
                // The basis function that belongs to control point i has its middle at knot i.
                let half = f64::from(degree + 1) / 2.0;
                let t = start as f64 + u;
                let x: f64 =
                    samples.iter().zip(0..).map(|(s, i)| s.x * cox_de_boor(degree, f64::from(i) - half, t)).sum();
                let is = interval.at(u).unwrap().setpoint.x;
                assert!((is - x).abs() < 1e-14, "{mode:?} at {t}: {is}, not {x}");
            }
        }
    }
}

#[test]
fn far_from_zero_nothing_but_the_position_rounds() {
    let samples = random_samples(&mut Random::seeded(6), 40);
    let far: Vec<_> = samples.iter().map(|s| Sample { x: (s.x * 1024.0).round() / 1024.0 + 1e6, ..*s }).collect();
    let near: Vec<_> = far.iter().map(|s| Sample { x: s.x - 1e6, ..*s }).collect();
    for mode in Mode::ALL {
        for ((_, far), (_, near)) in intervals(mode, &far).into_iter().zip(intervals(mode, &near)) {
            let [far, near] = [far, near].map(|interval| interval.at(0.4).unwrap().setpoint);
            // One rounding of 1e6; the velocity is the same to its own rounding.
            assert!((far.x - 1e6 - near.x).abs() < 3e-10 && (far.v - near.v).abs() < 1e-12, "{mode:?}");
        }
    }
}

#[test]
fn refusals_name_the_sample_and_the_way_out() {
    let mut stream = Interpolator::new(Mode::CubicBSpline, PERIOD).unwrap();
    for _ in 0..3 {
        stream.push(Sample::default()).unwrap();
    }
    assert_eq!(
        stream.at(0.5).unwrap_err().to_string(),
        "the interpolation needs 4 samples, got 3: push the missing ones first"
    );
    let before = stream;
    assert_eq!(
        stream.push(Sample { v: f64::NEG_INFINITY, ..Sample::default() }).unwrap_err().to_string(),
        "sample 3: `v` must be finite and at most 1e30 in magnitude (SI), got -inf: correct it or its unit"
    );
    assert_eq!(stream, before, "a refused sample changes nothing");
    stream.push(Sample::default()).unwrap();
    assert!(stream.at(1.0).is_ok());
    assert_eq!(stream.at(1.5).unwrap_err().to_string(), "`fraction` must be between 0 and 1, got 1.5");
    stream.restart();
    assert!(matches!(stream.at(0.0), Err(PlanError::Waiting { received: 0, needed: 4 })));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(5_000))]
    #[test]
    fn never_a_panic_never_a_non_finite_command(
        mode in (0..7_usize).prop_map(|i| Mode::ALL[i]),
        period in any_number(),
        numbers in proptest::collection::vec([any_number(), any_number(), any_number(), any_number()], 1..9),
        fraction in any_number(),
    ) {
        let samples: Vec<_> = numbers.iter().map(|&[x, v, a, torque]| Sample { x, v, a, torque }).collect();
        if let Ok(interval) = Interval::new(mode, period, &samples) {
            for u in [fraction, 0.0, 0.5, 1.0] {
                match interval.at(u) {
                    Ok(c) => prop_assert!(values(c.setpoint).iter().all(|y| y.is_finite()) && c.torque.is_finite()),
                    Err(_) => prop_assert!(!(0.0..=1.0).contains(&u)),
                }
            }
        }
        let Ok(mut stream) = Interpolator::new(mode, period) else { return Ok(()) };
        let mut taken = 0;
        for sample in samples {
            let Sample { x, v, a, torque } = sample;
            let usable = [x, v, a, torque].iter().all(|y| y.abs() <= 1e30);
            prop_assert_eq!(stream.push(sample).is_ok(), usable);
            taken += usize::from(usable);
            prop_assert_eq!(stream.at(0.5).is_ok(), taken >= mode.points());
        }
    }
}
