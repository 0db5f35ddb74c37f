//! Where a record oscillates: peaks of its spectrum.
//!
//! Only the position of a peak leaves this module; the fit that starts there does not depend on the last bits of the
//! transform.
use core::f64::consts::PI;
use realfft::RealFftPlanner;

/// Peaks lower than this share of the highest one are not looked at.
const FAINT: f64 = 0.02;
/// Bins whose magnitudes differ by less than this share count as equal; the lowest frequency wins.
const EQUAL: f64 = 1e-9;

/// Frequencies (Hz) of the highest peaks between `low` and `high` of `values` with steps of `step` (s): of the bare
/// record, in which a mode that dies early shows best, and under a Hann window, in which a lasting mode stands out from
/// a drift; of the position, and of the velocity, in which a fast mode stands out from a slow one. Equal ones once.
pub(crate) fn peaks(values: &[f64], step: f64, low: f64, high: f64) -> Vec<f64> {
    let length = (2 * values.len()).next_power_of_two();
    let resolution = 1.0 / (length as f64 * step);
    let bare = magnitudes(values.iter().copied(), length);
    let count = values.len() as f64;
    let hann = |k: usize| 0.5 - 0.5 * libm::cos(2.0 * PI * (k as f64 + 0.5) / count);
    let windowed = magnitudes(values.iter().enumerate().map(|(k, y)| hann(k) * y), length);
    let inside = |k: usize| (low..=high).contains(&(k as f64 * resolution));
    let mut found: Vec<f64> = Vec::with_capacity(4);
    for magnitudes in [&windowed, &bare] {
        let largest = magnitudes.iter().enumerate().filter(|(k, _)| inside(*k)).fold(0.0, |m: f64, (_, x)| m.max(*x));
        let loud = |k: usize| inside(k) && magnitudes[k] >= FAINT * largest;
        for bin in [highest(magnitudes, inside, |_| 1.0), highest(magnitudes, loud, |k| k as f64)].into_iter().flatten()
        {
            let frequency = bin as f64 * resolution;
            if !found.iter().any(|other| (other - frequency).abs() < 2.0 * resolution) {
                found.push(frequency);
            }
        }
    }
    found
}

/// Bin of the highest local maximum of `magnitude × weight` among the bins `inside`.
fn highest(magnitudes: &[f64], inside: impl Fn(usize) -> bool, weight: impl Fn(usize) -> f64) -> Option<usize> {
    let mut best: Option<(usize, f64)> = None;
    for k in 1..magnitudes.len().saturating_sub(1) {
        let (before, here, after) = (magnitudes[k - 1], magnitudes[k], magnitudes[k + 1]);
        let height = here * weight(k);
        if inside(k) && here >= before && here >= after && best.is_none_or(|(_, b)| height > b * (1.0 + EQUAL)) {
            best = Some((k, height));
        }
    }
    best.filter(|(_, height)| *height > 0.0).map(|(bin, _)| bin)
}

fn magnitudes(values: impl Iterator<Item = f64>, length: usize) -> Vec<f64> {
    let transform = RealFftPlanner::<f64>::new().plan_fft_forward(length);
    let mut input = transform.make_input_vec();
    input.iter_mut().zip(values).for_each(|(slot, y)| *slot = y);
    let mut output = transform.make_output_vec();
    match transform.process(&mut input, &mut output) {
        Ok(()) => output.iter().map(|z| (z.re * z.re + z.im * z.im).sqrt()).collect(),
        // Lengths are those that the transform asked for; without a spectrum there is no peak.
        Err(_) => Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn record(at: impl Fn(f64) -> f64) -> Vec<f64> {
        (0..4000).map(|k| at(f64::from(k) * 1e-3)).collect()
    }

    /// A peak is found to half a bin of the padded transform, 1/8.192 s.
    #[test]
    fn a_tone_is_found_to_half_a_bin() {
        let values = record(|t| (2.0 * PI * 38.9 * t + 0.3).sin());
        let found = peaks(&values, 1e-3, 1.0, 400.0);
        assert!(!found.is_empty() && found.iter().all(|f| (f - 38.9).abs() < 0.13), "{found:?}");
        assert!(peaks(&values, 1e-3, 60.0, 400.0).iter().all(|f| *f >= 60.0));
    }

    #[test]
    fn a_fast_mode_shows_beside_a_slow_one() {
        let values = record(|t| (2.0 * PI * 5.0 * t).sin() + 0.1 * (2.0 * PI * 150.0 * t).sin());
        let found = peaks(&values, 1e-3, 1.0, 400.0);
        assert!(found.iter().any(|f| (f - 5.0).abs() < 0.13) && found.iter().any(|f| (f - 150.0).abs() < 0.13));
    }

    #[test]
    fn silence_has_no_peak() {
        assert!(peaks(&[0.0; 100], 1e-3, 1.0, 400.0).is_empty());
    }
}
