//! Exact solution of the currents over a tick: a small part of it by its Taylor series, doubled until it is the
//! tick.
//!
//! ```text
//! w = (i_d, i_q, u_d, u_q, 1), the voltage in the rotor frame        τ = t/h        x = ω·h
//! dw_1/dτ = −r_d·i_d + x·L_q/L_d·i_q + g_d·u_d          r = h·R/L    g = h/L
//! dw_2/dτ = −r_q·i_q − x·L_d/L_q·i_d + g_q·u_q − x·ψ/L_q
//! dw_3/dτ = x·u_q        dw_4/dτ = −x·u_d
//!
//! w(τ + δ) = w(τ) + D(δ)·w(τ)          mean over δ of a quadratic form of w = wᵀ·S(δ)·w
//! D(2δ) = 2·D + D·D                    S(2δ) = S + (S·D + (S·D)ᵀ + Dᵀ·S·D)/2
//! ```
//! Torque, losses and input are quadratic forms of w, so the doubling includes their exact means. It is done on D, not
//! on 1 + D, so that a slow motor keeps its digits. Scaling and squaring: Moler and Van Loan, *SIAM Review* 45(1), 2003,
//! method 3; the integrals of forms: Van Loan, *IEEE Transactions on Automatic Control* 23(3), 1978.
//!
//! A part is so short that `M` terms of its series leave out less than the rounding: with at most [`LARGEST_PART`] of
//! change in it, (2·0.76)²⁰/21! < 1e-16 of a mean of products, and less of the currents.
use super::Params;
use core::array::from_fn;
use core::ops::{Add, Mul};

/// Numbers, or polynomials of the speed: see [`table`](super::table).
pub(super) trait Scalar: Copy + From<f64> + Add<Output = Self> + Mul<Output = Self> {
    /// Multiple by `factor`.
    fn times(self, factor: f64) -> Self;

    /// Product with the angle `turn`.
    fn times_turn(self, turn: Self) -> Self;
}

impl Scalar for f64 {
    fn times(self, factor: f64) -> Self {
        self * factor
    }

    fn times_turn(self, turn: Self) -> Self {
        self * turn
    }
}

/// Entries of w.
pub(super) const N: usize = 5;
/// Terms of a series.
const M: usize = 20;
/// Largest relative change in a part.
const LARGEST_PART: f64 = 0.76;

pub(super) type Matrix<T> = [[T; N]; N];

/// Quadratic forms whose means are computed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Forms<T> {
    /// ψ·i_q + (L_d − L_q)·i_d·i_q.
    pub(super) torque: T,
    /// i_d² + i_q².
    pub(super) square: T,
    /// u_d·i_d + u_q·i_q.
    pub(super) input: T,
}

impl<T> Forms<T> {
    pub(super) fn map<U>(self, mut f: impl FnMut(T) -> U) -> Forms<U> {
        Forms { torque: f(self.torque), square: f(self.square), input: f(self.input) }
    }
}

/// D and S over a part of a tick.
#[derive(Debug, Clone, Copy)]
pub(super) struct Maps<T> {
    pub(super) change: Matrix<T>,
    /// Symmetric.
    pub(super) forms: Forms<Matrix<T>>,
}

/// Number of doublings of a part that give a tick of `h` (s) in which the rotor turns by at most `turn` (rad).
pub(super) fn doublings(p: &Params, turn: f64, h: f64) -> i32 {
    let decay = h * p.resistance / p.inductance.d.min(p.inductance.q);
    let (mut doublings, mut change) = (0, decay + turn.abs());
    while change > LARGEST_PART && change < f64::INFINITY {
        change /= 2.0;
        doublings += 1;
    }
    doublings
}

impl<T: Scalar> Maps<T> {
    /// Over one of 2^`doublings` parts of a tick of `h` (s), in which the rotor turns by `turn` (rad).
    pub(super) fn part(p: &Params, turn: T, h: f64, doublings: i32) -> Self {
        let share = libm::scalbn(1.0, -doublings);
        let (h, turn) = (share * h, turn.times(share));
        let slope = Slope::new(p, turn, h);
        Self { change: slope.change(), forms: forms(p).map(|form| slope.mean(&form)) }
    }

    /// Over twice the time.
    pub(super) fn doubled(&self) -> Self {
        let (d, half) = (&self.change, T::from(0.5));
        let squared = product(d, d);
        Self {
            change: from_fn(|j| from_fn(|k| d[j][k] + d[j][k] + squared[j][k])),
            forms: self.forms.map(|s| {
                let sd = product(&s, d);
                let dsd: Matrix<T> = from_fn(|j| from_fn(|k| sum(|n| d[n][j] * sd[n][k])));
                from_fn(|j| from_fn(|k| s[j][k] + (sd[j][k] + sd[k][j] + dsd[j][k]) * half))
            }),
        }
    }
}

/// The forms themselves.
fn forms<T: Scalar>(p: &Params) -> Forms<Matrix<T>> {
    let symmetric = |products: &[(usize, usize, f64)]| {
        let mut form = [[0.0; N]; N];
        for (j, k, factor) in products {
            form[*j][*k] += factor / 2.0;
            form[*k][*j] += factor / 2.0;
        }
        form.map(|row| row.map(T::from))
    };
    Forms {
        torque: symmetric(&[(1, 4, p.flux_linkage), (0, 1, p.inductance.d - p.inductance.q)]),
        square: symmetric(&[(0, 0, 1.0), (1, 1, 1.0)]),
        input: symmetric(&[(0, 2, 1.0), (1, 3, 1.0)]),
    }
}

/// dw/dτ by w.
struct Slope<T> {
    /// Non-zero entries: row, column, value, and true if it is per turn.
    entries: [(usize, usize, f64, bool); 9],
    turn: T,
}

impl<T: Scalar> Slope<T> {
    fn new(p: &Params, turn: T, h: f64) -> Self {
        let l = p.inductance;
        let entries = [
            (0, 0, -h * p.resistance / l.d, false),
            (0, 1, l.q / l.d, true),
            (0, 2, h / l.d, false),
            (1, 1, -h * p.resistance / l.q, false),
            (1, 0, -l.d / l.q, true),
            (1, 3, h / l.q, false),
            (1, 4, -p.flux_linkage / l.q, true),
            (2, 3, 1.0, true),
            (3, 2, -1.0, true),
        ];
        Self { entries, turn }
    }

    /// D = A + A²/2! + A³/3! + …, the smallest first.
    fn change(&self) -> Matrix<T> {
        let unit: Matrix<T> = from_fn(|j| from_fn(|k| T::from(if j == k { 1.0 } else { 0.0 })));
        let sum = (2..=M).rev().fold(unit, |sum, n| {
            let next = self.after(&sum);
            from_fn(|j| from_fn(|k| unit[j][k] + next[j][k].times(1.0 / n as f64)))
        });
        self.after(&sum)
    }

    /// S = Q + L(Q)/2! + L²(Q)/3! + … with L(Q) = Q·A + (Q·A)ᵀ, the slope of a symmetric form; the smallest first.
    fn mean(&self, form: &Matrix<T>) -> Matrix<T> {
        (2..=M).rev().fold(*form, |sum, n| {
            let next = self.after(&sum);
            from_fn(|j| from_fn(|k| form[j][k] + (next[j][k] + next[k][j]).times(1.0 / n as f64)))
        })
    }

    /// `matrix`·A.
    fn after(&self, matrix: &Matrix<T>) -> Matrix<T> {
        let mut product = [[T::from(0.0); N]; N];
        for (row, column, slope, is_per_turn) in self.entries {
            for (product, factor) in product.iter_mut().zip(matrix) {
                let term = factor[row].times(slope);
                product[column] = product[column] + if is_per_turn { term.times_turn(self.turn) } else { term };
            }
        }
        product
    }
}

fn sum<T: Scalar>(term: impl Fn(usize) -> T) -> T {
    (1..N).fold(term(0), |sum, n| sum + term(n))
}

fn product<T: Scalar>(a: &Matrix<T>, b: &Matrix<T>) -> Matrix<T> {
    from_fn(|j| from_fn(|k| sum(|n| a[j][n] * b[n][k])))
}
