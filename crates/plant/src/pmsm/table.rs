//! The maps of a tick as polynomials of how far the rotor turns in it, made once: a tick at any speed costs a few dozen
//! multiplications.
//!
//! A rotor that turns the other way exchanges the sign of q: each entry of the maps is even or odd in x = ω·h. So with
//! y = x² an entry is a polynomial of y, or x times one. Of its size, ``TERMS` coefficients leave out (2x)^16/17! < 1e-16 up to
//! [`FURTHEST`]; a smaller x needs fewer.
use super::maps::{Forms, Maps, Matrix, N, doublings};
use super::{Input, Params};
use core::array::from_fn;
use core::ops::{Add, Mul};
use servobench_base::Dq;

/// Coefficients in y.
const TERMS: usize = 8;
/// Largest turn for which the table holds (rad): ½·(1e-16·17!)^(1/16).
const FURTHEST: f64 = 0.405;
/// The tick itself, a quarter and a sixteenth of it: what a fast rotor takes several of.
const LEVELS: usize = 3;
/// From the tick to the finest of them.
const HALVINGS: i32 = 4;

/// For which 4 and 6 are enough: ½·(1e-16·(2n + 1)!)^(1/2n).
const NEAR: f64 = 0.0247;
const FAR: f64 = 0.151;

/// Polynomial in x, cut after as many coefficients as the table has.
#[derive(Clone, Copy)]
struct InTurn([f64; 2 * TERMS]);

impl From<f64> for InTurn {
    fn from(constant: f64) -> Self {
        let mut all = [0.0; 2 * TERMS];
        all[0] = constant;
        Self(all)
    }
}

impl Add for InTurn {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self(from_fn(|n| self.0[n] + other.0[n]))
    }
}

impl Mul for InTurn {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        let mut all = [0.0; 2 * TERMS];
        for (n, a) in self.0.iter().enumerate().filter(|(_, a)| **a != 0.0) {
            for (all, b) in all[n..].iter_mut().zip(other.0) {
                *all += a * b;
            }
        }
        Self(all)
    }
}

/// The maps over a part of a tick.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Table {
    /// Change of i_d per i_d, u_d, 1 and of i_q per i_q, u_q, even in x; of i_d per i_q, u_q and of i_q per i_d, u_d, 1,
    /// odd.
    change: [[f64; 10]; TERMS],
    /// By product of two entries of w.
    forms: Forms<[[f64; 16]; TERMS]>,
}

/// Products of two entries of w: i_d, u_d, 1 among themselves, i_q and u_q among themselves, then one of each. A form of
/// which the first are even in x has odd ones behind.
const PRODUCTS: [(usize, usize); 15] = [
    (0, 0),
    (0, 2),
    (0, 4),
    (2, 2),
    (2, 4),
    (4, 4),
    (1, 1),
    (1, 3),
    (3, 3),
    (0, 1),
    (0, 3),
    (2, 1),
    (2, 3),
    (4, 1),
    (4, 3),
];
/// How many of them come before the others.
const LIKE: usize = 9;

/// What a part of a tick gives.
#[derive(Debug, Clone, Copy)]
pub(super) struct Solution {
    pub(super) change: Dq,
    pub(super) means: Forms<f64>,
}

impl Table {
    fn of(maps: &Maps<InTurn>) -> Self {
        let even = |entry: &InTurn, k: usize| entry.0[2 * k];
        let odd = |entry: &InTurn, k: usize| entry.0[2 * k + 1];
        let [d, q, ..] = &maps.change;
        let change = |k| {
            [
                even(&d[0], k),
                even(&d[2], k),
                even(&d[4], k),
                even(&q[1], k),
                even(&q[3], k),
                odd(&d[1], k),
                odd(&d[3], k),
                odd(&q[0], k),
                odd(&q[2], k),
                odd(&q[4], k),
            ]
        };
        let form = |form: &Matrix<InTurn>, like_is_even: bool| {
            from_fn(|k| {
                let mut all = [0.0; 16];
                for (at, (a, b)) in PRODUCTS.into_iter().enumerate() {
                    let times = if a == b { 1.0 } else { 2.0 };
                    let is_even = (at < LIKE) == like_is_even;
                    all[at] = times * if is_even { even(&form[a][b], k) } else { odd(&form[a][b], k) };
                }
                all
            })
        };
        let Forms { torque, square, input } = &maps.forms;
        Self {
            change: from_fn(change),
            forms: Forms { torque: form(torque, false), square: form(square, true), input: form(input, true) },
        }
    }

    /// The part that begins with `i` and `u`, in a tick in which the rotor turns by `x`.
    #[inline]
    fn solve<const TERMS_USED: usize, const POWER: bool>(&self, x: f64, i: Dq, u: Dq) -> Solution {
        let y = x * x;
        let c = horner::<10, TERMS_USED>(&self.change, y);
        let change = Dq {
            d: (c[0] * i.d + c[1] * u.d + c[2]) + x * (c[5] * i.q + c[6] * u.q),
            q: (c[3] * i.q + c[4] * u.q) + x * (c[7] * i.d + c[8] * u.d + c[9]),
        };
        let w: [f64; N] = [i.d, i.q, u.d, u.q, 1.0];
        let products = PRODUCTS.map(|(a, b)| w[a] * w[b]);
        let (like, unlike) = parts::<TERMS_USED>(&self.forms.torque, &products, y);
        let mut means = Forms { torque: x * like + unlike, square: 0.0, input: 0.0 };
        if POWER {
            let (like, unlike) = parts::<TERMS_USED>(&self.forms.square, &products, y);
            means.square = like + x * unlike;
            let (like, unlike) = parts::<TERMS_USED>(&self.forms.input, &products, y);
            means.input = like + x * unlike;
        }
        Solution { change, means }
    }
}

/// A form's polynomials, each times its product: of those of like entries, and of the others.
#[inline]
fn parts<const USED: usize>(form: &[[f64; 16]; TERMS], products: &[f64; PRODUCTS.len()], y: f64) -> (f64, f64) {
    let e = horner::<16, USED>(form, y);
    let p = products;
    let like = ((e[0] * p[0] + e[1] * p[1]) + (e[2] * p[2] + e[3] * p[3]))
        + ((e[4] * p[4] + e[5] * p[5]) + (e[6] * p[6] + e[7] * p[7]))
        + e[8] * p[8];
    let unlike = ((e[9] * p[9] + e[10] * p[10]) + (e[11] * p[11] + e[12] * p[12])) + (e[13] * p[13] + e[14] * p[14]);
    (like, unlike)
}

#[inline]
fn horner<const E: usize, const USED: usize>(coefficients: &[[f64; E]; TERMS], y: f64) -> [f64; E] {
    let mut all = coefficients[USED - 1];
    for row in coefficients[..USED - 1].iter().rev() {
        for (sum, coefficient) in all.iter_mut().zip(row) {
            *sum = *sum * y + coefficient;
        }
    }
    all
}

/// The tables of a tick.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Tables([Table; LEVELS]);

impl Tables {
    pub(super) fn new(p: &Params, h: f64) -> Self {
        let mut turn = InTurn::from(0.0);
        turn.0[1] = 1.0;
        // The finest level takes the fastest rotor, so its parts are made for that.
        let all = doublings(p, FURTHEST * libm::scalbn(1.0, HALVINGS), h).max(HALVINGS);
        let finest = (HALVINGS..all).fold(Maps::part(p, turn, h, all), |maps, _| maps.doubled());
        let quarter = finest.doubled().doubled();
        let whole = quarter.doubled().doubled();
        Self([Table::of(&whole), Table::of(&quarter), Table::of(&finest)])
    }

    /// A tick from the current `i` on, if the rotor is slow enough.
    #[inline]
    pub(super) fn solve<const POWER: bool>(&self, x: f64, i: Dq, u: &Input) -> Option<Solution> {
        let turn = x.abs();
        if turn <= FURTHEST {
            let voltage = u.voltage.to_dq(u.rotor);
            return Some(if turn <= NEAR {
                self.0[0].solve::<4, POWER>(x, i, voltage)
            } else if turn <= FAR {
                self.0[0].solve::<6, POWER>(x, i, voltage)
            } else {
                self.0[0].solve::<TERMS, POWER>(x, i, voltage)
            });
        }
        self.in_parts::<POWER>(x, i, u)
    }

    #[cold]
    fn in_parts<const POWER: bool>(&self, x: f64, i: Dq, u: &Input) -> Option<Solution> {
        let (table, parts) = [(&self.0[1], 4_u32), (&self.0[2], 16)]
            .into_iter()
            .find(|(_, parts)| x.abs() <= FURTHEST * f64::from(*parts))?;
        let share = 1.0 / f64::from(parts);
        let (mut now, mut means) = (i, Forms { torque: 0.0, square: 0.0, input: 0.0 });
        for part in 0..parts {
            let rotor = u.rotor.ahead(x * share * f64::from(part));
            let found = table.solve::<TERMS, POWER>(x, now, u.voltage.to_dq(rotor));
            now = Dq { d: now.d + found.change.d, q: now.q + found.change.q };
            means.torque += share * found.means.torque;
            means.square += share * found.means.square;
            means.input += share * found.means.input;
        }
        Some(Solution { change: Dq { d: now.d - i.d, q: now.q - i.q }, means })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: the bound that the module's text gives, by its logarithm.
    #[test]
    fn what_the_table_leaves_out_is_below_the_rounding() {
        for (bound, count) in [(NEAR, 4), (FAR, 6), (FURTHEST, TERMS)] {
            let factorial: f64 = (1..=2 * count + 1).map(|n| (n as f64).ln()).sum();
            let left_out = 2.0 * count as f64 * (2.0 * bound).ln() - factorial;
            assert!(left_out < 1e-16_f64.ln() && left_out > 0.7e-16_f64.ln(), "{count}: {}", left_out.exp());
        }
    }
}
