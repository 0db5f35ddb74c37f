//! Eigenvalues of the loop over a period, with bounds of their rounding errors.
//!
//! The matrix M of a period is a product that was rounded. An eigenvalue from it is therefore refined on the ticks
//! themselves, with its right and left eigenvectors v and y:
//!
//! ```text
//! v_0 = v,  v_{j+1} = A_j·v_j        y_N = y,  y_j = A_jᵀ·y_{j+1}        λ = yᵀ·v_N / yᵀ·v
//! ```
//! To first order an error of the tick matrices, |ΔA_j| ≤ γ·|A_j| entry by entry, and the remaining residual
//! r = v_N − λ·v move it by at most
//!
//! ```text
//! |Δλ| ≤ (γ·Σ_j |y_{j+1}|ᵀ·|A_j|·|v_j| + |y|ᵀ·|r|) / |yᵀ·v|,        γ = 4·n·u
//! ```
//! n states, u = 2⁻⁵³: an entry is a sum of at most n products of two tables of this kind, and so is the vector's path through
//! it. A pole is outside the unit circle when |λ| − 1 exceeds this. The condition of λ, |y|ᵀ|v|/|yᵀ·v|, is part of it: for two poles
//! that meet it is infinite.
//! Source: Golub & Van Loan, *Matrix Computations*, 4th ed., §7.2.2; Higham, *Accuracy and Stability*, 2nd ed., §3.
use crate::error::StabilityError;
use crate::period::{ComplexVector, Period};
use crate::qr;
use nalgebra::linalg::balancing::balance_parlett_reinsch;
use nalgebra::{Complex, DMatrix};

/// Bound of the relative error of a tick on a vector, per state: 4·u.
const ROUNDING: f64 = 4.0 * f64::EPSILON / 2.0;

/// A loop of the structure with its eigenvalues.
pub(crate) struct Block {
    /// Its states.
    pub(crate) states: Vec<usize>,
    /// Its part of M, balanced: D⁻¹·M·D.
    balanced: DMatrix<f64>,
    /// D.
    scales: Vec<f64>,
    pub(crate) eigenvalues: Vec<Complex<f64>>,
}

/// A refined eigenvalue.
pub(crate) struct Eigenvalue {
    pub(crate) value: Complex<f64>,
    /// Bound of its error.
    pub(crate) bound: f64,
    /// The right eigenvector before the period and after each tick.
    pub(crate) states: Vec<ComplexVector>,
}

/// The loops of `period`, each with its eigenvalues.
///
/// # Errors
/// [`StabilityError::NotConverged`].
pub(crate) fn blocks(period: &Period) -> Result<Vec<Block>, StabilityError> {
    period.loops.iter().map(|states| Block::new(period, states.clone())).collect()
}

impl Block {
    fn new(period: &Period, states: Vec<usize>) -> Result<Self, StabilityError> {
        let size = states.len();
        let mut balanced = DMatrix::from_fn(size, size, |i, j| period.monodromy[(states[i], states[j])]);
        let scales = balance_parlett_reinsch(&mut balanced).iter().copied().collect();
        let eigenvalues =
            qr::eigenvalues(&balanced).ok_or(StabilityError::NotConverged { iterations: qr::ITERATIONS })?;
        Ok(Self { states, balanced, scales, eigenvalues })
    }

    /// Refines `value`, one of the eigenvalues.
    pub(crate) fn refine(&self, period: &Period, value: Complex<f64>) -> Eigenvalue {
        let size = period.monodromy.nrows();
        let right = self.extended(size, &vector(&self.balanced, value), |scale| scale);
        let left = self.extended(size, &vector(&self.balanced.transpose(), value), |scale| 1.0 / scale);
        let (states, rows) = (period.forward(right), period.backward(left));
        let (before, after) = (&states[0], &states[states.len() - 1]);
        let left = &rows[rows.len() - 1];
        let product = |vector: &ComplexVector| self.states.iter().map(|&i| left[i] * vector[i]).sum::<Complex<f64>>();
        let scale = product(before);
        let refined = product(after) / scale;
        // A real eigenvalue has no partner with which it could have become a pair.
        let value = if value.im == 0.0 { Complex::new(refined.re, 0.0) } else { refined };

        let mut moved = 0.0;
        let rounding = ROUNDING * size as f64;
        for ((matrix, state), row) in period.magnitudes().zip(&states).zip(&rows[1..]) {
            for (column, state) in matrix.column_iter().zip(state.iter()) {
                let through: f64 = column.iter().zip(row.iter()).map(|(entry, row)| entry.abs() * row.norm()).sum();
                moved += rounding * through * state.norm();
            }
        }
        for &i in &self.states {
            moved += left[i].norm() * (after[i] - value * before[i]).norm();
        }
        Eigenvalue { value, bound: moved / scale.norm(), states }
    }

    /// A vector of the balanced block as one of all `size` states; the others are 0.
    fn extended(&self, size: usize, vector: &ComplexVector, scaled: impl Fn(f64) -> f64) -> ComplexVector {
        let mut all = ComplexVector::zeros(size);
        for ((&state, entry), scale) in self.states.iter().zip(vector.iter()).zip(&self.scales) {
            all[state] = entry * scaled(*scale);
        }
        all
    }
}

/// The right eigenvector of `matrix` for `value`, by inverse iteration.
fn vector(matrix: &DMatrix<f64>, value: Complex<f64>) -> ComplexVector {
    let size = matrix.nrows();
    // Off the eigenvalue by its uncertainty, lest the matrix is singular.
    let off = f64::EPSILON * matrix.norm().max(f64::MIN_POSITIVE);
    let shifted = DMatrix::from_fn(size, size, |i, j| {
        let diagonal = if i == j { value + Complex::new(off, off / 2.0) } else { Complex::default() };
        Complex::new(matrix[(i, j)], 0.0) - diagonal
    });
    let factors = shifted.lu();
    // Without any symmetry to which an eigenvector could be orthogonal.
    let mut vector = ComplexVector::from_fn(size, |i, _| Complex::new(1.0 + 0.37 * i as f64, 0.61 - 0.13 * i as f64));
    for _ in 0..3 {
        let Some(next) = factors.solve(&vector) else { break };
        let length = next.norm();
        if !(length.is_finite() && length > 0.0) {
            break;
        }
        vector = next / Complex::new(length, 0.0);
    }
    vector
}
