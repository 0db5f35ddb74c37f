//! The first half of a move, and the effect of its samples.
//!
//! All in units of the sample time and of the limit of the highest derivative: u_i with |u_i| ≤ 1 at sample i. At time k its
//! m-th integral by the cascade is `Σ u_i·(C(k − i, m) − C(k − i − 1, m))`, as C(t, m) is the m-th integral at t of a unit sent
//! from time 0 on. The move ends at rest at time N, the n-th integral at the distance.
//!
//! # Half a move is enough
//!
//! A move reversed in time is a move: u'_i = ±u_(N−1−i), with − at even orders and + at odd ones, ends at rest at the
//! same distance. Its m-th integral at k is, except for the sign, that of the move at N + m − 1 − k: the same values, so that it
//! keeps the limits. These are convex; the mean of both moves keeps them too,
//! covers the same distance, and is its own reflection. **Moves with u_i = ±u_(N−1−i) are therefore enough**: unknown is the
//! first half. Of the conditions of rest at the end, Σ i^p·u_i = 0 for p < n − 1, symmetry leaves none at order 2, Σ u_i = 0
//! at order 3 and Σ (N − 1 − 2i)·u_i = 0 at order 4.
use super::cascade;
use servobench_base::Setpoint;

/// A time (samples) of the m-th integral: 1 is that of the highest derivative.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct At {
    pub(super) m: usize,
    pub(super) k: f64,
}

impl At {
    /// Effect of u = 1 in the samples from `p` to `q`.
    pub(super) fn weight(self, p: f64, q: f64) -> f64 {
        integral(self.m, self.k - p) - integral(self.m, self.k - q)
    }
}

/// The highest derivative and its first three integrals.
pub(super) type State = [f64; 4];

/// The first half of a move.
#[derive(Debug, Clone, Copy)]
pub(super) struct Half {
    /// n.
    pub(super) order: usize,
    /// N.
    pub(super) samples: f64,
}

impl Half {
    const fn is_odd(&self) -> bool {
        !self.order.is_multiple_of(2)
    }

    /// Number of samples in it that are free: at even orders the middle one of an odd number is zero.
    pub(super) fn free(&self) -> f64 {
        if self.is_odd() { libm::ceil(0.5 * self.samples) } else { libm::floor(0.5 * self.samples) }
    }

    /// Effect of u = 1 in the samples from `p` to `q` on the distance, together with its reflection; the middle sample is its own.
    pub(super) fn gain(&self, p: f64, q: f64) -> f64 {
        let end = At { m: self.order, k: self.samples };
        let (there, back) = (end.weight(p, q), end.weight(self.samples - q, self.samples - p));
        let twice = if 2.0 * q > self.samples { end.weight(self.samples - q, q) } else { 0.0 };
        if self.is_odd() { there + back - twice } else { there - back }
    }

    /// Its effect on the one condition of rest that symmetry leaves.
    pub(super) fn rest(&self, p: f64, q: f64) -> f64 {
        match self.order {
            2 => 0.0,
            3 => 2.0 * (q - p) - (2.0 * q - self.samples).max(0.0),
            _ => (q - p) * (self.samples - p - q),
        }
    }

    /// The last time at which the m-th integral is not the reflection of an earlier one.
    pub(super) fn last(&self, m: usize) -> f64 {
        libm::floor(0.5 * (self.samples + m as f64 - 1.0))
    }
}

/// C(t, m), the m-th integral of a unit that began t samples ago; zero before.
fn integral(m: usize, t: f64) -> f64 {
    const INVERSE: [f64; 4] = [1.0, 0.5, 1.0 / 3.0, 0.25];
    let t = t.max(0.0);
    INVERSE[..m].iter().enumerate().fold(1.0, |product, (i, inverse)| product * (t - i as f64) * inverse)
}

/// The integrals `steps` samples on.
pub(super) fn after([u, j, a, v]: State, steps: f64) -> State {
    let Setpoint { v, a, j, s, .. } = cascade::after(Setpoint { x: 0.0, v, a, j, s: u }, 1.0, steps);
    [s, j, a, v]
}
