//! Oscillation frequencies of a record: peaks of its spectrum.
//!
//! Only the position of a peak leaves this module; the fit that starts there does not depend on the last bits of the
//! transform.
use super::turns::{TOGETHER, by_addition};
use core::f64::consts::PI;
use realfft::RealFftPlanner;
use realfft::num_complex::Complex;
use std::cell::RefCell;
use std::ops::Range;

/// Lowest frequency of the search, in cycles per record.
pub(crate) const LOWEST: f64 = 0.7;
/// Highest frequency of the search, in cycles per step.
pub(crate) const HIGHEST: f64 = 0.45;
/// Peaks lower than this share of the highest one are ignored.
const FAINT: f64 = 0.01;
/// Bins whose powers differ by less than this share count as equal; the lowest frequency wins.
const EQUAL: f64 = 2e-9;

/// Frequencies (Hz) of the highest peaks between `low` and `high` of `values` with steps of `step` (s), equal ones once.
/// Under a Hann window, in which a lasting mode stands out from a drift; under its falling half, in which a mode that
/// dies early shows, and a decay has no side lobes that would pass for peaks. Of the position, and of the velocity, in
/// which a fast mode stands out from a slow one.
pub(crate) fn peaks(values: &[f64], step: f64, low: f64, high: f64) -> Vec<f64> {
    let length = padded(values.len());
    let resolution = 1.0 / (length as f64 * step);
    let inside = |k: usize| (low..=high).contains(&(k as f64 * resolution));
    let mut found: Vec<f64> = Vec::with_capacity(4);
    for powers in windowed(values, length) {
        let first = (0..powers.len()).find(|k| inside(*k)).unwrap_or(powers.len());
        let count = (first..powers.len()).take_while(|k| inside(*k)).count();
        let bins = first..first + count;
        let largest = powers[bins.clone()].iter().fold(0.0, |most: f64, power| most.max(*power));
        let slow = highest(&powers, bins.clone(), 0.0, |_| 1.0);
        let fast = highest(&powers, bins, FAINT * FAINT * largest, |k| (k * k) as f64);
        for bin in [slow, fast].into_iter().flatten() {
            let frequency = bin as f64 * resolution;
            if !found.iter().any(|other| (other - frequency).abs() < 2.0 * resolution) {
                found.push(frequency);
            }
        }
    }
    found
}

/// Length of the transform of `count` values: at least twice as long, so that a peak is found to a quarter of a cycle, and a power of
/// two or three times one.
fn padded(count: usize) -> usize {
    let power = (2 * count).next_power_of_two();
    if 3 * power / 4 >= 2 * count && power >= 4 { 3 * power / 4 } else { power }
}

/// Bin of the highest local maximum of `power × weight` among the `bins` that have at least `least`.
fn highest(powers: &[f64], bins: Range<usize>, least: f64, weight: impl Fn(usize) -> f64) -> Option<usize> {
    let mut best: Option<(usize, f64)> = None;
    for k in bins.start.max(1)..bins.end.min(powers.len().saturating_sub(1)) {
        let (before, here, after) = (powers[k - 1], powers[k], powers[k + 1]);
        if here >= before && here >= after && here >= least {
            let height = here * weight(k);
            if best.is_none_or(|(_, best)| height > best * (1.0 + EQUAL)) {
                best = Some((k, height));
            }
        }
    }
    best.filter(|(_, height)| *height > 0.0).map(|(bin, _)| bin)
}

struct Transforms(RealFftPlanner<f64>);

impl Default for Transforms {
    fn default() -> Self {
        Self(RealFftPlanner::new())
    }
}

/// Longest transform whose memory is kept for the next one, 2 MB in all.
const KEPT: usize = 1 << 16;

/// Buffers of the transforms, kept because a suite needs the same lengths again and again.
#[derive(Default)]
struct Bench {
    transforms: Transforms,
    under_hann: Vec<f64>,
    under_half: Vec<f64>,
    output: Vec<Complex<f64>>,
    scratch: Vec<Complex<f64>>,
}

thread_local! {
    static BENCH: RefCell<Bench> = RefCell::new(Bench::default());
}

/// Squared magnitudes of the spectra of `values`, padded to `length`, under a Hann window and under its falling half.
fn windowed(values: &[f64], length: usize) -> [Vec<f64>; 2] {
    BENCH.with_borrow_mut(|bench| {
        let powers = bench.windowed(values, length);
        if length > KEPT {
            *bench = Bench::default();
        }
        powers
    })
}

impl Bench {
    fn windowed(&mut self, values: &[f64], length: usize) -> [Vec<f64>; 2] {
        let Self { transforms: Transforms(planner), under_hann, under_half, output, scratch } = self;
        let count = values.len();
        let transform = planner.plan_fft_forward(length);
        output.resize(length / 2 + 1, Complex::default());
        scratch.resize(transform.get_scratch_len(), Complex::default());
        for input in [&mut *under_hann, &mut *under_half] {
            input.resize(length, 0.0);
            input[count..].fill(0.0);
        }
        let inputs = under_hann.chunks_mut(TOGETHER).zip(under_half.chunks_mut(TOGETHER));
        let mut first = 0;
        for ((under_hann, under_half), values) in inputs.zip(values.chunks(TOGETHER)) {
            let cosines = half_turn(first, values.len(), count);
            for (((hann, half), y), cos) in under_hann.iter_mut().zip(under_half).zip(values).zip(cosines) {
                // ½ − ½·cos 2φ and ½ + ½·cos φ.
                *hann = y * (1.0 - cos * cos);
                *half = y * (0.5 + 0.5 * cos);
            }
            first += values.len();
        }
        [under_hann, under_half].map(|input| match transform.process_with_scratch(input, output, scratch) {
            Ok(()) => output.iter().map(|z| z.re * z.re + z.im * z.im).collect(),
            // Lengths are those that the transform requires; without a spectrum there is no peak.
            Err(_) => Vec::new(),
        })
    }
}

/// Cosines of `length` of `count` angles that cover half a turn evenly, each in the middle of its share, from the one at `first` on;
/// at most [`TOGETHER`].
fn half_turn(first: usize, length: usize, count: usize) -> [f64; TOGETHER] {
    let share = PI / count as f64;
    let turned = |angle: f64| {
        let (sin, cos) = libm::sincos(angle);
        (cos, sin)
    };
    let (mut cosines, mut sines) = ([0.0; TOGETHER], [0.0; TOGETHER]);
    let fresh = |k: usize| turned(((first + k) as f64 + 0.5) * share);
    by_addition(fresh, turned(share), 1.0, &mut cosines[..length], &mut sines[..length]);
    cosines
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

    /// A mode of ζ = 0.05 that is over after a tenth of the record peaks within ζ·f of its frequency.
    #[test]
    fn a_mode_that_dies_early_shows() {
        let values = record(|t| (-0.05 * 2.0 * PI * 40.0 * t).exp() * (2.0 * PI * 40.0 * t).sin());
        assert!(peaks(&values, 1e-3, 1.0, 400.0).iter().any(|f| (f - 40.0).abs() < 2.0));
    }

    #[test]
    fn a_decay_has_no_fast_peak() {
        let values = record(|t| (-t / 0.3).exp());
        let found = peaks(&values, 1e-3, 1.0, 400.0);
        assert!(found.iter().all(|f| *f < 2.0), "{found:?}");
    }

    #[test]
    fn half_a_turn_is_gone_through_evenly() {
        for count in [1, 2, 63, 64, 65, 4097] {
            let stretches = (0..count).step_by(TOGETHER).map(|first| (first, TOGETHER.min(count - first)));
            let cosines =
                stretches.flat_map(|(first, length)| half_turn(first, length, count).into_iter().take(length));
            for (k, cos) in cosines.enumerate() {
                let expected = (PI * (k as f64 + 0.5) / count as f64).cos();
                assert!((cos - expected).abs() < 1e-13, "{k} of {count}: {cos} {expected}");
            }
        }
    }

    #[test]
    fn silence_has_no_peak() {
        assert!(peaks(&[0.0; 100], 1e-3, 1.0, 400.0).is_empty());
    }
}
