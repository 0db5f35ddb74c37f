//! A move by its first half: its exact hold, and the samples that are sent.
use super::reach::Cell;
use super::shortest::whole;
use super::{Execution, Run, cascade};
use crate::{Order, Peaks, Piece};
use servobench_base::Setpoint;
use std::vec::Vec;

/// A move that is its own reflection.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct SymmetricMove {
    order: Order,
    distance: f64,
    sample_time: f64,
    duration: f64,
    /// The pieces up to the middle; never none.
    pieces: Vec<Held>,
}

/// A stretch with one highest derivative.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Held {
    /// Start, counted from that of the move, and length (samples; half ones at the middle).
    start: f64,
    count: f64,
    /// At the start.
    state: Setpoint,
}

impl SymmetricMove {
    /// The move of `samples` that begins with `cells`.
    pub(super) fn new(order: Order, distance: f64, sample_time: f64, samples: f64, cells: &[Cell]) -> Self {
        let middle = 0.5 * samples;
        let rest = Cell { end: middle, u: 0.0 };
        let (mut pieces, mut start): (Vec<Held>, f64) = (Vec::new(), 0.0);
        for Cell { end, u } in cells.iter().copied().chain([rest]) {
            let count = end.min(middle) - start;
            match pieces.last_mut() {
                _ if count == 0.0 => {}
                Some(last) if highest(order, &last.state).to_bits() == u.to_bits() => last.count += count,
                _ => pieces.push(Held { start, count, state: sending(order, Setpoint::default(), u) }),
            }
            start += count;
        }
        let mut state = Setpoint::default();
        for piece in &mut pieces {
            state = sending(order, state, highest(order, &piece.state));
            piece.state = state;
            state = state.after(piece.count * sample_time);
        }
        // The amplitude that covers half of the distance in the middle.
        let amplitude = 0.5 * distance / state.x;
        for piece in &mut pieces {
            let scaled = piece.state.scaled(amplitude);
            // The sum turns a negative zero into a positive one.
            piece.state = sending(order, scaled, 0.0 + highest(order, &scaled));
        }
        Self { order, distance, sample_time, duration: samples * sample_time, pieces }
    }

    /// The highest derivative, run by run.
    pub(super) fn runs(&self) -> Vec<Run> {
        let sign = if self.order == Order::Third { 1.0 } else { -1.0 };
        let there = self.pieces.iter().map(|piece| (piece.count, highest(self.order, &piece.state)));
        let back = there.clone().rev().map(|(count, value)| (count, 0.0 + sign * value));
        let mut runs: Vec<(f64, f64)> = Vec::new();
        for (count, value) in there.chain(back) {
            match runs.last_mut() {
                Some((last, same)) if same.to_bits() == value.to_bits() => *last += count,
                _ => runs.push((count, value)),
            }
        }
        runs.into_iter().map(|(count, value)| Run { value, count: whole(count) }).collect()
    }

    /// The polynomial of the exact hold at `t` (s), as [`Profile::piece`](crate::Profile::piece).
    pub(super) fn piece(&self, t: f64) -> Piece {
        let Self { distance, sample_time, duration, .. } = *self;
        let tolerance = (1e-9 * sample_time).max(4.0 * f64::EPSILON * duration);
        let reached = t + tolerance;
        if reached >= duration {
            return Piece::at_rest(distance);
        }
        if reached < 0.0 || t.is_nan() {
            return Piece { tolerance, until: 0.0, ..Piece::at_rest(0.0) };
        }
        let half = 0.5 * duration;
        let is_late = reached >= half;
        let nearer = if is_late { duration - reached } else { reached };
        let after = self.pieces.partition_point(|piece| piece.start * sample_time <= nearer).max(1);
        let Held { start, count, state: anchor } = self.pieces[after - 1];
        let (start, length) = (start * sample_time, count * sample_time);
        if is_late {
            let until = if after == 1 { 0.0 } else { (-start).next_up() };
            Piece { anchor, start, length, origin: duration, sign: -1.0, base: distance, tolerance, until }
        } else {
            let until = self.pieces.get(after).map_or(half, |next| next.start * sample_time);
            Piece { anchor, start, length, origin: 0.0, sign: 1.0, base: 0.0, tolerance, until }
        }
    }

    /// The largest magnitudes of an execution: of `runs` at every sample, of the hold at the ends and turning points of its
    /// pieces. The first half has them all; the sums of the cascade reach its middle n − 1 samples later at most, and beyond it
    /// they only gather rounding.
    pub(super) fn peaks(&self, execution: Execution, runs: &[Run]) -> Peaks {
        let Self { order, sample_time, .. } = *self;
        let mut most = [0.0_f64; 4];
        let mut see = |Setpoint { v, a, j, s, .. }: Setpoint| {
            for (most, value) in most.iter_mut().zip([v, a, j, s]) {
                *most = most.max(value.abs());
            }
        };
        match execution {
            Execution::ForwardEuler => {
                let samples: u64 = runs.iter().map(|run| run.count).sum();
                let mut left = samples.div_ceil(2) + order.derivative() as u64;
                let mut start = Setpoint::default();
                for Run { value, count } in runs.iter().copied() {
                    start = sending(order, start, value);
                    let count = count.min(left);
                    left -= count;
                    for k in 0..count {
                        see(cascade::after(start, sample_time, k as f64));
                    }
                    start = cascade::after(start, sample_time, count as f64);
                }
            }
            Execution::ExactHold => {
                for Held { count, state, .. } in &self.pieces {
                    let length = count * sample_time;
                    let inside = turning_points(state).into_iter().filter(|t| *t > 0.0 && *t < length);
                    for t in inside.chain([0.0, length]) {
                        see(state.after(t));
                    }
                }
            }
        }
        most[order.derivative()..].fill(f64::INFINITY);
        let [velocity, acceleration, jerk, snap] = most;
        Peaks { velocity, acceleration, jerk, snap }
    }
}

/// `state` with the highest derivative `value`.
const fn sending(order: Order, mut state: Setpoint, value: f64) -> Setpoint {
    match order {
        Order::Second => state.a = value,
        Order::Third => state.j = value,
        Order::Fourth => state.s = value,
    }
    state
}

/// Its highest derivative.
const fn highest(order: Order, state: &Setpoint) -> f64 {
    match order {
        Order::Second => state.a,
        Order::Third => state.j,
        Order::Fourth => state.s,
    }
}

/// Times at which jerk or acceleration pass zero while the snap stays.
fn turning_points(&Setpoint { a, j, s, .. }: &Setpoint) -> [f64; 3] {
    // The quadratic formula without cancellation.
    let q = -(j + libm::sqrt((j * j - 2.0 * s * a).max(0.0)).copysign(j));
    [-j / s, q / s, 2.0 * a / q]
}
