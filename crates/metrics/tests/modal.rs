//! The modal fit against oscillations whose parameters are known.
use core::f64::consts::PI;
use servobench_metrics::{Absence, Mode, Signal, fit_mode};
use servobench_testkit::Random;

/// `amplitude·e^{−ζωt}·cos(ω_d·t + phase)`.
#[derive(Debug, Clone, Copy)]
struct Known {
    amplitude: f64,
    frequency: f64,
    damping: f64,
    phase: f64,
}

impl Known {
    fn at(&self, t: f64) -> f64 {
        let omega = 2.0 * PI * self.frequency;
        let damped = omega * (1.0 - self.damping * self.damping).sqrt();
        self.amplitude * (-self.damping * omega * t).exp() * (damped * t + self.phase).cos()
    }
}

/// Position beside `offset`, rounded as a recording rounds it, and brought back to a deviation.
fn record(offset: f64, rate: f64, seconds: f64, y: impl Fn(f64) -> f64) -> Vec<f64> {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a few thousand")]
    let count = (rate * seconds).round() as usize;
    (0..count).map(|k| (offset + y(k as f64 / rate)) - offset).collect()
}

fn fit(values: &[f64], offset: f64, rate: f64, near: Option<f64>) -> Result<Mode, Absence> {
    fit_mode(
        &Signal { values, start: 0.0, step: 1.0 / rate, resolution: 8.0 * f64::EPSILON * offset, least: 0.0 },
        near,
    )
}

/// Relative error of frequency and amplitude, absolute error of damping.
fn errors(mode: &Mode, known: &Known) -> [f64; 3] {
    [
        (mode.frequency / known.frequency - 1.0).abs(),
        (mode.amplitude / known.amplitude - 1.0).abs(),
        (mode.damping - known.damping).abs(),
    ]
}

/// Guarantee of the fit on exact data: 1e-6 of the frequency, 1e-4 of the amplitude, 1e-5 in the damping ratio.
const PROMISE: [f64; 3] = [1e-6, 1e-4, 1e-5];

#[track_caller]
fn assert_promise(fit: Result<Mode, Absence>, known: &Known) {
    let mode = fit.unwrap_or_else(|absence| panic!("{known:?}: {absence}"));
    let within = errors(&mode, known).iter().zip(PROMISE).all(|(error, bound)| *error < bound);
    assert!(within, "{known:?} {mode:?} {:?}", errors(&mode, known));
}

/// A 6 nm vibration at 38.985 Hz beside a position of 1 m, undamped and with the damping of the Lambrechts axis.
#[test]
fn nanometres_beside_a_metre() {
    for damping in [0.0, 0.0021] {
        let known = Known { amplitude: 6.3e-9, frequency: 38.985, damping, phase: 1.0 };
        let values = record(1.0, 16_000.0, 0.65, |t| known.at(t));
        assert_promise(fit(&values, 1.0, 16_000.0, None), &known);
    }
}

/// Random modes, undamped to ζ = 0.2, beside 1 m, half of them with an offset and a tail up to a hundred times larger.
/// More cases: `SERVOBENCH_SWEEP=3000`.
#[test]
fn random_modes_with_offsets_and_tails() {
    let cases = std::env::var("SERVOBENCH_SWEEP").ok().and_then(|text| text.parse().ok()).unwrap_or(200);
    let mut random = Random::seeded(1);
    for _ in 0..cases {
        let seconds = random.logarithmic(0.1, 4.0);
        let frequency = random.logarithmic(3.0 / seconds, 1500.0);
        let damping = if random.unit() < 0.2 { 0.0 } else { random.logarithmic(1e-4, 0.2) };
        let (amplitude, phase) = (random.logarithmic(6e-9, 1e-3), random.between(-3.0, 3.0));
        let known = Known { amplitude, frequency, damping, phase };
        let tail = if random.unit() < 0.5 { amplitude * random.logarithmic(0.1, 100.0) } else { 0.0 };
        let (tau, offset) = (random.logarithmic(0.02, 0.5), amplitude * random.between(-3.0, 3.0));
        let values = record(1.0, 8000.0, seconds, |t| offset + known.at(t) + tail * (-t / tau).exp());
        assert_promise(fit(&values, 1.0, 8000.0, None), &known);
    }
}

/// The settling of a PI loop: two real poles, one of them slow, and the mode on top.
#[test]
fn two_tails_do_not_falsify_the_mode() {
    let known = Known { amplitude: 0.2e-6, frequency: 47.7, damping: 0.008, phase: 0.4 };
    let settling = |t: f64| 8e-6 * (-t / 0.15).exp() - 3e-6 * (-t / 0.02).exp();
    let values = record(0.25, 8000.0, 0.8, |t| known.at(t) + settling(t));
    assert_promise(fit(&values, 0.25, 8000.0, None), &known);
}

#[test]
fn of_two_modes_the_one_with_more_energy_is_reported() {
    let strong = Known { amplitude: 1e-6, frequency: 84.22, damping: 0.002, phase: 0.0 };
    for (frequency, damping) in [(59.55, 0.002), (90.0, 0.01), (410.0, 0.0), (12.0, 0.05)] {
        let weak = Known { amplitude: 0.5e-6, frequency, damping, phase: 2.0 };
        let values = record(1.0, 16_000.0, 1.0, |t| strong.at(t) + weak.at(t));
        assert_promise(fit(&values, 1.0, 16_000.0, None), &strong);
        // With its frequency given, the weak one is found as well as the strong one, when no band holds both.
        if (frequency / strong.frequency - 1.0).abs() > 0.3 {
            assert_promise(fit(&values, 1.0, 16_000.0, Some(1.05 * frequency)), &weak);
        }
    }
}

#[test]
fn nothing_where_the_mode_should_be() {
    let known = Known { amplitude: 1e-6, frequency: 84.22, damping: 0.002, phase: 0.0 };
    let values = record(1.0, 16_000.0, 1.0, |t| known.at(t));
    let why = fit(&values, 1.0, 16_000.0, Some(200.0)).unwrap_err().to_string();
    assert_eq!(why, "no mode within 25 % of 200 Hz");
}

#[test]
fn fewer_than_two_periods_are_refused() {
    for periods in [0.6, 1.2, 1.9] {
        let known = Known { amplitude: 1e-5, frequency: 20.0, damping: 0.01, phase: 0.3 };
        let values = record(1.0, 8000.0, periods / 20.0, |t| known.at(t));
        let refused = fit(&values, 1.0, 8000.0, None);
        assert!(matches!(refused, Err(Absence::TooShort { .. } | Absence::NoVibration)), "{periods}: {refused:?}");
    }
    assert!(matches!(fit(&[0.0, 1.0, 0.0], 1.0, 8000.0, None), Err(Absence::TooShort { .. })));
    assert!(matches!(fit(&[], 1.0, 8000.0, None), Err(Absence::TooShort { .. })));
}

#[test]
fn rest_and_drift_are_no_vibration() {
    type Case = (&'static str, fn(f64) -> f64);
    let cases: [Case; 5] = [
        ("rest", |_| 3e-6),
        ("one bit", |t| if t > 0.1 { 1e-16 } else { 0.0 }),
        ("straight line", |t| 1e-5 * t),
        ("tail", |t| 1e-5 * (-t / 0.1).exp()),
        ("two tails", |t| 1e-5 * (-t / 0.1).exp() - 4e-6 * (-t / 0.03).exp()),
    ];
    for (what, at) in cases {
        let found = fit(&record(1.0, 8000.0, 0.5, at), 1.0, 8000.0, None);
        assert_eq!(found, Err(Absence::NoVibration), "{what}");
    }
}

/// A fourfold pair of poles, t³·e^{−σt}·cos ωt: a sum of simple modes meets it only with modes thousands of times larger
/// than the visible motion, nearly cancelling. None of them may be reported.
#[test]
fn modes_that_cancel_are_not_reported() {
    let at = |t: f64| 1e-6 * (55.0 * t).powi(3) * (-55.0 * t).exp() * (126.0 * t).cos();
    let values = record(0.25, 16_000.0, 0.5, at);
    let height = values.iter().copied().fold(0.0, f64::max) - values.iter().copied().fold(0.0, f64::min);
    let found = fit(&values, 0.25, 16_000.0, None);
    assert!(found.as_ref().is_err() || found.as_ref().is_ok_and(|mode| mode.amplitude < 2.0 * height), "{found:?}");
}

/// White noise of a tenth of the amplitude: the Cramér–Rao bound of the frequency is √6·(σ/A)/(π·T·√n) = 2.9e-4 Hz and
/// of the amplitude √(2/n)·σ = 1.6e-3·A for n = 8000, undamped; ×2 for the damping fitted with it, ×4 for a rare case.
#[test]
fn noise_costs_what_theory_says() {
    let known = Known { amplitude: 1e-6, frequency: 38.985, damping: 0.0, phase: 0.7 };
    let mut random = Random::seeded(7);
    let mut noise = || (0..12).map(|_| random.unit()).sum::<f64>() - 6.0;
    let values: Vec<f64> = record(0.0, 8000.0, 1.0, |t| known.at(t)).iter().map(|y| y + 1e-7 * noise()).collect();
    let mode = fit(&values, 0.0, 8000.0, None).unwrap();
    let [frequency, amplitude, _] = errors(&mode, &known);
    assert!(frequency * known.frequency < 8.0 * 2.9e-4, "{mode:?}");
    assert!(amplitude < 8.0 * 1.6e-3, "{mode:?}");
    // Thinned by 12, a Blackman window of 48 lets 1.73/48 of the noise power pass: 3.6e-4 against a signal power of
    // 1/2. The power of some 650 independent values scatters by 4 %.
    let explained = 0.5 / (0.5 + 0.01 * 1.73 / 48.0);
    assert!((mode.share - explained).abs() < 1.5e-4, "{mode:?} {explained}");
}

#[test]
fn noise_alone_is_no_mode() {
    let mut random = Random::seeded(3);
    let values: Vec<f64> = (0..4000).map(|_| random.unit() - 0.5).collect();
    assert_eq!(fit(&values, 0.0, 8000.0, None), Err(Absence::NoVibration));
}

/// An encoder of 0.1 µm sees 20 steps of a 1 µm vibration. Rounding is noise of step/√12, 3 % of the amplitude, over
/// n = 8000 values; it is not white, so the bound is the rounding itself over √n with a factor of ten.
#[test]
fn an_encoder_with_steps_is_good_enough() {
    let known = Known { amplitude: 1e-6, frequency: 38.985, damping: 0.01, phase: 0.7 };
    let values: Vec<f64> =
        record(0.0, 8000.0, 1.0, |t| known.at(t)).iter().map(|y| (y / 1e-7).round() * 1e-7).collect();
    let mode = fit(&values, 0.0, 8000.0, None).unwrap();
    assert!((mode.frequency - known.frequency).abs() < 0.05 && (mode.amplitude / 1e-6 - 1.0).abs() < 0.02, "{mode:?}");
    assert!((mode.damping - 0.01).abs() < 5e-4, "{mode:?}");
}

/// A million values: thinned and cut to a window; the promise holds, and 40 s of vibration are not needed for it.
#[test]
fn a_million_values() {
    let known = Known { amplitude: 1e-6, frequency: 38.985, damping: 1e-4, phase: 0.7 };
    let values = record(1.0, 25_000.0, 40.0, |t| known.at(t));
    assert_eq!(values.len(), 1_000_000);
    assert_promise(fit(&values, 1.0, 25_000.0, None), &known);
}

/// The instant to which the amplitude refers need not be the first value, nor lie on the grid.
#[test]
fn amplitude_refers_to_time_zero() {
    let known = Known { amplitude: 1e-6, frequency: 38.985, damping: 0.05, phase: 0.7 };
    let start = 0.37 / 8000.0;
    let values: Vec<f64> = (0..4000).map(|k| known.at(start + f64::from(k) / 8000.0)).collect();
    let found = fit_mode(&Signal { values: &values, start, step: 1.0 / 8000.0, resolution: 0.0, least: 0.0 }, None);
    assert_promise(found, &known);
}

/// Growing oscillations of an unstable loop have negative damping.
#[test]
fn an_unstable_loop_has_negative_damping() {
    let known = Known { amplitude: 1e-6, frequency: 120.0, damping: -0.003, phase: 0.0 };
    assert_promise(fit(&record(0.0, 8000.0, 0.5, |t| known.at(t)), 0.0, 8000.0, None), &known);
}

#[test]
fn the_same_record_gives_the_same_bits() {
    let known = Known { amplitude: 1e-6, frequency: 84.22, damping: 0.003, phase: 0.1 };
    let values = record(1.0, 8000.0, 1.0, |t| known.at(t) + 2e-6 * (-t / 0.1).exp());
    let bits = |mode: Mode| [mode.amplitude, mode.frequency, mode.damping, mode.share].map(f64::to_bits);
    let (one, two) = (fit(&values, 1.0, 8000.0, None).unwrap(), fit(&values, 1.0, 8000.0, None).unwrap());
    assert_eq!(bits(one), bits(two));
}

/// For any record, the answer is a reason or a mode of finite numbers.
#[test]
fn never_a_nan() {
    let mut random = Random::seeded(11);
    for case in 0..60 {
        let count = [16, 17, 40, 300, 2000][case % 5];
        let scale = random.logarithmic(1e-300, 1e300);
        let values: Vec<f64> = match case % 4 {
            0 => (0..count).map(|_| scale * random.unit()).collect(),
            1 => (0..count).map(|k| if k == count / 2 { scale } else { 0.0 }).collect(),
            2 => (0..count).map(|k| if k > count / 3 { scale } else { 0.0 }).collect(),
            _ => (0..count).map(|k| scale * if k % 2 == 0 { 1.0 } else { -1.0 }).collect(),
        };
        for near in [None, Some(500.0)] {
            if let Ok(mode) = fit(&values, 0.0, 8000.0, near) {
                let all = [mode.amplitude, mode.frequency, mode.damping, mode.share];
                assert!(all.iter().all(|x| x.is_finite()), "{case} {mode:?}");
            }
        }
    }
    assert_eq!(fit(&[f64::NAN; 50], 0.0, 8000.0, None), Err(Absence::NoVibration));
}
