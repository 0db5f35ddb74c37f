//! Moving averages in continuous time, one after the other.
use super::Vibration;
use crate::PlanError;
use crate::limits::in_range;
use servobench_base::{Setpoint, finite, positive};

/// `N` moving averages, 1 to 4, of lengths `T1 … Tn` (s): each outputs the mean of its input over the last `T_k` seconds.
///
/// ```text
/// H(s) = ∏ (1 − e^(−s·T_k))/(s·T_k) = 1/(sᴺ·∏T)·Σ_S (−1)^|S|·e^(−s·ΣS)       over the subsets S of the lengths
/// ```
///
/// So the output is a sum of 2ᴺ shifted copies of the N-fold integral of the input. A step becomes the profile of order N with
/// these lengths.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MovingAverages<const N: usize> {
    /// In ascending order.
    lengths: [f64; N],
}

impl<const N: usize> MovingAverages<N> {
    const FEW: () = assert!(N >= 1 && N <= MOST, "1 to 4 averages: orders of a set-point");

    /// Averages of these lengths (s), in any order.
    ///
    /// # Errors
    /// [`PlanError`] when a length is not between 1e-30 and 1e30 s.
    pub fn new(mut lengths: [f64; N]) -> Result<Self, PlanError> {
        const { Self::FEW };
        for length in lengths {
            in_range("length", positive("length", length)?, "correct its unit")?;
        }
        lengths.sort_unstable_by(f64::total_cmp);
        Ok(Self { lengths })
    }

    /// Time that they add to a move (s), ΣT.
    #[must_use]
    pub fn duration(&self) -> f64 {
        self.lengths.iter().sum()
    }

    /// Delay of a ramp (s), half the [`duration`](Self::duration).
    #[must_use]
    pub fn delay(&self) -> f64 {
        0.5 * self.duration()
    }

    /// The set-point at `t` (s) of a step of `distance` (m or rad) at t = 0: a move of order `N`, at exactly `distance` from
    /// the end on. Derivatives above the order are impulses and left out.
    ///
    /// The velocity is `distance` times the density M of the sum of N numbers, each uniform in `0 … T_k`, by the recursion
    /// of box splines, in which nothing cancels however different the lengths are (de Boor & Höllig, *B-splines from
    /// parallelepipeds*, J. d'Analyse Mathématique 42 (1982)); n of them, the fraction τ = t/ΣT passed:
    ///
    /// ```text
    /// (n − 1)·M(t) = Σ_k τ·M_without_k(t) + (1 − τ)·M_without_k(t − T_k)            M of one: 1/T within 0 … T
    /// x/distance = ΣT·M_with_ΣT(t)                  a/distance = (M_without_n(t) − M_without_n(t − T_n))/T_n, and so on
    /// ```
    ///
    /// # Errors
    /// [`PlanError`] when the time is not finite or the distance is neither 0 nor between 1e-30 and 1e30.
    pub fn of_step(&self, t: f64, distance: f64) -> Result<Setpoint, PlanError> {
        let t = finite("t", t)?;
        let distance = finite("distance", distance)? + 0.0;
        if distance != 0.0 {
            in_range("distance", distance, "correct its unit, or request a distance of 0")?;
        }
        let duration = self.duration();
        if t < 0.0 {
            return Ok(Setpoint::default());
        }
        if t >= duration {
            return Ok(Setpoint::at_rest(distance));
        }
        let mut with_all = [duration; MOST + 1];
        with_all[..N].copy_from_slice(&self.lengths);
        // Rounding must not pass the target.
        let x = (duration * density(&with_all[..=N], t)).min(1.0);
        let rate = |k| rate(&self.lengths, t, k);
        Ok(Setpoint { x, v: rate(0), a: rate(1), j: rate(2), s: rate(3) }.scaled(distance))
    }

    /// Residual vibration of a mode, relative to that without averages, at the end of the last one:
    /// `∏ |1 − e^((−ζω + jω_d)·T_k)|/(ω·T_k)`.
    ///
    /// Zero for an undamped mode when a length is a whole number of periods.
    #[must_use]
    pub fn residual(&self, vibration: &Vibration) -> f64 {
        let one = |length: &f64| {
            let decay = vibration.decay() * length;
            let turn = libm::sin(0.5 * vibration.omega_d() * length);
            // |1 − e^(−d + jφ)|² = (1 − e^(−d))² + 4·e^(−d)·sin²(φ/2)
            let root = libm::hypot(libm::expm1(-decay), 2.0 * libm::exp(-0.5 * decay) * turn);
            root / (vibration.omega_n() * length)
        };
        self.lengths.iter().map(one).product()
    }
}

/// Maximum number of averages.
const MOST: usize = 4;

/// Derivative `k` of the density; 0 if it consists of impulses.
fn rate(lengths: &[f64], t: f64, k: usize) -> f64 {
    match lengths {
        _ if k == 0 => density(lengths, t),
        [] | [_] => 0.0,
        [rest @ .., longest] => (rate(rest, t, k - 1) - rate(rest, t - longest, k - 1)) / longest,
    }
}

/// Density of the sum of numbers that are uniform in 0 up to each of the `lengths`, at most five.
fn density(lengths: &[f64], t: f64) -> f64 {
    let sum: f64 = lengths.iter().sum();
    if !(0.0..sum).contains(&t) {
        return 0.0;
    }
    if let [length] = lengths {
        return 1.0 / length;
    }
    let (passed, others) = (t / sum, lengths.len() - 1);
    let mut total = 0.0;
    for (k, length) in lengths.iter().enumerate() {
        let mut rest = [0.0; MOST];
        rest[..k].copy_from_slice(&lengths[..k]);
        rest[k..others].copy_from_slice(&lengths[k + 1..]);
        let rest = &rest[..others];
        total += passed * density(rest, t) + (1.0 - passed) * density(rest, t - length);
    }
    total / others as f64
}
