//! What a tick does with the currents, solved exactly: a small part of it by its Taylor series, doubled until it is the
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
//! Torque, losses and input are quadratic forms of w, so the doubling takes their exact means along. It is done on D, not
//! on 1 + D, so that a slow motor keeps its digits. Scaling and squaring: Moler and Van Loan, *SIAM Review* 45(1), 2003,
//! method 3; the integrals of forms: Van Loan, *IEEE Transactions on Automatic Control* 23(3), 1978.
//!
//! A part is so short that `M` coefficients of its series leave out less than the rounding: with at most
//! [`LARGEST_PART`] of change in it, (2·0.044)⁹/10! < 1e-16 of a mean of products, and less of the currents.
use super::Params;
use core::array::from_fn;
use core::ops::{Add, Mul};

/// Numbers, or polynomials of the speed: see [`table`](super::table).
pub(super) trait Scalar: Copy + From<f64> + Add<Output = Self> + Mul<Output = Self> {}

impl<T: Copy + From<f64> + Add<Output = T> + Mul<Output = T>> Scalar for T {}

/// Entries of w.
pub(super) const N: usize = 5;
/// Coefficients of a series.
const M: usize = 9;
/// Largest change in a part, relative to what changes.
const LARGEST_PART: f64 = 0.044;

pub(super) type Matrix<T> = [[T; N]; N];

/// Quadratic forms of which the means are wanted.
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

/// How often a part is to be doubled to give a tick of `h` (s) in which the rotor turns by at most `turn` (rad).
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
        let (h, turn) = (share * h, turn * T::from(share));
        let columns: [Polynomials<T>; N] = from_fn(|column| Polynomials::of_column(p, turn, h, column));
        let forms = |p: &Params, j: usize, k: usize| {
            let (a, b) = (&columns[j], &columns[k]);
            let mut torque = a.i_d.mean_product(&b.i_q) * T::from(p.inductance.d - p.inductance.q);
            if k == N - 1 {
                torque = torque + a.i_q.mean() * T::from(p.flux_linkage);
            }
            let square = a.i_d.mean_product(&b.i_d) + a.i_q.mean_product(&b.i_q);
            let input = a.u_d.mean_product(&b.i_d) + a.u_q.mean_product(&b.i_q);
            Forms { torque, square, input }
        };
        let both: Matrix<Forms<T>> = from_fn(|j| from_fn(|k| forms(p, j, k)));
        let half = T::from(0.5);
        let symmetric =
            |of: &dyn Fn(&Forms<T>) -> T| from_fn(|j| from_fn(|k| (of(&both[j][k]) + of(&both[k][j])) * half));
        let zero = [T::from(0.0); N];
        let row = |of: &dyn Fn(&Polynomials<T>) -> T| from_fn(|k| of(&columns[k]));
        Self {
            change: [
                row(&|c| c.i_d.change()),
                row(&|c| c.i_q.change()),
                row(&|c| c.u_d.change()),
                row(&|c| c.u_q.change()),
                zero,
            ],
            forms: Forms {
                torque: symmetric(&|form| form.torque),
                square: symmetric(&|form| form.square),
                input: symmetric(&|form| form.input),
            },
        }
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

fn sum<T: Scalar>(term: impl Fn(usize) -> T) -> T {
    (1..N).fold(term(0), |sum, n| sum + term(n))
}

fn product<T: Scalar>(a: &Matrix<T>, b: &Matrix<T>) -> Matrix<T> {
    from_fn(|j| from_fn(|k| sum(|n| a[j][n] * b[n][k])))
}

/// Coefficients of τⁿ.
#[derive(Clone, Copy)]
struct Polynomial<T>([T; M]);

/// Those of currents and voltages that begin as one column of the unit matrix.
struct Polynomials<T> {
    i_d: Polynomial<T>,
    i_q: Polynomial<T>,
    u_d: Polynomial<T>,
    u_q: Polynomial<T>,
}

impl<T: Scalar> Polynomials<T> {
    fn of_column(p: &Params, turn: T, h: f64, column: usize) -> Self {
        let (l, constant) = (p.inductance, T::from);
        let (per_d, per_q) = (h / l.d, h / l.q);
        let (cross_d, cross_q) = (turn * constant(l.q / l.d), turn * constant(-l.d / l.q));
        let mut w: [T; N] = from_fn(|row| constant(if row == column { 1.0 } else { 0.0 }));
        let mut all = [[constant(0.0); M]; N];
        for n in 0..M {
            for (all, w) in all.iter_mut().zip(w) {
                all[n] = w;
            }
            let [i_d, i_q, u_d, u_q, one] = w;
            let next = [
                i_d * constant(-per_d * p.resistance) + cross_d * i_q + u_d * constant(per_d),
                i_q * constant(-per_q * p.resistance)
                    + cross_q * i_d
                    + u_q * constant(per_q)
                    + turn * one * constant(-p.flux_linkage / l.q),
                turn * u_q,
                turn * u_d * constant(-1.0),
                constant(0.0),
            ];
            w = next.map(|slope| slope * constant(1.0 / (n + 1) as f64));
        }
        let [i_d, i_q, u_d, u_q, _] = all.map(Polynomial);
        Self { i_d, i_q, u_d, u_q }
    }
}

impl<T: Scalar> Polynomial<T> {
    /// From τ = 0 to 1.
    fn change(&self) -> T {
        self.0[1..].iter().rev().fold(T::from(0.0), |sum, a| sum + *a)
    }

    /// From τ = 0 to 1.
    fn mean(&self) -> T {
        self.0.iter().enumerate().rev().fold(T::from(0.0), |sum, (n, a)| sum + *a * T::from(1.0 / (n + 1) as f64))
    }

    /// Of the product, as far as its coefficients go.
    fn mean_product(&self, other: &Self) -> T {
        Self(from_fn(|k| (0..=k).fold(T::from(0.0), |sum, n| sum + self.0[n] * other.0[k - n]))).mean()
    }
}
