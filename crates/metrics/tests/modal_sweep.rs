//! The modal fit over a range of decays with noise, steps of an encoder and short records; and motions without vibration.
use core::f64::consts::PI;
use servobench_metrics::{Mode, Signal, fit_mode};
use servobench_testkit::Random;

/// Nearly normal, of standard deviation 1: the sum of twelve.
fn normal(random: &mut Random) -> f64 {
    (0..12).map(|_| random.unit()).sum::<f64>() - 6.0
}

/// Path from 0 to 1 while its argument goes from 0 to 1.
type Way = fn(f64) -> f64;

/// Size of a sweep; larger by `SERVOBENCH_SWEEP=3000`.
fn cases(usual: usize) -> usize {
    std::env::var("SERVOBENCH_SWEEP").ok().and_then(|text| text.parse().ok()).unwrap_or(usual)
}

/// `amplitude·e^{−ζωt}·cos(ω_d·t + phase)` at `rate` over `seconds`.
#[derive(Debug, Clone, Copy)]
struct Decay {
    amplitude: f64,
    frequency: f64,
    damping: f64,
    phase: f64,
    rate: f64,
    seconds: f64,
}

impl Decay {
    fn omega(&self) -> f64 {
        2.0 * PI * self.frequency
    }

    fn times(&self) -> impl Iterator<Item = f64> {
        let rate = self.rate;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "some thousands")]
        let count = (rate * self.seconds) as u32;
        (0..count).map(move |k| f64::from(k) / rate)
    }

    fn at(&self, t: f64) -> f64 {
        let damped = self.omega() * (1.0 - self.damping * self.damping).sqrt();
        self.amplitude * (-self.damping * self.omega() * t).exp() * (damped * t + self.phase).cos()
    }

    /// Cramér–Rao bounds: the smallest possible standard deviations of frequency (relative) and damping ratio under white noise of
    /// standard deviation `noise`, with unknown amplitude, phase and offset.
    fn least_deviations(&self, noise: f64) -> [f64; 2] {
        let with = |change: fn(&mut Self)| {
            let mut other = *self;
            change(&mut other);
            other
        };
        // Central differences by ln ω, ζ, phase, ln amplitude.
        let changes: [[fn(&mut Self); 2]; 4] = [
            [|d| d.frequency *= 1.0 + 1e-6, |d| d.frequency *= 1.0 - 1e-6],
            [|d| d.damping += 1e-6, |d| d.damping -= 1e-6],
            [|d| d.phase += 1e-6, |d| d.phase -= 1e-6],
            [|d| d.amplitude *= 1.0 + 1e-6, |d| d.amplitude *= 1.0 - 1e-6],
        ];
        let changed = changes.map(|pair| pair.map(with));
        let mut information = [[0.0; 5]; 5];
        for t in self.times() {
            let mut slopes = [1.0; 5];
            for (slope, [up, down]) in slopes.iter_mut().zip(&changed) {
                *slope = (up.at(t) - down.at(t)) / 2e-6;
            }
            for (row, one) in information.iter_mut().zip(slopes) {
                row.iter_mut().zip(slopes).for_each(|(sum, two)| *sum += one * two);
            }
        }
        let covariance = inverse(information);
        [0, 1].map(|k| noise * covariance[k][k].sqrt())
    }
}

/// Gauss–Jordan; the matrix is positive definite and needs no pivoting once its diagonal is 1.
fn inverse(mut matrix: [[f64; 5]; 5]) -> [[f64; 5]; 5] {
    let scale: Vec<f64> = (0..5).map(|k| matrix[k][k].sqrt()).collect();
    let mut other = [[0.0; 5]; 5];
    for k in 0..5 {
        other[k][k] = 1.0;
        for j in 0..5 {
            matrix[k][j] /= scale[k] * scale[j];
        }
    }
    for k in 0..5 {
        let pivot = matrix[k][k];
        for j in 0..5 {
            matrix[k][j] /= pivot;
            other[k][j] /= pivot;
        }
        for i in (0..5).filter(|i| *i != k) {
            let factor = matrix[i][k];
            for j in 0..5 {
                matrix[i][j] -= factor * matrix[k][j];
                other[i][j] -= factor * other[k][j];
            }
        }
    }
    for k in 0..5 {
        for j in 0..5 {
            other[k][j] /= scale[k] * scale[j];
        }
    }
    other
}

fn fit(values: &[f64], rate: f64, resolution: f64) -> Result<Mode, servobench_metrics::Absence> {
    fit_mode(&Signal { values, start: 0.0, step: 1.0 / rate, resolution, least: 0.0 }, None)
}

/// Decays of ζ from 0 to 0.1 in records of 2.5 to 60 periods, with noise of 1e-4 to 3 % of the amplitude: frequency and
/// damping within ten times the Cramér–Rao bound. Three bounds are the normal scatter of so many cases; the rest is for
/// least squares on overlapping means, which are not weighted, and for a tail that a short record may contain.
#[test]
fn noisy_decays_are_found_as_well_as_anybody_could() {
    let mut random = Random::seeded(5);
    for case in 0..cases(150) {
        let (frequency, periods) = (random.logarithmic(2.0, 400.0), random.logarithmic(2.5, 60.0));
        let damping = if random.unit() < 0.2 { 0.0 } else { random.logarithmic(1e-4, 0.1) };
        let known = Decay {
            amplitude: random.logarithmic(1e-8, 1e-3),
            frequency,
            damping,
            phase: random.between(-3.0, 3.0),
            rate: 16_000.0_f64.min(400.0 * frequency),
            seconds: periods / frequency,
        };
        let noise = known.amplitude * random.logarithmic(1e-4, 0.03);
        let values: Vec<f64> = known.times().map(|t| known.at(t) + noise * normal(&mut random)).collect();
        let mode = fit(&values, known.rate, 0.0).unwrap_or_else(|why| panic!("{case} {known:?} noise {noise}: {why}"));
        let errors = [(mode.frequency / frequency - 1.0).abs(), (mode.damping - damping).abs()];
        for (error, least) in errors.into_iter().zip(known.least_deviations(noise)) {
            assert!(error < 10.0 * least, "{case} {known:?} noise {noise}: {mode:?}, {error} against {least}");
        }
    }
}

/// An encoder that resolves the amplitude into 10 to 1000 steps: rounding is an error of at most half a step. Frequency
/// and damping within what a coherent error of that size could do: (step/2)/amplitude radian of phase over the periods,
/// and the same share of the envelope.
#[test]
fn decays_in_steps_of_an_encoder() {
    let mut random = Random::seeded(9);
    for case in 0..cases(100) {
        let (frequency, periods) = (random.logarithmic(5.0, 200.0), random.between(4.0, 30.0));
        let damping = random.logarithmic(1e-4, 0.3 / periods);
        let known = Decay {
            amplitude: 1e-6,
            frequency,
            damping,
            phase: random.between(-3.0, 3.0),
            rate: 16_000.0,
            seconds: periods / frequency,
        };
        let step = known.amplitude / random.logarithmic(10.0, 1000.0);
        let values: Vec<f64> = known.times().map(|t| (known.at(t) / step).round() * step).collect();
        let mode = fit(&values, known.rate, step).unwrap_or_else(|why| panic!("{case} {known:?} step {step}: {why}"));
        let bound = 0.5 * step / known.amplitude / (2.0 * PI * periods);
        let errors = [(mode.frequency / frequency - 1.0).abs(), (mode.damping - damping).abs()];
        assert!(errors.iter().all(|error| *error < bound), "{case} {known:?} step {step}: {mode:?} {bound}");
    }
}

/// A load that sticks, gives way once without coming back, and sticks again, on any path: not a vibration. Without
/// noise, as a simulated load sticks.
#[test]
fn creep_between_two_holds_is_no_mode() {
    let ways: [(&str, Way); 4] = [
        ("straight", |u| u),
        ("half a cosine", |u| 0.5 - 0.5 * (PI * u).cos()),
        ("cubic", |u| u * u * (3.0 - 2.0 * u)),
        ("exponential", |u| (1.0 - (-4.0 * u).exp()) / (1.0 - (-4.0_f64).exp())),
    ];
    let mut random = Random::seeded(13);
    for case in 0..cases(100) {
        let (what, way) = ways[case % 4];
        let seconds = random.between(0.2, 1.0);
        let (begin, length) = (seconds * random.between(0.0, 0.6), seconds * random.between(0.05, 0.4));
        let height = random.logarithmic(1e-8, 1e-5);
        let values: Vec<f64> = (0..8000)
            .map(|k| f64::from(k) / 8000.0)
            .take_while(|t| *t < seconds)
            .map(|t| height * way(((t - begin) / length).clamp(0.0, 1.0)))
            .collect();
        let found = fit(&values, 8000.0, 8.0 * f64::EPSILON);
        assert!(found.is_err(), "{case} {what}, {begin} s, {length} s of {seconds} s: {found:?}");
    }
}
