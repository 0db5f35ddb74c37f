//! Iteration to a fixed point x = G(x) that is known only by its evaluations.
//!
//! With r = G(x) − x, and the changes of x and r from one evaluation to the next in the columns of ΔX and ΔR:
//!
//! ```text
//! relaxed        x ← x + ω·r
//! Aitken         ω ← −ω·(r₋ᵀ·Δr)/(Δrᵀ·Δr),  x ← x + ω·r
//! quasi-Newton   c = argmin ‖r + ΔR·c‖,      x ← x + ΔX·c + ω·(r + ΔR·c)
//! ```
//! Norms are weighted by the tolerance of each signal, so that metres and newtons can be added. The least squares are solved by
//! modified Gram–Schmidt from the newest column to the oldest; a column that adds no direction is dropped. For a linear G with n
//! signals, n columns make the step exact. Columns of previous steps are used again and dropped as soon as the residual
//! grows with them.
//!
//! Sources: Irons & Tuck, Int. J. Numer. Methods Eng. 1 (1969) 275; Küttler & Wall, Comput. Mech. 43 (2008) 61; Degroote, Bathe &
//! Vierendeels, "Performance of a new partitioned procedure versus a monolithic procedure in fluid–structure interaction",
//! Comput. Struct. 87 (2009) 793; Walker & Ni, "Anderson acceleration for fixed-point iterations", SIAM J. Numer. Anal. 49
//! (2011) 1715, with β = ω.
use crate::settings::Acceleration;

/// Most columns kept; loops with more signals converge within the span of these.
const MOST_COLUMNS: usize = 16;
/// A column that keeps less than this fraction of its length beside the newer ones is rounding.
const INDEPENDENT: f64 = 1e-7;
/// Bounds of Aitken's factor: beyond them two residuals were nearly equal.
const AITKEN: [f64; 2] = [1e-3, 1e3];

/// State of the iteration to the fixed point of one loop.
pub(crate) struct Accelerator {
    kind: Acceleration,
    signals: usize,
    /// Newest first.
    columns: Vec<Column>,
    /// Unused columns.
    spare: Vec<Column>,
    /// Number of columns from this step.
    own: usize,
    x: Vec<f64>,
    r: Vec<f64>,
    omega: f64,
    /// True if `x` and `r` are of this step.
    begun: bool,
    remainder: Vec<f64>,
}

#[derive(Default)]
struct Column {
    dx: Vec<f64>,
    dr: Vec<f64>,
    /// Weighted, and orthogonal to the newer ones.
    q: Vec<f64>,
    /// Components of `q` along each column: its triangular factor.
    along: [f64; MOST_COLUMNS],
    coefficient: f64,
}

impl Accelerator {
    pub(crate) fn new(kind: Acceleration, signals: usize) -> Self {
        let column = || Column {
            dx: vec![0.0; signals],
            dr: vec![0.0; signals],
            q: vec![0.0; signals],
            along: [0.0; MOST_COLUMNS],
            coefficient: 0.0,
        };
        let most = if matches!(kind, Acceleration::QuasiNewton(_)) { signals.min(MOST_COLUMNS) } else { 0 };
        Self {
            kind,
            signals,
            columns: Vec::with_capacity(most),
            spare: std::iter::repeat_with(column).take(most).collect(),
            own: 0,
            x: vec![0.0; signals],
            r: vec![0.0; signals],
            omega: 0.0,
            begun: false,
            remainder: vec![0.0; signals],
        }
    }

    /// Starts the search for a new fixed point.
    pub(crate) fn begin(&mut self) {
        self.begun = false;
        self.own = 0;
    }

    /// Advances x with its residual to the next x, in place. A weight is the inverse of a signal's tolerance.
    pub(crate) fn advance(&mut self, x: &mut [f64], r: &[f64], weights: &[f64]) {
        match self.kind {
            Acceleration::Relaxed(omega) => relax(x, r, omega),
            Acceleration::Aitken(first) => {
                self.omega = if self.begun { self.aitken(r, weights) } else { first };
                self.remember(x, r);
                relax(x, r, self.omega);
            }
            Acceleration::QuasiNewton(omega) => {
                if self.begun {
                    self.learn(x, r, weights);
                }
                self.remember(x, r);
                self.quasi_newton(x, r, weights, omega);
            }
        }
    }

    fn remember(&mut self, x: &[f64], r: &[f64]) {
        self.x.copy_from_slice(x);
        self.r.copy_from_slice(r);
        self.begun = true;
    }

    fn aitken(&self, r: &[f64], weights: &[f64]) -> f64 {
        let (mut along, mut square) = (0.0, 0.0);
        for ((now, before), weight) in r.iter().zip(&self.r).zip(weights) {
            let change = weight * (now - before);
            along += weight * before * change;
            square += change * change;
        }
        let omega = if square > 0.0 { -self.omega * along / square } else { self.omega };
        omega.abs().clamp(AITKEN[0], AITKEN[1]).copysign(omega)
    }

    /// Adds the column of the last two evaluations.
    fn learn(&mut self, x: &[f64], r: &[f64], weights: &[f64]) {
        if norm(r, weights) > norm(&self.r, weights) {
            self.spare.extend(self.columns.drain(self.own..));
        }
        let Some(mut column) = self.spare.pop().or_else(|| self.columns.pop()) else { return };
        for signal in 0..self.signals {
            column.dx[signal] = x[signal] - self.x[signal];
            column.dr[signal] = r[signal] - self.r[signal];
        }
        self.columns.insert(0, column);
        self.own = (self.own + 1).min(self.columns.len());
    }

    fn quasi_newton(&mut self, x: &mut [f64], r: &[f64], weights: &[f64], omega: f64) {
        self.orthogonalise(weights);
        self.remainder.iter_mut().zip(r).zip(weights).for_each(|((rest, r), weight)| *rest = weight * r);
        // The coefficients in the orthogonal basis, then back through the triangular factor.
        for column in &mut self.columns {
            column.coefficient = -dot(&column.q, &self.remainder);
            for (rest, q) in self.remainder.iter_mut().zip(&column.q) {
                *rest += column.coefficient * q;
            }
        }
        for i in (0..self.columns.len()).rev() {
            let (newer, rest) = self.columns.split_at_mut(i);
            rest[0].coefficient /= rest[0].along[i];
            for (j, column) in newer.iter_mut().enumerate() {
                column.coefficient -= rest[0].along[j] * rest[0].coefficient;
            }
        }
        for signal in 0..self.signals {
            let step: f64 = self.columns.iter().map(|column| column.coefficient * column.dx[signal]).sum();
            x[signal] += step + omega * self.remainder[signal] / weights[signal];
        }
    }

    /// Factors the weighted ΔR, and drops columns that add no direction.
    fn orthogonalise(&mut self, weights: &[f64]) {
        let mut i = 0;
        while i < self.columns.len() {
            let (newer, rest) = self.columns.split_at_mut(i);
            let column = &mut rest[0];
            for ((q, dr), weight) in column.q.iter_mut().zip(&column.dr).zip(weights) {
                *q = weight * dr;
            }
            let length = dot(&column.q, &column.q).sqrt();
            for (j, other) in newer.iter().enumerate() {
                column.along[j] = dot(&other.q, &column.q);
                for (q, o) in column.q.iter_mut().zip(&other.q) {
                    *q -= column.along[j] * o;
                }
            }
            let left = dot(&column.q, &column.q).sqrt();
            // Below one tolerance the difference of two evaluations shows their rounding, not the Jacobian.
            if left.is_finite() && left > INDEPENDENT * length && length > 1.0 {
                column.along[i] = left;
                column.q.iter_mut().for_each(|q| *q /= left);
                i += 1;
            } else {
                let dropped = self.columns.remove(i);
                self.spare.push(dropped);
                self.own -= usize::from(i < self.own);
            }
        }
    }
}

fn relax(x: &mut [f64], r: &[f64], omega: f64) {
    x.iter_mut().zip(r).for_each(|(x, r)| *x += omega * r);
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn norm(r: &[f64], weights: &[f64]) -> f64 {
    r.iter().zip(weights).map(|(r, weight)| (r * weight).powi(2)).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const TOLERANCE: f64 = 1e-10;

    /// Number of evaluations of `g` until x = G(x) is met to the tolerance; `None` after 200.
    fn evaluations<const N: usize>(kind: Acceleration, g: impl Fn(&[f64; N]) -> [f64; N]) -> Option<(u32, [f64; N])> {
        let mut accelerator = Accelerator::new(kind, N);
        let (mut x, weights) = ([0.0; N], [1.0 / TOLERANCE; N]);
        accelerator.begin();
        for evaluation in 1..=200 {
            let y = g(&x);
            let r: [f64; N] = std::array::from_fn(|i| y[i] - x[i]);
            if r.iter().all(|r| r.abs() <= TOLERANCE) {
                return Some((evaluation, y));
            }
            accelerator.advance(&mut x, &r, &weights);
        }
        None
    }

    /// G(x) = −3·x + 8 has the fixed point 2; its factor of −3 makes the plain iteration diverge. Two evaluations show the slope, the
    /// third is at the fixed point.
    #[test]
    fn one_signal_takes_three_evaluations_whatever_its_gain() {
        let g = |x: &[f64; 1]| [8.0 - 3.0 * x[0]];
        assert_eq!(evaluations(Acceleration::Relaxed(1.0), g), None);
        for kind in [Acceleration::Aitken(0.5), Acceleration::QuasiNewton(1.0)] {
            let (count, x) = evaluations(kind, g).unwrap();
            assert!(count == 3 && (x[0] - 2.0).abs() < 4.0 * TOLERANCE, "{kind:?}: {count}");
        }
        // ω = 1/(1 − λ) is exact, ω = 0.4 leaves 1 − 0.4·4 = −0.6 of the error each time: ln 1e-10/ln 0.6 = 45.
        assert_eq!(evaluations(Acceleration::Relaxed(0.25), g).unwrap().0, 2);
        assert!((45..52).contains(&evaluations(Acceleration::Relaxed(0.4), g).unwrap().0));
    }

    proptest! {
        /// Oracle: Newton's step is exact for linear G once its n directions are known: n + 2 evaluations, and one more for the
        /// rounding of a badly conditioned one. The error is at most the tolerance times ‖(1 − A)⁻¹‖, bounded by the diagonal.
        #[test]
        fn linear_loops_take_one_evaluation_for_each_signal(
            a in proptest::array::uniform9(-1.0..1.0_f64), b in proptest::array::uniform3(-1.0..1.0_f64)
        ) {
            // Diagonal dominance of 1 − A: 7 − (|a| + |a| + |a|) ≥ 4.
            let g = |x: &[f64; 3]| std::array::from_fn(|i| b[i] - 6.0 * x[i] + (0..3).map(|j| a[3 * i + j] * x[j]).sum::<f64>());
            let (count, x) = evaluations(Acceleration::QuasiNewton(1.0), g).unwrap();
            prop_assert!(count <= 6, "{} evaluations", count);
            let y: [f64; 3] = g(&x);
            for i in 0..3 {
                // x is G of an iterate that was met to the tolerance, and G magnifies by at most 9.
                prop_assert!((y[i] - x[i]).abs() < 9.0 * TOLERANCE);
            }
        }
    }

    /// Columns of one step serve the next: a linear loop with a changed constant takes two evaluations.
    #[test]
    fn what_was_learnt_is_used_again() {
        let mut accelerator = Accelerator::new(Acceleration::QuasiNewton(1.0), 2);
        let mut counts = Vec::new();
        let mut x = [0.0; 2];
        for step in 0..4 {
            accelerator.begin();
            let b = f64::from(step);
            for evaluation in 1.. {
                let r = [1.0 + b - 4.0 * x[0] + x[1], b - 2.0 * x[0] - 5.0 * x[1]];
                if r.iter().all(|r| r.abs() <= TOLERANCE) {
                    counts.push(evaluation);
                    break;
                }
                accelerator.advance(&mut x, &r, &[1.0 / TOLERANCE; 2]);
            }
        }
        assert_eq!(counts, [4, 2, 2, 2]);
    }
}
