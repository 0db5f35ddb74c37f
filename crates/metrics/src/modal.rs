//! The dominant mode of a record: natural frequency, damping and amplitude.
//!
//! ```text
//! y(t) = c + aperiodic tails + Σ e^{−ζωt}·(a·cos ω_d·t + b·sin ω_d·t)      ω_d = ω·√(1 − ζ²)
//! ```
//! fitted by least squares. Tails (real poles) take the settling of an integrator, further modes what else rings; so
//! neither falsifies the mode that is reported. Spectra only propose where to start. Components are added while each
//! removes at least a quarter of what is left.
//!
//! A long record is thinned without aliasing to at least 16 values per period of the fastest mode proposed, and its
//! first 4096 values are fitted: 128 periods or more.
mod fit;
mod least_squares;
mod model;
mod series;
mod spectrum;

use crate::absence::Absence;
use core::f64::consts::PI;
use fit::Fit;
use model::{Component, tail};
use series::Series;

/// A record of a motion that has no input.
#[derive(Debug, Clone, Copy)]
pub struct Signal<'a> {
    /// Deviation from rest (any unit).
    pub values: &'a [f64],
    /// Time of the first value (s), counted from the instant to which the amplitude refers.
    pub start: f64,
    /// Time from one value to the next (s).
    pub step: f64,
    /// Below this the values mean nothing: their rounding, or the step of a sensor.
    pub resolution: f64,
}

/// A mode of a record.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mode {
    /// `√(a² + b²)`: the envelope at time 0 (unit of the values).
    pub amplitude: f64,
    /// Natural (undamped) frequency ω/2π (Hz).
    pub frequency: f64,
    /// Damping ratio ζ; negative when the oscillation grows.
    pub damping: f64,
    /// Share of the oscillation's energy that all fitted modes explain, 0 to 1.
    pub share: f64,
}

/// Periods that a record must hold.
const PERIODS: f64 = 2.0;
/// Values that a record must hold.
const VALUES: usize = 16;
/// Stronger damping is settling, not vibration.
const MAX_DAMPING: f64 = 0.5;
/// Share of the oscillation that modes must explain.
const EXPLAINED: f64 = 0.5;
/// A component must leave at most this share of the energy.
const WORTH: f64 = 0.75;
const MAX_COMPONENTS: usize = 6;
/// What is left below this share of the record (squared) is not looked at any more.
const NOTHING: f64 = 1e-20;
/// A mode below this share of the record's height is taken for a crumb of its tail.
const CRUMB: f64 = 1e-7;
/// A mode larger than this, in heights of the record, is one of several that all but cancel: no vibration anybody sees.
/// Alone, a mode of ζ = 0.5 in its least favourable phase has an amplitude of 1.6 heights.
const CANCELLING: f64 = 2.0;
/// Half width of the band about a given frequency, relative.
const BAND: f64 = 0.25;
const MAX_VALUES: usize = 4096;
const VALUES_PER_PERIOD: f64 = 16.0;
/// Values from which tails are guessed.
const COARSE: usize = 512;
const START_DAMPING: [f64; 5] = [0.0, 0.003, 0.02, 0.1, 0.3];
/// Starting points of tails, λ·T.
const START_TAILS: [f64; 4] = [1.0, 5.0, 25.0, 100.0];

/// The mode with the most energy in the record; with `near` (Hz), the one with the most energy within 25 % of it.
///
/// # Errors
/// [`Absence`]: nothing oscillates, the record is shorter than two periods, decaying modes do not explain the motion.
pub fn fit_mode(signal: &Signal<'_>, near: Option<f64>) -> Result<Mode, Absence> {
    let span = signal.values.len() as f64 * signal.step;
    let (low, high) = signal.values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), y| (l.min(*y), h.max(*y)));
    let height = high - low;
    if signal.values.len() < VALUES {
        return Err(Absence::TooShort { periods: 0.0, needed: PERIODS });
    }
    if !height.is_finite() || height <= signal.resolution {
        return Err(Absence::NoVibration);
    }
    // Scaled to about 1, so that squares of nanometres keep far from the smallest numbers.
    let values: Vec<f64> = signal.values.iter().map(|y| (y - low) / height).collect();
    let scaled = Signal { values: &values, resolution: signal.resolution / height, ..*signal };
    let starts = starts(&scaled, span, near);
    let fastest = starts.iter().copied().fold(0.0, f64::max);
    if fastest == 0.0 {
        return Err(near.map_or(Absence::NoVibration, |near| Absence::NotThere { frequency: near, share: BAND }));
    }
    let factor = whole(1.0 / (VALUES_PER_PERIOD * fastest * signal.step));
    let series = Series::thinned(&values, signal.start, signal.step, factor, MAX_VALUES);
    let fit = build(&series, &starts, scaled.resolution).ok_or(Absence::NoVibration)?;
    let mode = select(&fit, &series, span, near, scaled.resolution)?;
    Ok(Mode { amplitude: mode.amplitude * height, ..mode })
}

/// Frequencies (Hz) at which the record seems to oscillate, once its slow tail is taken off.
fn starts(signal: &Signal<'_>, span: f64, near: Option<f64>) -> Vec<f64> {
    let factor = signal.values.len() / COARSE;
    let coarse = Series::thinned(signal.values, signal.start, signal.step, factor, usize::MAX);
    let bare = Fit::linear(&coarse, vec![]);
    let trend = bare.and_then(|bare| with_tail(&bare, &coarse).filter(|with| with.energy <= WORTH * bare.energy));
    let mut values = signal.values.to_vec();
    for (component, coefficients) in trend.iter().flat_map(Fit::parts) {
        match component {
            // What is over within two coarse values says little about the record between them.
            Component::Tail { rate } if rate * coarse.step < 0.5 => {
                subtract_tail(&mut values, signal, &coarse, rate, coefficients[0]);
            }
            _ => {}
        }
    }
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    for y in &mut values {
        *y -= mean;
    }
    let rms = (values.iter().map(|y| y * y).sum::<f64>() / values.len() as f64).sqrt();
    if rms <= signal.resolution.max(NOTHING.sqrt()) {
        return Vec::new();
    }
    let (low, high) = near.map_or((0.7 / span, f64::INFINITY), |f| (f * (1.0 - BAND), f * (1.0 + BAND)));
    spectrum::peaks(&values, signal.step, low, high.min(0.45 / signal.step))
}

/// `coefficient` was fitted to the thinned tail; the record's own is 1/gain of it in the exponential part.
fn subtract_tail(values: &mut [f64], signal: &Signal<'_>, coarse: &Series, rate: f64, coefficient: f64) {
    let length = coarse.length();
    let gain = coarse.gain(rate, 0.0).0;
    let u = rate * length;
    for (k, y) in values.iter_mut().enumerate() {
        let t = signal.start + k as f64 * signal.step;
        let correction = if u.abs() < 1e-6 { 0.0 } else { (1.0 - 1.0 / gain) * libm::exp(-rate * t) / u };
        *y -= coefficient * (tail(rate, t, length) + correction);
    }
}

/// Adds component after component while each takes a good part of what is left.
fn build(series: &Series, starts: &[f64], resolution: f64) -> Option<Fit> {
    let mut fit = Fit::linear(series, vec![])?;
    let nothing = (NOTHING * fit.energy).max(resolution * resolution * series.values.len() as f64);
    let high = 0.45 / series.step;
    while fit.components.len() < MAX_COMPONENTS && fit.energy > nothing {
        let low = 0.7 / series.length();
        let mut frequencies = spectrum::peaks(&fit.residual, series.step, low, high);
        frequencies.extend_from_slice(starts);
        let oscillation = with_oscillation(&fit, series, &frequencies);
        let better = [with_tail(&fit, series), oscillation]
            .into_iter()
            .flatten()
            .reduce(|one, two| if two.energy < one.energy { two } else { one });
        match better {
            Some(better) if better.energy <= WORTH * fit.energy => fit = better,
            _ => break,
        }
    }
    Some(fit)
}

fn with_tail(fit: &Fit, series: &Series) -> Option<Fit> {
    let rates = START_TAILS.map(|start| start / series.length());
    extended(fit, series, rates.into_iter().map(|rate| Component::Tail { rate }))
}

fn with_oscillation(fit: &Fit, series: &Series, frequencies: &[f64]) -> Option<Fit> {
    let poles = frequencies.iter().flat_map(|f| {
        let frequency = 2.0 * PI * f;
        START_DAMPING.map(|zeta| Component::Oscillation { decay: zeta * frequency, frequency })
    });
    extended(fit, series, poles)
}

/// `fit` with the best of `candidates`, refined.
fn extended(fit: &Fit, series: &Series, candidates: impl Iterator<Item = Component>) -> Option<Fit> {
    let with = |candidate| {
        let mut components = fit.components.clone();
        components.push(candidate);
        Fit::linear(series, components)
    };
    let best = candidates.filter_map(with).reduce(|one, two| if two.energy < one.energy { two } else { one });
    best.map(|best| best.refined(series))
}

/// The mode to report.
fn select(fit: &Fit, series: &Series, span: f64, near: Option<f64>, resolution: f64) -> Result<Mode, Absence> {
    let oscillation = |component: Component| oscillation(component, span);
    let vibration = fit.sum_of(|component| oscillation(component).is_some_and(|(_, _, periods)| periods >= PERIODS));
    let whole: f64 = vibration.iter().zip(&fit.residual).map(|(y, r)| (y + r) * (y + r)).sum();
    let share = if whole > 0.0 { (1.0 - fit.energy / whole).clamp(0.0, 1.0) } else { 0.0 };
    let mut too_short: Option<f64> = None;
    let mut best: Option<(f64, Mode)> = None;
    for (component, coefficients) in fit.parts() {
        let (Component::Oscillation { decay, frequency: damped }, Some((frequency, damping, periods))) =
            (component, oscillation(component))
        else {
            continue;
        };
        let gain = series.gain(decay, damped);
        let amplitude = libm::hypot(coefficients[0], coefficients[1]) / libm::hypot(gain.0, gain.1);
        let searched = near.is_none_or(|near| (frequency - near).abs() <= BAND * near);
        if !searched || amplitude <= resolution.max(CRUMB) || amplitude.is_nan() || amplitude >= CANCELLING {
            continue;
        }
        if periods < PERIODS {
            too_short = Some(too_short.map_or(periods, |other| other.max(periods)));
            continue;
        }
        // ∫ of the squared envelope over the record.
        let energy = amplitude * amplitude * tail(2.0 * decay, span, span);
        if best.is_none_or(|(other, _)| energy > other) {
            best = Some((energy, Mode { amplitude, frequency, damping, share }));
        }
    }
    match (best, too_short, near) {
        (Some((_, mode)), ..) if share >= EXPLAINED => Ok(mode),
        (Some(_), ..) => Err(Absence::NotModal { share }),
        (None, Some(periods), _) => Err(Absence::TooShort { periods, needed: PERIODS }),
        (None, None, Some(near)) => Err(Absence::NotThere { frequency: near, share: BAND }),
        (None, None, None) if fit.energy > CRUMB * CRUMB * series.values.len() as f64 => {
            Err(Absence::NotModal { share })
        }
        (None, None, None) => Err(Absence::NoVibration),
    }
}

/// Natural frequency (Hz), damping ratio and number of periods in `span` (s) of what counts as vibration.
fn oscillation(component: Component, span: f64) -> Option<(f64, f64, f64)> {
    let Component::Oscillation { decay, frequency } = component else { return None };
    let omega = libm::hypot(decay, frequency);
    let damping = decay / omega;
    (damping <= MAX_DAMPING).then_some((omega / (2.0 * PI), damping, frequency / (2.0 * PI) * span))
}

/// `factor` rounded down to a whole number, at least 1.
fn whole(factor: f64) -> usize {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates, which is meant")]
    let whole = factor as usize;
    whole.max(1)
}
