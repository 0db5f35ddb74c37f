//! Half a kick: effect of the efforts of one instant on the velocities in half a tick, with positions fixed.
//!
//! ```text
//! M·Δv = h/2·(F − D·(v + Δv/2))      trapezoidal rule in the damping
//! (M + h/4·D)·Δv = h/2·(F − D·v)     M diagonal, D tridiagonal: a chain
//! ```
//! Each half kick is symmetric in time, and so is half kick – drift – half kick: the scheme is of second
//! order with damping too, and no damper is too strong for it. Source: Hairer, Lubich & Wanner, *Geometric Numerical
//! Integration*, 2nd ed., §II.3 (symmetric methods), §II.5 (splitting).
use servobench_plant::Chain;

/// Half a kick of a chain with some bodies held.
pub(crate) struct HalfKick<const N: usize> {
    /// Half a tick (s).
    half_tick: f64,
    /// Entries (i, i) of `M + h/4·D`.
    diagonal: [f64; N],
    /// Entries (i, i+1) of `M + h/4·D`.
    off_diagonal: [f64; N],
    /// Held bodies, body i being bit i: their velocity does not change.
    held: usize,
    /// h/2 times the inverse of the matrix without the rows and columns of held bodies.
    response: [[f64; N]; N],
}

impl<const N: usize> HalfKick<N> {
    pub(crate) fn new(chain: &Chain, step: f64) -> Self {
        let (mut diagonal, mut off_diagonal) = ([0.0; N], [0.0; N]);
        for (entry, body) in diagonal.iter_mut().zip(chain.bodies()) {
            *entry = body.inertia + step / 4.0 * body.friction.linear();
        }
        for (i, link) in chain.links().iter().enumerate() {
            let (near, far) = (chain.bodies()[i].transmission, chain.bodies()[i + 1].transmission);
            diagonal[i] += step / 4.0 * link.damping * near * near;
            diagonal[i + 1] += step / 4.0 * link.damping * far * far;
            off_diagonal[i] = -step / 4.0 * link.damping * near * far;
        }
        let response = [[0.0; N]; N];
        let mut kick = Self { half_tick: step / 2.0, diagonal, off_diagonal, held: 0, response };
        kick.respond();
        kick
    }

    /// Sets the held bodies.
    #[inline]
    pub(crate) fn hold(&mut self, held: usize) {
        if self.held != held {
            self.held = held;
            self.respond();
        }
    }

    /// Change of the velocities in half a tick; `efforts` are F − D·v (N or N·m).
    #[inline]
    pub(crate) fn velocity_change(&self, efforts: &[f64; N]) -> [f64; N] {
        let mut change = [0.0; N];
        for (column, effort) in self.response.iter().zip(efforts) {
            for (change, entry) in change.iter_mut().zip(column) {
                *change += entry * effort;
            }
        }
        change
    }

    /// Computes `response` column by column: elimination downwards, substitution upwards.
    fn respond(&mut self) {
        // Reciprocal pivots; zero drops a held body's row and column.
        let mut reciprocal = [0.0; N];
        let mut coupled = 0.0;
        for (i, reciprocal) in reciprocal.iter_mut().enumerate() {
            if self.held & (1 << i) == 0 {
                *reciprocal = 1.0 / (self.diagonal[i] - coupled);
            }
            coupled = self.off_diagonal[i] * self.off_diagonal[i] * *reciprocal;
        }
        for (j, column) in self.response.iter_mut().enumerate() {
            *column = [0.0; N];
            column[j] = self.half_tick;
            for i in 1..N {
                column[i] -= self.off_diagonal[i - 1] * reciprocal[i - 1] * column[i - 1];
            }
            let mut next = 0.0;
            for i in (0..N).rev() {
                next = (column[i] - self.off_diagonal[i] * next) * reciprocal[i];
                column[i] = next;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Matrix3, Vector3};
    use servobench_base::Coordinate;
    use servobench_plant::{Body, Friction, Link};

    const H: f64 = 1.0 / 16_000.0;

    fn chain() -> Chain {
        let body = |inertia, transmission, viscous| Body {
            name: "body",
            coordinate: Coordinate::Linear,
            inertia,
            transmission,
            friction: Friction { viscous, ..Friction::NONE },
            bias: 0.0,
        };
        let link = |damping| Link { stiffness: 1.0, damping };
        Chain::new(
            vec![body(1e-3, 0.01, 0.02), body(20.0, 1.0, 300.0), body(5.0, 1.0, 10.0)],
            vec![link(2e5), link(7e5)],
        )
        .unwrap()
    }

    /// Oracle: the dense system, by nalgebra's LU. A held body's row and column are removed.
    #[test]
    fn the_tridiagonal_solution_is_that_of_the_dense_system() {
        let damping = Matrix3::new(0.02 + 20.0, -2e3, 0.0, -2e3, 300.0 + 9e5, -7e5, 0.0, -7e5, 10.0 + 7e5);
        let efforts = [0.3, -40.0, 7.0];
        for held in 0..8_usize {
            let mut kick = HalfKick::<3>::new(&chain(), H);
            kick.hold(held);
            let found = kick.velocity_change(&efforts);
            let mut matrix = Matrix3::from_diagonal(&Vector3::new(1e-3, 20.0, 5.0)) + H / 4.0 * damping;
            let mut right = H / 2.0 * Vector3::new(efforts[0], efforts[1], efforts[2]);
            for i in (0..3).filter(|i| held & (1 << i) != 0) {
                matrix.row_mut(i).fill(0.0);
                matrix.column_mut(i).fill(0.0);
                matrix[(i, i)] = 1.0;
                right[i] = 0.0;
            }
            let expected = matrix.lu().solve(&right).unwrap();
            for i in 0..3 {
                // Condition number below 1e5.
                let tolerance = 1e-11 * expected.amax();
                assert!((found[i] - expected[i]).abs() <= tolerance, "held {held:b}: {found:?} {expected}");
            }
        }
    }
}
