//! Reachability of a distance in N samples: a linear program that grows until the answer is known.
//!
//! The half ([`half`](super::half)) is cut into a few cells of equal u, first about where the continuous optimum switches, with few
//! limits. Limits that the solution exceeds are added ([`Reach::exceeded`]); when there are none, cells are cut where the dual variables
//! require another sign of u ([`proof`](super::proof)). That ends with one of two answers, each of which is valid without the
//! program:
//!
//! - a move that keeps every limit at every sample, and gets as far as the distance;
//! - a bound on what any move can reach, below the distance.
use super::half::{At, Half, after};
use super::proof::Duals;
use super::simplex::Program;
use std::vec::Vec;

/// Share by which a limit may be exceeded, or the distance be missed, before the move is scaled to it: the rounding of the
/// program.
pub(super) const ROUNDING: f64 = 1e-11;

/// Excess (a share of the limit) below which cells are cut: dual variables far from a move are no guide.
const NEAR: f64 = 1e-3;

/// Cells and rounds up to which the program grows; up to 300 samples random requests need fewer.
const CELLS: usize = 60;
const ROUNDS: usize = 100;

/// Samples up to which a bound is proven: it is a sum over all samples and dual variables.
const PROVABLE: f64 = 2048.0;

/// The question.
#[derive(Debug, Clone, Copy)]
pub(super) struct Reach<'a> {
    pub(super) half: Half,
    /// Limits of the 1st, 2nd … integral of the highest derivative, then the distance.
    pub(super) bounds: &'a [f64],
}

/// A stretch of equal u, from the end of the one before.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Cell {
    /// Time (samples).
    pub(super) end: f64,
    /// A part of the limit.
    pub(super) u: f64,
}

/// The answer.
#[derive(Debug, Clone)]
pub(super) enum Answer {
    /// The distance is reached, by this first half.
    Reached(Vec<Cell>),
    /// No move reaches it, by these dual variables.
    Beyond(#[cfg_attr(not(test), expect(dead_code, reason = "what a test adds up again"))] Duals),
    /// Neither has been found.
    Unknown,
}

impl Reach<'_> {
    pub(super) fn distance(&self) -> f64 {
        self.bounds[self.half.order - 1]
    }

    /// Answer to the question. `switches` are the times (samples) about which the highest derivative is expected to
    /// switch.
    pub(super) fn answer(&self, switches: impl Iterator<Item = f64>) -> Answer {
        let free = self.half.free();
        if free == 0.0 {
            return Answer::Beyond(Duals::default());
        }
        let mut cuts = Vec::from([0.0, free]);
        let mut limits: Vec<At> = Vec::new();
        for t in switches.filter(|t| *t <= free + 2.0) {
            cuts.extend([-1.0, 0.0, 1.0, 2.0].map(|beside| libm::floor(t) + beside));
            let finite = (1..self.half.order).filter(|m| self.bounds[m - 1].is_finite());
            limits.extend(finite.map(|m| At { m, k: libm::round(t).min(self.half.last(m)) }));
        }
        for _ in 0..ROUNDS {
            tidy(&mut cuts, free);
            let Some(solution) = self.program(&cuts, &limits).solve() else { break };
            let cells: Vec<Cell> =
                cuts[1..].iter().zip(&solution.x).map(|(end, u)| Cell { end: *end, u: *u }).collect();
            let (excess, exceeded) = self.exceeded(&cells);
            let (reached, distance) = (self.reached(&cells), self.distance());
            if reached >= distance * (1.0 + excess) * (1.0 - ROUNDING) {
                let fitted = |cell: Cell| Cell { u: cell.u * (distance / reached), ..cell };
                return Answer::Reached(cells.into_iter().map(fitted).collect());
            }
            let (rounds_limits, rounds_cuts) = (limits.len(), cuts.len());
            for at in exceeded {
                if !limits.contains(&at) {
                    limits.push(at);
                }
            }
            if self.half.samples <= PROVABLE {
                let (duals, at_most) = Duals::of(self, &cells, &limits[..rounds_limits], &solution.duals);
                if at_most < distance * (1.0 - ROUNDING) {
                    return Answer::Beyond(duals);
                }
                if excess < NEAR {
                    cuts.extend(duals.cuts());
                    tidy(&mut cuts, free);
                }
            }
            if (rounds_limits, rounds_cuts) == (limits.len(), cuts.len()) || cuts.len() > CELLS {
                break;
            }
        }
        Answer::Unknown
    }

    fn program(&self, cuts: &[f64], limits: &[At]) -> Program {
        let cells = || cuts.windows(2).map(|cell| (cell[0], cell[1]));
        let mut program =
            Program::new(cells().map(|(p, q)| self.half.gain(p, q)).collect(), [1.0].repeat(cuts.len() - 1));
        program.bound(cells().map(|(p, q)| self.half.rest(p, q)), 0.0);
        for at in limits {
            program.bound(cells().map(|(p, q)| at.weight(p, q)), self.bounds[at.m - 1]);
        }
        program
    }

    fn reached(&self, cells: &[Cell]) -> f64 {
        let mut start = 0.0;
        let gains =
            cells.iter().map(|cell| cell.u * self.half.gain(core::mem::replace(&mut start, cell.end), cell.end));
        gains.sum()
    }

    /// Largest relative excess of the cells over a limit, and its times: first, most and last in each stretch of excess.
    fn exceeded(&self, cells: &[Cell]) -> (f64, Vec<At>) {
        let half = &self.half;
        let mut watches: Vec<Watch> =
            (1..half.order).map(|m| Watch::new(m, self.bounds[m - 1], half.last(m))).collect();
        let (mut start, mut state) = (0.0, [0.0; 4]);
        // Behind the cells the middle sample, and the delay of the cascade.
        let middle = Cell { end: half.free() + 3.0, u: 0.0 };
        for cell in cells.iter().copied().chain([middle]) {
            state[0] = cell.u;
            let mut k = start;
            while k < cell.end {
                let now = after(state, k - start);
                for watch in &mut watches {
                    watch.see(k, &now);
                }
                k += 1.0;
            }
            state = after(state, cell.end - start);
            start = cell.end;
        }
        let excess = watches.iter().map(|watch| watch.excess).fold(0.0, f64::max);
        (excess, watches.into_iter().flat_map(Watch::found).collect())
    }
}

/// In order, each once, from 0 to `free`.
fn tidy(cuts: &mut Vec<f64>, free: f64) {
    cuts.retain(|cut| (0.0..=free).contains(cut));
    cuts.sort_by(f64::total_cmp);
    cuts.dedup();
}

/// Watches one limit up to a last time.
struct Watch {
    m: usize,
    bound: f64,
    last: f64,
    excess: f64,
    /// The current stretch of excess: its first time, its peak and the time of that, its last time.
    stretch: Option<(f64, (f64, f64), f64)>,
    found: Vec<At>,
}

impl Watch {
    const fn new(m: usize, bound: f64, last: f64) -> Self {
        Self { m, bound, last, excess: 0.0, stretch: None, found: Vec::new() }
    }

    fn see(&mut self, k: f64, state: &[f64]) {
        let excess = state[self.m].abs() / self.bound - 1.0;
        if k > self.last {
            return;
        }
        self.excess = self.excess.max(excess);
        if excess <= 0.1 * ROUNDING {
            self.close();
        } else {
            let (first, peak, _) = self.stretch.unwrap_or((k, (excess, k), k));
            self.stretch = Some((first, if excess > peak.0 { (excess, k) } else { peak }, k));
        }
    }

    fn close(&mut self) {
        if let Some((first, (_, peak), last)) = self.stretch.take() {
            self.found.extend([first, peak, last].map(|k| At { m: self.m, k }));
        }
    }

    fn found(mut self) -> Vec<At> {
        self.close();
        self.found
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampled::shortest::whole;
    use crate::{Limits, Order, Profile};
    use proptest::prelude::*;

    fn index(k: f64) -> usize {
        usize::try_from(whole(k)).unwrap()
    }

    /// Bound by `duals` that no move of N samples exceeds, from the chain itself: the whole move instead of its half, costs added
    /// up backwards integrator by integrator instead of by binomial coefficients.
    fn at_most(duals: &Duals, bounds: &[f64], total: usize) -> f64 {
        let n = bounds.len();
        // Costs of the m-th integral at each time, half of them at the time of the reflection.
        let mut costs = vec![vec![0.0; total + n]; n + 1];
        let mut paid = 0.0;
        for (At { m, k }, dual) in duals.limits() {
            let k = index(k);
            let mirrored = total + m - 1 - k;
            let sign = if m.is_multiple_of(2) == n.is_multiple_of(2) { -1.0 } else { 1.0 };
            costs[m][k] += 0.5 * dual;
            costs[m][mirrored] += 0.5 * sign * dual;
            paid += dual.abs() * bounds[m - 1];
        }
        // Contribution of a unit at sample i to x, and its cost.
        let (mut worth, mut cost) = (vec![0.0; total], vec![0.0; total]);
        let mut adjoint = vec![0.0; n + 1];
        let mut value = vec![0.0; n + 1];
        value[n] = 1.0;
        for i in (0..total).rev() {
            for m in 1..=n {
                adjoint[m] += costs[m].get(i + 1).filter(|_| m < n).copied().unwrap_or(0.0);
            }
            cost[i] = adjoint[1];
            worth[i] = value[1];
            for m in 1..n {
                adjoint[m] += adjoint[m + 1];
                value[m] += value[m + 1];
            }
        }
        // Conditions of rest remove any polynomial of degree n − 2: the one that the slopes of the half stand for.
        let slope = |i: usize| {
            let mirrored = total - 1 - i;
            let (at, sign) =
                if i <= mirrored { (i, 1.0) } else { (mirrored, if n.is_multiple_of(2) { -1.0 } else { 1.0 }) };
            let is_middle = i == mirrored && n.is_multiple_of(2);
            if is_middle { 0.0 } else { sign * duals.slope(at) * if i == mirrored { 1.0 } else { 0.5 } }
        };
        let off: Vec<f64> = (0..total).map(|i| worth[i] - cost[i] - slope(i)).collect();
        let size = worth[0];
        for window in off.windows(n) {
            let difference = (0..n).fold(window.to_vec(), |list, step| {
                if step + 1 < n { list.windows(2).map(|pair| pair[1] - pair[0]).collect() } else { list }
            });
            assert!(difference[0].abs() <= 1e-9 * size, "no polynomial of degree {}: {difference:?} of {size}", n - 2);
        }
        paid + (0..total).map(|i| slope(i).abs()).sum::<f64>()
    }

    proptest! {
        /// One sample less than planned is proven to be impossible, by sums over the whole chain.
        #[test]
        fn no_move_of_a_sample_less_gets_there(
            order in (0..3_usize).prop_map(|i| [Order::Second, Order::Third, Order::Fourth][i]),
            exponents in [-2.0..1.0_f64, -1.5..1.5_f64, -1.0..2.0_f64, 0.0..3.0_f64],
            distance in -2.0..1.5_f64,
            samples in 6.0..290.0_f64,
        ) {
            let [velocity, acceleration, jerk, snap] = exponents.map(|exponent| 10.0_f64.powf(exponent));
            let limits = Limits { velocity, acceleration, jerk, snap };
            let distance = 10.0_f64.powf(distance);
            let continuous = Profile::plan_optimal(order, distance, &limits).unwrap();
            let ts = continuous.duration() / samples;
            let plan = crate::sampled::Shortest::plan(order, distance, &limits, ts).unwrap();
            prop_assume!(plan.at_least() == plan.samples());
            let n = order.derivative();
            let scaled = [velocity * ts, acceleration * ts.powi(2), jerk * ts.powi(3), snap * ts.powi(4)];
            let mut bounds: Vec<f64> = scaled[..n].iter().rev().skip(1).map(|bound| bound / scaled[n - 1]).collect();
            bounds.push(distance / scaled[n - 1]);
            let samples = (plan.samples() - 1) as f64;
            let half = Half { order: n, samples };
            let pace = samples / continuous.duration();
            let reach = Reach { half, bounds: &bounds };
            let Answer::Beyond(duals) = reach.answer(continuous.segments().map(|segment| segment.start * pace)) else {
                return Err(TestCaseError::fail("no proof"));
            };
            let most = at_most(&duals, &bounds, index(samples));
            prop_assert!(most < bounds[n - 1], "{most} {}", bounds[n - 1]);
            prop_assert!((most / duals.at_most(&bounds) - 1.0).abs() < 1e-9, "the half says the same");
        }
    }
}
