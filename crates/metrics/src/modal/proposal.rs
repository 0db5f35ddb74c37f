//! Frequencies at which a record seems to oscillate.
use super::Signal;
use super::fit::Fit;
use super::model::{Component, tail};
use super::order::{NOTHING, trend};
use super::series::Series;
use super::spectrum::{self, HIGHEST, LOWEST};

/// Values from which the tail is estimated.
const COARSE: usize = 512;
/// Share of a coarse step within which a tail that has ended tells little about the record in between.
const OVER: f64 = 0.5;

/// Frequencies (Hz) between `low` and `high` at which the record oscillates, once its slow tail is taken off; none for a
/// record that only drifts.
pub(crate) fn frequencies(signal: &Signal<'_>, low: f64, high: f64) -> Vec<f64> {
    let mut values = signal.values.to_vec();
    subtract_tail(&mut values, signal);
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    for y in &mut values {
        *y -= mean;
    }
    let rms = (values.iter().map(|y| y * y).sum::<f64>() / count).sqrt();
    if rms <= signal.resolution.max(NOTHING.sqrt()) {
        return Vec::new();
    }
    let low = low.max(LOWEST / (count * signal.step));
    spectrum::peaks(&values, signal.step, low, high.min(HIGHEST / signal.step))
}

/// Subtracts from `values` the tail of the signal, without its constant.
fn subtract_tail(values: &mut [f64], signal: &Signal<'_>) {
    let coarse = Series::thinned(signal.values, signal.start, signal.step, signal.values.len() / COARSE, usize::MAX);
    for (component, coefficients) in trend(&coarse).iter().flat_map(Fit::parts) {
        let Component::Tail { rate } = component else { continue };
        if rate * coarse.step >= OVER {
            continue;
        }
        // The thinned exponential is the record's own times its gain.
        let coefficient = coefficients[0] / coarse.gain(rate, 0.0).0;
        for (k, y) in values.iter_mut().enumerate() {
            *y -= coefficient * tail(rate, signal.start + k as f64 * signal.step, coarse.length());
        }
    }
}
