//! A record thinned out without aliasing and without bias.
//!
//! ```text
//! y'(k) = Σ_j w_j·y(k·M + j)      j = 0 … 4M − 1, w a Blackman window with Σw = 1
//! ```
//! The windowed mean of `e^{st}` is `G(s)·e^{st}` with `G(s) = Σ_j w_j·e^{s·j·h}`: every mode stays the same mode and
//! only its complex amplitude is multiplied by a number that is known exactly. Beyond three quarters of the new
//! rate, from where an oscillation could fold onto the mode of interest, the window lets less than 1/800 pass.
use core::f64::consts::PI;

/// Window length in units of the thinning.
const OVERLAP: usize = 4;

/// Values at equal steps, and their derivation from the record.
#[derive(Debug, Clone)]
pub(crate) struct Series {
    /// Values.
    pub(crate) values: Vec<f64>,
    /// Time of the first value (s).
    pub(crate) start: f64,
    /// Time from one value to the next (s).
    pub(crate) step: f64,
    /// The window, at the steps of the record.
    taps: Vec<f64>,
    /// Step of the record (s).
    fine: f64,
}

impl Series {
    /// Every `factor`th value of a record of `values` that begins at `start` (s) with steps of `fine` (s), at most
    /// `count` of them.
    pub(crate) fn thinned(values: &[f64], start: f64, fine: f64, factor: usize, count: usize) -> Self {
        let factor = factor.max(1);
        let taps = if factor == 1 { vec![1.0] } else { blackman(OVERLAP * factor) };
        let windows = values.windows(taps.len()).step_by(factor).take(count);
        let values = windows.map(|window| window.iter().zip(&taps).map(|(y, w)| y * w).sum()).collect();
        Self { values, start, step: fine * factor as f64, taps, fine }
    }

    /// Time of value `k` (s).
    pub(crate) fn time(&self, k: usize) -> f64 {
        self.start + k as f64 * self.step
    }

    /// Time from the first value to the last (s).
    pub(crate) fn length(&self) -> f64 {
        self.values.len().saturating_sub(1) as f64 * self.step
    }

    /// Standard deviation of white noise after thinning, relative to that in the record.
    pub(crate) fn noise_gain(&self) -> f64 {
        self.taps.iter().map(|tap| tap * tap).sum::<f64>().sqrt()
    }

    /// The complex gain (re, im) of the window for `e^{(−decay + i·frequency)·t}` (1/s, rad/s).
    pub(crate) fn gain(&self, decay: f64, frequency: f64) -> (f64, f64) {
        self.taps.iter().enumerate().fold((0.0, 0.0), |(re, im), (j, w)| {
            let t = j as f64 * self.fine;
            let (sin, cos) = libm::sincos(frequency * t);
            let envelope = w * libm::exp(-decay * t);
            (re + envelope * cos, im + envelope * sin)
        })
    }
}

/// Blackman window of `length` points without its zeros, with sum 1.
fn blackman(length: usize) -> Vec<f64> {
    let angle = |j: usize| 2.0 * PI * (j + 1) as f64 / (length + 1) as f64;
    let point = |j| 0.42 - 0.5 * libm::cos(angle(j)) + 0.08 * libm::cos(2.0 * angle(j));
    let sum: f64 = (0..length).map(point).sum();
    (0..length).map(|j| point(j) / sum).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The thinned series of a decaying oscillation is the oscillation times its gain, to rounding.
    #[test]
    fn a_mode_passes_with_a_known_gain() {
        let (sigma, omega, h) = (30.0, 2.0 * PI * 100.0, 1e-4);
        let at = |t: f64| (-sigma * t).exp() * (omega * t).cos();
        let record: Vec<f64> = (0..4000).map(|k| at(0.3e-4 + f64::from(k) * h)).collect();
        let series = Series::thinned(&record, 0.3e-4, h, 5, 500);
        let (re, im) = series.gain(sigma, omega);
        assert_eq!(series.values.len(), 500);
        assert!((0.9..1.1).contains(&(re * re + im * im).sqrt()), "the mode is in the pass band");
        for (k, y) in series.values.iter().enumerate() {
            let (t, envelope) = (series.time(k), (-sigma * series.time(k)).exp());
            let expected = envelope * (re * (omega * t).cos() - im * (omega * t).sin());
            assert!((y - expected).abs() < 1e-14, "{k}: {y} {expected}");
        }
    }

    /// An oscillation that would fold onto 1/16 of the new rate is suppressed.
    #[test]
    fn what_would_alias_is_suppressed() {
        let (h, factor) = (1e-4, 10);
        let rate = 1.0 / (h * factor as f64);
        for fold in [1.0, 2.0, 3.0] {
            for side in [-1.0, 1.0] {
                let omega = 2.0 * PI * rate * (fold + side / 16.0);
                let series = Series::thinned(&[], 0.0, h, factor, 1);
                let (re, im) = series.gain(0.0, omega);
                assert!((re * re + im * im).sqrt() < 1.0 / 800.0, "{fold} {side}");
            }
        }
    }

    #[test]
    fn factor_one_is_the_record() {
        let series = Series::thinned(&[1.0, 2.0, 3.0], 0.5, 0.1, 1, 2);
        assert_eq!((series.values.as_slice(), series.gain(5.0, 7.0)), ([1.0, 2.0].as_slice(), (1.0, 0.0)));
    }
}
