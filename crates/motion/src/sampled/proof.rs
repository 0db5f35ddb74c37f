//! Proof that no move covers more: a bound in plain sums.
//!
//! Let λ_r be any dual variable for limit r, y any dual variable for the condition of rest. With the slopes
//!
//! ```text
//! s_i = c_i − y·e_i − Σ_r λ_r·w_r,i      contribution of a unit of u_i to the distance, c_i, beyond its cost
//! x   = Σ_i c_i·u_i = Σ_i s_i·u_i + Σ_r λ_r·(w_r·u)  ≤  Σ_i |s_i| + Σ_r B_r·|λ_r|
//! ```
//!
//! for every move that is at rest at the end, |u_i| ≤ 1 and |w_r·u| ≤ B_r. Nothing has to be solved to check that. With the
//! dual variables of a program that has a cell for each sample and all limits it is the optimum itself.
//!
//! # Stretches at a limit
//!
//! A program of few cells pays only at the ends of a stretch in which the move rests at a limit, where the optimum pays at
//! every sample in it. The reduction of the slope at i by dual variables λ_k of the m-th integral, `h_i = Σ_k λ_k·C(k − 1 − i, m − 1)`, is
//! inverted by an m-th difference, `λ_(i+m) = Σ_b (−1)^b·C(m, b)·h_(i+b)`: every h has its dual variables, also the one that
//! leaves all slopes before the stretch unchanged and makes those in it zero. Before the stretch it is a polynomial of degree
//! m − 1, whose m-th difference is zero.
use super::half::{At, Half, after};
use super::reach::{Cell, Reach};
use std::vec::Vec;

/// Dual variables, and the slopes that they leave.
#[derive(Debug, Clone, Default)]
pub(super) struct Duals {
    /// λ.
    limits: Vec<(At, f64)>,
    /// y.
    rest: f64,
    slopes: Vec<f64>,
    stretches: Vec<Stretch>,
}

/// A stretch at a limit of the m-th integral.
#[derive(Debug, Clone, Copy)]
struct Stretch {
    m: usize,
    start: f64,
    end: f64,
}

impl Stretch {
    fn pays(&self, at: At) -> bool {
        at.m == self.m && at.k >= self.start && at.k <= self.end + self.m as f64
    }
}

/// Share of its limit from which on an integral counts as at it.
const AT_LIMIT: f64 = 1.0 - 1e-6;

/// Share of all dual variables of a stretch below which one is rounding.
const NO_DUAL: f64 = 1e-9;

impl Duals {
    /// The better of the dual variables of the program, the condition of rest first, and of those spread over the stretches at a
    /// limit, with their bound on every move.
    pub(super) fn of(reach: &Reach, cells: &[Cell], limits: &[At], duals: &[f64]) -> (Self, f64) {
        let limits = limits.iter().copied().zip(duals[1..].iter().copied()).filter(|(_, dual)| *dual != 0.0);
        let mut plain = Self { limits: limits.collect(), rest: duals[0], slopes: Vec::new(), stretches: Vec::new() };
        plain.look(&reach.half);
        let at_most = plain.at_most(reach.bounds);
        let mut spread = plain.clone();
        for stretch in stretches(reach, cells) {
            spread.spread(&reach.half, stretch);
            spread.look(&reach.half);
        }
        let better = spread.at_most(reach.bounds);
        if better < at_most { (spread, better) } else { (plain, at_most) }
    }

    /// Bound that no move exceeds.
    pub(super) fn at_most(&self, bounds: &[f64]) -> f64 {
        let paid: f64 = self.limits.iter().map(|(at, dual)| bounds[at.m - 1] * dual.abs()).sum();
        paid + self.slopes.iter().map(|slope| slope.abs()).sum::<f64>()
    }

    /// Finds the slopes.
    fn look(&mut self, half: &Half) {
        self.slopes.clear();
        let mut i = 0.0;
        while i < half.free() {
            let costs: f64 = self.limits.iter().map(|(at, dual)| dual * at.weight(i, i + 1.0)).sum();
            self.slopes.push(half.gain(i, i + 1.0) - self.rest * half.rest(i, i + 1.0) - costs);
            i += 1.0;
        }
    }

    /// Pays at every sample of a stretch.
    fn spread(&mut self, half: &Half, stretch: Stretch) {
        const SIGNED: [&[f64]; 4] = [&[1.0], &[1.0, -1.0], &[1.0, -2.0, 1.0], &[1.0, -3.0, 3.0, -1.0]];
        let Stretch { m, start, end } = stretch;
        let depth = m as f64;
        let last = half.last(m).min(end + depth);
        let (ends, others) = self.limits.iter().copied().partition(|(at, _)| stretch.pays(*at));
        let ends: Vec<(At, f64)> = ends;
        self.limits = others;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a whole number of samples")]
        let slope = |i: f64| self.slopes[i as usize];
        // In the middle of the move the last slope is out of reach, and left to the condition of rest.
        let is_middle = last - depth < end - 1.0;
        let rest = if is_middle { slope(end - 1.0) / half.rest(end - 1.0, end) } else { 0.0 };
        let mut h: Vec<f64> = Vec::new();
        let mut i = start - depth;
        while i <= last - depth {
            let known: f64 = ends.iter().map(|(at, dual)| dual * at.weight(i, i + 1.0)).sum();
            let gained = if i >= start && i < end { slope(i) } else { 0.0 };
            h.push(known + gained - rest * half.rest(i, i + 1.0));
            i += 1.0;
        }
        for (at, _) in h.iter().enumerate() {
            let dual = SIGNED[m].iter().zip(&h[at..]).map(|(sign, h)| sign * h).sum();
            self.limits.push((At { m, k: start + at as f64 }, dual));
        }
        self.rest += rest;
        self.stretches.push(stretch);
    }

    /// Places where the cells are to be cut: about the samples between which a slope changes its sign, outside the stretches; and in
    /// them at dual variables with the wrong sign, as the move should have left the limit there.
    pub(super) fn cuts(&self) -> Vec<f64> {
        let mut cuts = Vec::new();
        let settled = |i: f64| self.stretches.iter().any(|stretch| i >= stretch.start && i < stretch.end);
        for (i, pair) in self.slopes.windows(2).enumerate() {
            let i = i as f64;
            if pair[0] * pair[1] < 0.0 && !(settled(i) && settled(i + 1.0)) {
                cuts.extend([i, i + 1.0, i + 2.0]);
            }
        }
        for stretch in &self.stretches {
            let paid = self.limits.iter().filter(|(at, _)| stretch.pays(*at));
            let all: f64 = paid.clone().map(|(_, dual)| dual).sum();
            let wrong = paid.filter(|(_, dual)| dual * all < 0.0 && dual.abs() > NO_DUAL * all.abs());
            cuts.extend(wrong.flat_map(|(at, _)| [at.k - 1.0, at.k, at.k + 1.0]));
        }
        cuts
    }
}

/// The stretches in which the cells rest at a limit.
fn stretches(reach: &Reach, cells: &[Cell]) -> Vec<Stretch> {
    let (mut start, mut state) = (0.0, [0.0; 4]);
    let mut found = Vec::new();
    for Cell { end, u } in cells.iter().copied() {
        state[0] = u;
        let next = after(state, end - start);
        let rests = |m: usize| {
            let limit = AT_LIMIT * reach.bounds[m - 1];
            start >= m as f64 && state[m].abs() >= limit && next[m].abs() >= limit
        };
        if end - start > 1.0 && u.abs() < AT_LIMIT {
            found.extend((1..reach.half.order).find(|m| rests(*m)).map(|m| Stretch { m, start, end }));
        }
        (start, state) = (end, next);
    }
    found
}

#[cfg(test)]
impl Duals {
    /// λ.
    pub(super) fn limits(&self) -> impl Iterator<Item = (At, f64)> + '_ {
        self.limits.iter().copied()
    }

    /// The slope at sample `i` of the half.
    pub(super) fn slope(&self, i: usize) -> f64 {
        self.slopes[i]
    }
}
