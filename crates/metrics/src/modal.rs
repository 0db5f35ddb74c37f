//! The dominant mode of a record: natural frequency, damping and amplitude.
//!
//! ```text
//! y(t) = c + aperiodic tails + Σ e^{−ζωt}·(a·cos ω_d·t + b·sin ω_d·t)      ω_d = ω·√(1 − ζ²)
//! ```
//! fitted by least squares. Tails (real poles) take the settling of an integrator, further modes take other oscillations; so
//! neither falsifies the reported mode. Spectra only propose starting points. Components are added until nothing that matters is left,
//! while each removes at least a quarter of the remainder. A motion that they do not explain (stick-slip, a limit cycle) is described by
//! its swings.
//!
//! A long record is thinned without aliasing to at least 16 values per period of the fastest mode proposed, and its
//! first 4096 values are fitted: 128 periods or more.
//!
//! ```text
//! proposal → series → order (fit, refine, spectrum, noise) → dominant, or swings
//! ```
mod columns;
mod dominant;
mod fit;
mod least_squares;
mod model;
mod noise;
mod order;
mod proposal;
mod refine;
mod series;
mod spectrum;
mod swings;
mod turns;

use crate::absence::Absence;
use crate::extremes::range_of;
use dominant::{Found, Unfit};
use fit::Fit;
use model::Component;
use order::Order;
use series::Series;
use swings::Swings;

/// A record of a motion without input.
#[derive(Debug, Clone, Copy)]
pub struct Signal<'a> {
    /// Deviation from rest (any unit).
    pub values: &'a [f64],
    /// Time of the first value (s), counted from the instant to which the amplitude refers.
    pub start: f64,
    /// Time from one value to the next (s).
    pub step: f64,
    /// Resolution of the values: their rounding, or the step of a sensor.
    pub resolution: f64,
    /// Smallest vibration that matters (unit of the values).
    pub least: f64,
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

/// Vibration of a record.
#[derive(Debug, Clone, PartialEq)]
pub struct Vibration {
    /// Envelope of the dominant mode at time 0; where no mode could be fitted, half of the largest swing; 0 where nothing swings (unit
    /// of the values).
    pub amplitude: f64,
    /// Natural frequency of the mode, or one over twice the mean time between two reversals (Hz).
    pub frequency: Result<f64, Absence>,
    /// Damping ratio ζ of the mode; negative when the oscillation grows.
    pub damping: Result<f64, Absence>,
    /// Share of the oscillation's energy that all fitted modes explain, 0 to 1.
    pub share: Result<f64, Absence>,
}

/// Minimum periods of a record.
const PERIODS: f64 = 2.0;
/// Minimum values of a record.
const VALUES: usize = 16;
/// Half width of the band about a given frequency, relative.
const BAND: f64 = 0.25;
const VALUES_PER_PERIOD: f64 = 16.0;
const MAX_VALUES: usize = 4096;
/// Minimum number of values after thinning: two dozen parameters would fit any two dozen values.
const MIN_VALUES: usize = 256;

impl Vibration {
    /// No vibration: the record rests or drifts in one direction.
    fn none() -> Self {
        let absent = || Err(Absence::NoVibration);
        Self { amplitude: 0.0, frequency: absent(), damping: absent(), share: absent() }
    }

    /// Vibration from `swings` that are not a sum of modes, for the reason `unfit`.
    fn of_swings(swings: Swings, unfit: Unfit) -> Self {
        let too_short = |periods| Absence::TooShort { periods, needed: PERIODS };
        let (damping, share) = match unfit {
            Unfit::TooShort { periods } => (too_short(periods), too_short(periods)),
            Unfit::Sticks => (Absence::AmplitudeDependent, Absence::Sticks),
            Unfit::NotModal { share } => (Absence::AmplitudeDependent, Absence::NotModal { share }),
            Unfit::Settles | Unfit::Elsewhere => (Absence::AmplitudeDependent, Absence::AmplitudeDependent),
        };
        let frequency = swings.frequency.ok_or(too_short(swings.periods));
        Self { amplitude: swings.amplitude, frequency, damping: Err(damping), share: Err(share) }
    }

    /// The mode of the record, if one could be fitted that is seen for two periods.
    ///
    /// # Errors
    /// [`Absence`] of its damping ratio.
    pub fn mode(&self) -> Result<Mode, Absence> {
        let (frequency, damping, share) = (self.frequency.clone()?, self.damping.clone()?, self.share.clone()?);
        Ok(Mode { amplitude: self.amplitude, frequency, damping, share })
    }
}

/// The vibration of a record: of its mode with the most energy, or, where it is not a sum of a few decaying modes, of its swings. With
/// `near` (Hz), within 25 % of that frequency.
///
/// # Errors
/// [`Absence`]: the record has fewer than 16 values, or swings at another frequency than `near`.
pub fn vibration(signal: &Signal<'_>, near: Option<f64>) -> Result<Vibration, Absence> {
    if signal.values.len() < VALUES {
        return Err(Absence::TooShort { periods: 0.0, needed: PERIODS });
    }
    let (low, high) = range_of(signal.values);
    let height = high - low;
    if !height.is_finite() {
        return Err(Absence::NoVibration);
    }
    if height <= signal.resolution.max(signal.least) {
        return Ok(Vibration::none());
    }
    // Scaled to about 1, so that squares of nanometres stay far from the smallest numbers.
    let values: Vec<f64> = signal.values.iter().map(|y| (y - low) / height).collect();
    let (resolution, least) = (signal.resolution / height, signal.least / height);
    let scaled = Signal { values: &values, resolution, least, ..*signal };
    let unfit = match fitted(&scaled, near) {
        Ok(Found { mode, periods }) => {
            let seen = |value: f64| {
                if periods >= PERIODS { Ok(value) } else { Err(Absence::Damped { periods, needed: PERIODS }) }
            };
            return Ok(Vibration {
                amplitude: mode.amplitude * height,
                frequency: seen(mode.frequency),
                damping: seen(mode.damping),
                share: Ok(mode.share),
            });
        }
        Err(Unfit::Settles) => return Ok(Vibration::none()),
        Err(unfit) => unfit,
    };
    let Some(swings) = Swings::of(&values, scaled.step, hysteresis(&scaled)) else { return Ok(Vibration::none()) };
    let swings = Swings { amplitude: swings.amplitude * height, ..swings };
    match (near, swings.frequency, unfit) {
        (Some(near), _, Unfit::Elsewhere) => Err(Absence::NotThere { frequency: near, share: BAND }),
        (Some(near), Some(found), _) if (found - near).abs() > BAND * near => {
            Err(Absence::NotThere { frequency: near, share: BAND })
        }
        _ => Ok(Vibration::of_swings(swings, unfit)),
    }
}

/// The mode with the most energy in the record; with `near` (Hz), the one with the most energy within 25 % of it.
///
/// # Errors
/// [`Absence`]: nothing oscillates, the record or the oscillation is shorter than two periods, or a few decaying modes do not explain the
/// motion.
pub fn fit_mode(signal: &Signal<'_>, near: Option<f64>) -> Result<Mode, Absence> {
    vibration(signal, near)?.mode()
}

/// The mode that is fitted to `signal`, a record of height 1.
fn fitted(signal: &Signal<'_>, near: Option<f64>) -> Result<Found, Unfit> {
    let band = near.map_or((0.0, f64::INFINITY), |near| (near * (1.0 - BAND), near * (1.0 + BAND)));
    let mut proposed = proposal::frequencies(signal, band.0, band.1);
    if proposed.is_empty() {
        // A strongly damped mode need not show as a peak.
        proposed.extend(near);
    }
    let fastest = proposed.iter().copied().reduce(f64::max).ok_or(Unfit::NotModal { share: 0.0 })?;
    let series = Series::thinned(signal.values, signal.start, signal.step, thinning(signal, fastest), MAX_VALUES);
    let noise = noise::DEVIATIONS * noise::deviation(signal.values) * series.noise_gain();
    let least = signal.least.max(signal.resolution).max(noise);
    let order = Order::of(&series, &proposed, least).ok_or(Unfit::NotModal { share: 0.0 })?;
    dominant::dominant(&order, &series, signal, near, least)
}

/// Hysteresis that the swings of a record must exceed: the largest of the smallest vibration that matters, the resolution and the
/// peak-to-peak value of noise.
fn hysteresis(signal: &Signal<'_>) -> f64 {
    signal.least.max(signal.resolution).max(2.0 * noise::DEVIATIONS * noise::deviation(signal.values))
}

/// The rest position of a record in which `mode` rings: the constant of the least squares fit of a constant and that mode.
/// `None` when the record does not separate them.
pub(crate) fn rest_beside(mode: &Mode, values: &[f64], step: f64) -> Option<f64> {
    let first = *values.first()?;
    let values: Vec<f64> = values.iter().map(|y| y - first).collect();
    let series = Series::thinned(&values, 0.0, step, 1, usize::MAX);
    Some(first + Fit::of(vec![Component::oscillating_at(mode.frequency, mode.damping)], &series)?.constant())
}

/// Number of values of the record per value of the series that is fitted.
fn thinning(signal: &Signal<'_>, fastest: f64) -> usize {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates, which is meant")]
    let factor = (1.0 / (VALUES_PER_PERIOD * fastest * signal.step)) as usize;
    factor.min(signal.values.len() / MIN_VALUES).max(1)
}
