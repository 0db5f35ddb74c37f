//! The dominant mode of a record: natural frequency, damping and amplitude.
//!
//! ```text
//! y(t) = c + aperiodic tails + Σ e^{−ζωt}·(a·cos ω_d·t + b·sin ω_d·t)      ω_d = ω·√(1 − ζ²)
//! ```
//! fitted by least squares. Tails (real poles) take the settling of an integrator, further modes what else rings; so
//! neither falsifies the mode that is reported. Spectra only propose where to start. Components are added while each
//! removes at least a quarter of what is left; a mode counts only when one component more leaves it where it is.
//!
//! A long record is thinned without aliasing to at least 16 values per period of the fastest mode proposed, and its
//! first 4096 values are fitted: 128 periods or more.
//!
//! ```text
//! proposal → series → order (fit, refine, spectrum) → dominant
//! ```
mod columns;
mod dominant;
mod fit;
mod least_squares;
mod model;
mod order;
mod proposal;
mod refine;
mod series;
mod spectrum;
mod turns;

use crate::absence::Absence;
use crate::extremes::range_of;
use fit::Fit;
use model::Component;
use order::Order;
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
/// Half width of the band about a given frequency, relative.
const BAND: f64 = 0.25;
const VALUES_PER_PERIOD: f64 = 16.0;
const MAX_VALUES: usize = 4096;
/// A record that has more is not thinned to fewer: two dozen parameters fit two dozen values, whatever these are.
const MIN_VALUES: usize = 256;

/// The mode with the most energy in the record; with `near` (Hz), the one with the most energy within 25 % of it.
///
/// # Errors
/// [`Absence`]: nothing oscillates, the record is shorter than two periods, or a few decaying modes do not explain the
/// motion.
pub fn fit_mode(signal: &Signal<'_>, near: Option<f64>) -> Result<Mode, Absence> {
    if signal.values.len() < VALUES {
        return Err(Absence::TooShort { periods: 0.0, needed: PERIODS });
    }
    let (low, high) = range_of(signal.values);
    let height = high - low;
    if !height.is_finite() || height <= signal.resolution {
        return Err(Absence::NoVibration);
    }
    // Scaled to about 1, so that squares of nanometres keep far from the smallest numbers.
    let values: Vec<f64> = signal.values.iter().map(|y| (y - low) / height).collect();
    let signal = Signal { values: &values, resolution: signal.resolution / height, ..*signal };
    let band = near.map_or((0.0, f64::INFINITY), |near| (near * (1.0 - BAND), near * (1.0 + BAND)));
    let mut proposed = proposal::frequencies(&signal, band.0, band.1);
    if proposed.is_empty() {
        // A strongly damped mode need not show as a peak.
        proposed.extend(near);
    }
    let fastest = proposed.iter().copied().reduce(f64::max).ok_or(Absence::NoVibration)?;
    let series = Series::thinned(&values, signal.start, signal.step, thinning(&signal, fastest), MAX_VALUES);
    let order = Order::of(&series, &proposed, signal.resolution).ok_or(Absence::NoVibration)?;
    let mode = dominant::dominant(&order, &series, &signal, near)?;
    Ok(Mode { amplitude: mode.amplitude * height, ..mode })
}

/// The rest position of a record in which `mode` rings: the constant of the least squares fit of a constant and that mode.
/// `None` when the record cannot tell them apart.
pub(crate) fn rest_beside(mode: &Mode, values: &[f64], step: f64) -> Option<f64> {
    let first = *values.first()?;
    let values: Vec<f64> = values.iter().map(|y| y - first).collect();
    let series = Series::thinned(&values, 0.0, step, 1, usize::MAX);
    Some(first + Fit::of(vec![Component::oscillating_at(mode.frequency, mode.damping)], &series)?.constant())
}

/// How many values of the record make one of the series that is fitted.
fn thinning(signal: &Signal<'_>, fastest: f64) -> usize {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates, which is meant")]
    let factor = (1.0 / (VALUES_PER_PERIOD * fastest * signal.step)) as usize;
    factor.min(signal.values.len() / MIN_VALUES).max(1)
}
