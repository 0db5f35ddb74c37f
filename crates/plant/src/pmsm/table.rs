//! The maps of a tick as polynomials of the turn of the rotor in it, made once: a tick at any speed costs a few dozen
//! multiplications.
//!
//! A rotor that turns the other way exchanges the sign of q: each entry of the maps is even or odd in x = ω·h. So with
//! y = x² an entry is a polynomial of y, or x times one. Relative to its size, `TERMS` coefficients leave out (2x)^16/17! < 1e-16 up to
//! [`FURTHEST`]; a smaller x needs fewer. A faster rotor takes several parts of a tick, whose maps are made at the first
//! use.
#![expect(clippy::inline_always, reason = "what is inlined is compiled for the registers of its caller")]
use super::maps::{Forms, Maps, Matrix, Scalar, doublings};
use super::{Input, Params};
use core::array::from_fn;
use core::ops::{Add, Mul};
use servobench_base::Dq;
use std::sync::OnceLock;

/// Coefficients in y.
const TERMS: usize = 8;
/// Largest turn for which the table holds (rad): ½·(1e-16·17!)^(1/16).
const FURTHEST: f64 = 0.405;
/// Halvings of a tick into the parts of which a fast rotor takes several: quarters and sixteenths.
const HALVINGS: [i32; 2] = [2, 4];

/// Turns up to which 4, 5 and 6 coefficients are enough: ½·(1e-16·(2n + 1)!)^(1/2n).
const ENOUGH_FOR_4: f64 = 0.0247;
const ENOUGH_FOR_5: f64 = 0.072;
const ENOUGH_FOR_6: f64 = 0.151;

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

impl Scalar for InTurn {
    fn times(self, factor: f64) -> Self {
        Self(self.0.map(|coefficient| factor * coefficient))
    }

    /// An angle is a multiple of x.
    fn times_turn(self, turn: Self) -> Self {
        Self(from_fn(|n| if n == 0 { 0.0 } else { turn.0[1] * self.0[n - 1] }))
    }
}

/// The maps over a part of a tick, by powers of y. Values are stored side by side, in the order in which a processor multiplies them.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Table {
    /// Change of i_d and i_q that is even in x: per current of the same axis, per voltage of it, and constant; beside it the odd
    /// part: per current of the other axis, per voltage of it, and constant.
    change: [[[f64; 4]; 3]; TERMS],
    /// By [`PRODUCTS`], in pairs: the torque, beside it the square.
    torque_and_square: [[[f64; 4]; PRODUCTS.len()]; TERMS],
    /// The input: by products of the first kind and of the other one that have a voltage.
    input: [[[f64; 2]; WITH_VOLTAGE[0] + WITH_VOLTAGE[1]]; TERMS],
}

/// Products of two entries of w. The first [`ALIKE`] are of d entries (i_d, u_d, 1) among themselves and of q entries (i_q,
/// u_q) among themselves. A form in which they are even in x has the others, one of each kind, odd, and the other way round.
const PRODUCTS: [[Option<(usize, usize)>; 2]; 8] = [
    [Some((0, 2)), Some((1, 3))],
    [Some((2, 2)), Some((3, 3))],
    [Some((2, 4)), None],
    [Some((0, 0)), Some((1, 1))],
    [Some((0, 4)), Some((4, 4))],
    [Some((0, 3)), Some((1, 2))],
    [Some((2, 3)), Some((3, 4))],
    [Some((0, 1)), Some((1, 4))],
];
const ALIKE: usize = 5;
/// Number of products of each kind with a voltage: they come first, and the input has no others.
const WITH_VOLTAGE: [usize; 2] = [3, 2];

/// [`PRODUCTS`] at `i` and `u`.
#[inline(always)]
fn products(i: Dq, u: Dq) -> [[f64; 2]; PRODUCTS.len()] {
    [
        [i.d * u.d, i.q * u.q],
        [u.d * u.d, u.q * u.q],
        [u.d, 0.0],
        [i.d * i.d, i.q * i.q],
        [i.d, 1.0],
        [i.d * u.q, i.q * u.d],
        [u.d * u.q, u.q],
        [i.d * i.q, i.q],
    ]
}

/// Solution of a part of a tick.
#[derive(Debug, Clone, Copy)]
pub(super) struct Solution {
    pub(super) change: Dq,
    pub(super) means: Forms<f64>,
}

impl Solution {
    /// From changes in d and q, and the means.
    #[inline(always)]
    pub(super) const fn of_numbers([d, q, torque, square, input]: [f64; 5]) -> Self {
        Self { change: Dq { d, q }, means: Forms { torque, square, input } }
    }
}

impl Table {
    fn of(maps: &Maps<InTurn>) -> Self {
        let even = |entry: &InTurn, k: usize| entry.0[2 * k];
        let odd = |entry: &InTurn, k: usize| entry.0[2 * k + 1];
        let [d, q, ..] = &maps.change;
        let change = |k| {
            [
                [even(&d[0], k), even(&q[1], k), odd(&d[1], k), odd(&q[0], k)],
                [even(&d[2], k), even(&q[3], k), odd(&d[3], k), odd(&q[2], k)],
                [even(&d[4], k), 0.0, 0.0, odd(&q[4], k)],
            ]
        };
        let coefficients = |form: &Matrix<InTurn>, at: usize, alike_are_even: bool, k: usize| {
            let is_even = (at < ALIKE) == alike_are_even;
            PRODUCTS[at].map(|product| {
                product.map_or(0.0, |(a, b)| {
                    let times = if a == b { 1.0 } else { 2.0 };
                    times * if is_even { even(&form[a][b], k) } else { odd(&form[a][b], k) }
                })
            })
        };
        let Forms { torque, square, input } = &maps.forms;
        let torque_and_square = |k, at| {
            let ([a, b], [c, d]) = (coefficients(torque, at, false, k), coefficients(square, at, true, k));
            [a, b, c, d]
        };
        let [alike, _] = WITH_VOLTAGE;
        let with_voltage = |at: usize| if at < alike { at } else { ALIKE + at - alike };
        Self {
            change: from_fn(change),
            torque_and_square: from_fn(|k| from_fn(|at| torque_and_square(k, at))),
            input: from_fn(|k| from_fn(|at| coefficients(input, with_voltage(at), true, k))),
        }
    }

    /// Solves the part that begins with `i` and `u`, in a tick in which the rotor turns by `x`.
    #[inline(always)]
    fn solve<const TERMS_USED: usize, const POWER: bool>(&self, x: f64, i: Dq, u: Dq) -> Solution {
        let y = x * x;
        let per = [[i.d, i.q, i.q, i.d], [u.d, u.q, u.q, u.d], [1.0; 4]];
        let [even_d, even_q, odd_d, odd_q] = in_y::<TERMS_USED, 4>(y, |k| sum_of_products(&self.change[k], &per));

        let products = products(i, u);
        let twice = products.map(|[a, b]| [a, b, a, b]);
        let form = |k: usize| self.torque_and_square[k].split_at(ALIKE);
        let alike = in_y::<TERMS_USED, 4>(y, |k| sum_of_products(form(k).0, &twice[..ALIKE]));
        let others = in_y::<TERMS_USED, 4>(y, |k| sum_of_products(form(k).1, &twice[ALIKE..]));
        let both: [f64; 4] = from_fn(|at| if at < 2 { x * alike[at] + others[at] } else { alike[at] + x * others[at] });
        let mut means = Forms { torque: both[0] + both[1], square: both[2] + both[3], input: 0.0 };
        if POWER {
            let [alike, others] = WITH_VOLTAGE;
            let form = |k: usize| self.input[k].split_at(alike);
            let of_alike = in_y::<TERMS_USED, 2>(y, |k| sum_of_products(form(k).0, &products[..alike]));
            let of_others = in_y::<TERMS_USED, 2>(y, |k| sum_of_products(form(k).1, &products[ALIKE..ALIKE + others]));
            let [one, other] = from_fn(|at| of_alike[at] + x * of_others[at]);
            means.input = one + other;
        }
        Solution { change: Dq { d: even_d + x * odd_d, q: even_q + x * odd_q }, means }
    }
}

/// Sums of products, side by side.
#[inline(always)]
fn sum_of_products<const N: usize>(coefficients: &[[f64; N]], products: &[[f64; N]]) -> [f64; N] {
    let mut pairs = coefficients.iter().zip(products);
    let Some((coefficients, products)) = pairs.next() else { return [0.0; N] };
    let mut sum = from_fn(|at| coefficients[at] * products[at]);
    for (coefficients, products) in pairs {
        sum = from_fn(|at| sum[at] + coefficients[at] * products[at]);
    }
    sum
}

/// Polynomials of y by their `USED` coefficients, side by side (Horner).
#[inline(always)]
fn in_y<const USED: usize, const N: usize>(y: f64, coefficient: impl Fn(usize) -> [f64; N]) -> [f64; N] {
    let (mut sum, mut k) = (coefficient(USED - 1), USED - 1);
    // A fold would be a call.
    while k > 0 {
        k -= 1;
        let next = coefficient(k);
        sum = from_fn(|at| sum[at] * y + next[at]);
    }
    sum
}

/// The tables of a tick.
#[derive(Debug, Clone)]
pub(super) struct Tables {
    tick: Table,
    params: Params,
    /// Length of a tick (s).
    h: f64,
    /// The tables of the parts of a tick, made for the first rotor that needs them.
    parts: [OnceLock<Table>; HALVINGS.len()],
}

/// The table of a part of a tick of `h` (s), halved this many times.
fn table(p: &Params, h: f64, halvings: i32) -> Table {
    let mut turn = InTurn::from(0.0);
    turn.0[1] = 1.0;
    // In a part the rotor may turn by as much as the table covers.
    let all = doublings(p, FURTHEST * libm::scalbn(1.0, halvings), h).max(halvings);
    Table::of(&(halvings..all).fold(Maps::part(p, turn, h, all), |maps, _| maps.doubled()))
}

impl Tables {
    pub(super) fn new(p: &Params, h: f64) -> Self {
        Self { tick: table(p, h, 0), params: *p, h, parts: HALVINGS.map(|_| OnceLock::new()) }
    }

    /// Solves a tick from the current `i`, if the rotor is slow enough.
    #[inline(always)]
    pub(super) fn solve<const POWER: bool>(&self, x: f64, i: Dq, u: &Input) -> Option<Solution> {
        let turn = x.abs();
        if turn <= FURTHEST {
            let voltage = u.voltage.to_dq(u.rotor);
            return Some(if turn <= ENOUGH_FOR_4 {
                self.tick.solve::<4, POWER>(x, i, voltage)
            } else if turn <= ENOUGH_FOR_5 {
                self.tick.solve::<5, POWER>(x, i, voltage)
            } else if turn <= ENOUGH_FOR_6 {
                self.tick.solve::<6, POWER>(x, i, voltage)
            } else {
                self.tick.solve::<TERMS, POWER>(x, i, voltage)
            });
        }
        self.in_parts::<POWER>(x, i, u).map(Solution::of_numbers)
    }

    /// Returns numbers, so that the solution of a slow rotor stays in registers.
    #[cold]
    fn in_parts<const POWER: bool>(&self, x: f64, i: Dq, u: &Input) -> Option<[f64; 5]> {
        let parts_of = |halvings: i32| 1_u32 << halvings;
        let at = HALVINGS.iter().position(|halvings| x.abs() <= FURTHEST * f64::from(parts_of(*halvings)))?;
        let table = self.parts[at].get_or_init(|| table(&self.params, self.h, HALVINGS[at]));
        let parts = parts_of(HALVINGS[at]);
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
        Some([now.d - i.d, now.q - i.q, means.torque, means.square, means.input])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_are_of_the_entries_that_they_say() {
        let w = [-1.3, 2.4, 7.0, -11.0, 1.0];
        let found = products(Dq { d: w[0], q: w[1] }, Dq { d: w[2], q: w[3] });
        for (found, said) in found.into_iter().zip(PRODUCTS) {
            for (value, said) in found.into_iter().zip(said) {
                assert!(said.is_none_or(|(a, b)| value.to_bits() == f64::to_bits(w[a] * w[b])), "{said:?}: {value}");
            }
        }
    }

    /// Oracle: the bound that the module's text gives, by its logarithm.
    #[test]
    fn what_the_table_leaves_out_is_below_the_rounding() {
        for (bound, count) in [(ENOUGH_FOR_4, 4), (ENOUGH_FOR_5, 5), (ENOUGH_FOR_6, 6), (FURTHEST, TERMS)] {
            let factorial: f64 = (1..=2 * count + 1).map(|n| (n as f64).ln()).sum();
            let left_out = 2.0 * count as f64 * (2.0 * bound).ln() - factorial;
            assert!(left_out < 1e-16_f64.ln() && left_out > 0.7e-16_f64.ln(), "{count}: {}", left_out.exp());
        }
    }
}
