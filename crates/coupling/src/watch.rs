//! Detection of a signal that grows because its exchange cannot follow it.
//!
//! The defect e of an exchange is the new value minus its prediction from the values before, extrapolated with order k. For a
//! signal that goes as zⁿ (a mode of the coupled simulation, z complex) it is
//!
//! ```text
//! e = (1 − 1/z)^(k+1)·y        so  Σe² ≥ ½·Σ(y − ȳ)²  ⇔  |1 − 1/z| ≥ 2^(−1/(2·(k+1))) = 0.71, 0.84, 0.89
//! ```
//!
//! if less than half of the variation of the signal was predicted. A mode that grows like this, |z| > 1, turns by more than 41° (50°, 53°)
//! in each exchange, fewer than nine values per turn (or grows more than 3.4-fold, which overflows soon): in any model it is not
//! resolved. A signal that grows and *is* resolved has z = e^(λH) near 1 and stays far below; a ramp or a jump has defects that do
//! not grow; noise and chatter qualify and do not grow either.
//!
//! Windows of [`WINDOW`] exchanges are judged, with weights that remove the growth since the previous window, and together with a
//! part of the windows before, so that the phase at which a short window meets a mode averages out. The signal has to reverse
//! in each of them: a mode that turns by θ = 41° or more in each exchange advances by at most sin 3θ/sin ½θ of a path of 6·2/π,
//! 0.63. A staircase, into which a sampled controller or a slower block turns a motion, is not predicted either, but goes in one
//! direction. The coupling counts as unstable when three or more windows in a row qualify and the mean square of their defects rises,
//! [`GROWTH`]-fold (in amplitude) in all. For noise of one level the mean square of six values would have to be 10⁻⁴ of its expectation
//! in one of them: (10⁻⁴·6)³/48, 10⁻¹². Defects below 10⁻⁹ of the greatest value so far are rounding.
use crate::rise::{Rise, Risen};

/// Exchanges in a window: most of a turn of a mode at the bound.
const WINDOW: usize = 6;
/// [`WINDOW`] as the number of a step.
const EXCHANGES: u32 = 6;
/// Smallest share of a signal's variance in its defects.
const UNEXPECTED: f64 = 0.5;
/// Weight of the previous windows in a window.
const FADING: f64 = 0.5;
/// Net advance of a signal in a window relative to its path, from which it counts as going in one direction.
const ONE_WAY: f64 = 0.7;
/// Required growth of the amplitude of the defects.
const GROWTH: f64 = 100.0;
/// Fraction of the greatest value that counts as rounding.
const ROUNDING: f64 = 1e-9;

/// State of the watch on one output.
#[derive(Debug, Clone, Default)]
pub(crate) struct Watch {
    /// Values and defects of the window.
    values: [f64; WINDOW],
    defects: [f64; WINDOW],
    exchanges: usize,
    /// Mean square of the defects of the previous window.
    level: f64,
    /// Shares of the defects and of the signal in the last windows.
    recent: [f64; 2],
    /// Value before the window.
    before: f64,
    greatest: f64,
    rise: Rise,
}

/// A growth that no exchange can follow.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Growth {
    pub(crate) factor: f64,
    pub(crate) exchanges: u32,
}

impl Watch {
    /// Adds an exchanged value with its defect.
    pub(crate) fn push(&mut self, value: f64, defect: f64) -> Option<Growth> {
        self.values[self.exchanges] = value;
        self.defects[self.exchanges] = defect;
        self.greatest = self.greatest.max(value.abs());
        self.exchanges += 1;
        if self.exchanges < WINDOW {
            return None;
        }
        self.exchanges = 0;
        let level = self.defects.iter().map(|e| e * e).sum::<f64>() / WINDOW as f64;
        let growth = if self.level > 0.0 { (level / self.level).max(1.0) } else { 1.0 };
        self.level = level;
        let ratio = growth.powf(-1.0 / WINDOW as f64);
        let (unexpected, variance) = self.sums(ratio);
        let turned = self.turns(ratio.sqrt());
        self.before = value;
        let whole = unexpected + variance;
        if whole > 0.0 {
            let [e, y] = self.recent;
            self.recent = [FADING * e + unexpected / whole, FADING * y + variance / whole];
        }
        let unresolved = self.recent[0] >= UNEXPECTED * self.recent[1] && turned;
        match self.rise.push(level, unresolved && level > (ROUNDING * self.greatest).powi(2)) {
            Risen::For { growth, windows } if growth >= GROWTH * GROWTH => {
                Some(Growth { factor: growth.sqrt(), exchanges: windows * EXCHANGES })
            }
            _ => None,
        }
    }

    /// True if the signal reverses in the window: |Σg·Δy| ≤ [`ONE_WAY`]·Σg·|Δy|, with a weight g that changes by `ratio`.
    fn turns(&self, ratio: f64) -> bool {
        let (mut before, mut weight, mut net, mut total) = (self.before, 1.0, 0.0, 0.0);
        for value in &self.values {
            let change: f64 = value - before;
            net += weight * change;
            total += weight * change.abs();
            (before, weight) = (*value, weight * ratio);
        }
        net.abs() <= ONE_WAY * total
    }

    /// Σg·e² and Σg·(y − ȳ)² as the variance of a sample, with a weight g that changes by `ratio` from each exchange to the next.
    fn sums(&self, ratio: f64) -> (f64, f64) {
        let (mut weight, mut weights, mut sum, mut squares, mut unexpected) = (1.0, 0.0, 0.0, 0.0, 0.0);
        for (value, defect) in self.values.iter().zip(&self.defects) {
            let deviation = value - self.values[0];
            weights += weight;
            sum += weight * deviation;
            squares += weight * deviation * deviation;
            unexpected += weight * defect * defect;
            weight *= ratio;
        }
        let sample = WINDOW as f64 / (WINDOW as f64 - 1.0);
        (unexpected, (squares - sum * sum / weights).max(0.0) * sample)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The defect of order `k`: a difference of order k + 1.
    fn defect(y: impl Fn(f64) -> f64, n: f64, k: u8) -> f64 {
        match k {
            0 => y(n) - y(n - 1.0),
            1 => y(n) - 2.0 * y(n - 1.0) + y(n - 2.0),
            _ => y(n) - 3.0 * y(n - 1.0) + 3.0 * y(n - 2.0) - y(n - 3.0),
        }
    }

    /// Number of exchanges of `y` after which a growth is found.
    fn found(y: impl Fn(f64) -> f64, k: u8, exchanges: u32) -> Option<u32> {
        let mut watch = Watch::default();
        (0..exchanges).find(|n| watch.push(y(f64::from(*n)), defect(&y, f64::from(*n), k)).is_some())
    }

    /// A mode that grows by `r` and turns by `angle` degrees in each exchange, on top of an offset.
    fn mode(r: f64, angle: f64) -> impl Fn(f64) -> f64 {
        move |n| 3.0 + 1e-4 * r.powf(n) * (angle.to_radians() * n + 0.3).cos()
    }

    /// Growth 100-fold takes ln 100/ln r exchanges after the first window that qualifies, counted in windows of six: at most three
    /// windows more than that. All angles are beyond the bound.
    #[test]
    fn a_growing_mode_that_is_not_resolved_is_found() {
        for k in 0..=2 {
            for r in [1.05_f64, 1.3, 2.0, 10.0] {
                for angle in [70.0, 90.0, 120.0, 150.0, 180.0] {
                    let most = 100.0_f64.ln() / r.ln() + 4.0 * WINDOW as f64;
                    let at = found(mode(r, angle), k, 1000);
                    assert!(at.is_some_and(|at| f64::from(at) <= most), "order {k}, {r} at {angle}: {at:?}");
                }
            }
        }
    }

    #[test]
    fn what_grows_and_is_resolved_is_not() {
        for k in 0..=2 {
            // A growing oscillation of twelve values to the turn, an exponential, a ramp, a parabola, a jump, a square wave.
            assert_eq!(found(mode(1.02, 30.0), k, 1000), None);
            assert_eq!(found(|n| (0.2 * n).exp(), k, 1000), None);
            assert_eq!(found(|n| 1e-3 * n, k, 1000), None);
            assert_eq!(found(|n| n * n, k, 1000), None);
            assert_eq!(found(|n| if n < 100.0 { 0.0 } else { 1e6 }, k, 1000), None);
            assert_eq!(found(|n| if n % 2.0 < 1.0 { 1.0 } else { -1.0 }, k, 1000), None);
            // The start of a move from rest.
            assert_eq!(found(|n| 1e-6 * n.max(0.0).powi(4), k, 1000), None);
            // A sampled or held motion, as by a controller or a slow block.
            for hold in 2..=8 {
                let hold = f64::from(hold);
                for power in 1..=6 {
                    assert_eq!(found(|n| 1e-6 * ((n / hold).floor() * hold).max(0.0).powi(power), k, 1000), None);
                }
            }
            // A mode that turns fast and decays, and one that just keeps its amplitude.
            assert_eq!(found(mode(0.9, 120.0), k, 1000), None);
            assert_eq!(found(mode(1.0, 120.0), k, 1000), None);
        }
    }

    /// Noise is not resolved, and its level is constant, even if it begins within a window. A million values from a generator of Knuth
    /// (TAOCP vol. 2, §3.3.4, table 1, line 26).
    #[test]
    fn noise_is_not() {
        let mut seed = 1_u64;
        let mut noise = move || {
            seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (seed >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
        };
        let mut values = vec![0.0; 1003];
        values.extend(std::iter::repeat_with(|| noise() + noise() + noise()).take(1_000_000));
        for k in 0..=2_u8 {
            let mut watch = Watch::default();
            for window in values.windows(4) {
                let differences = [window[3] - window[2], window[3] - 2.0 * window[2] + window[1]];
                let third = window[3] - 3.0 * window[2] + 3.0 * window[1] - window[0];
                let defect = [differences[0], differences[1], third][usize::from(k)];
                assert_eq!(watch.push(window[3], defect), None);
            }
        }
    }
}
