//! Which states are in a loop that a controller closes, by what acts on what and nothing else.
//!
//! State j acts on state i when entry (i, j) of the matrix of a tick is not zero. Over the common period that is a graph,
//! whose strongly connected components are the blocks on the diagonal of the block-triangular matrix M: the eigenvalues
//! of M are theirs. A component without a controller's state is not closed by any loop: the position of an axis that nobody
//! holds, bodies and springs that the drive does not act on; their poles are on the circle or inside, by physics. Neither is one
//! of controllers' states alone: an integrator without input, a filter.
//! Source: Tarjan, *SIAM J. Comput.* 1(2), 1972 (components); Murota, *Matrices and Matroids for Systems Analysis*, §2.
use crate::state::{CONTROLLER, MOST_STATES};
use nalgebra::DMatrix;

/// What acts on what: bit j of row i says whether state j acts on state i.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Pattern([u64; MOST_STATES]);

impl Pattern {
    /// Every state acts on itself alone.
    pub(crate) fn identity() -> Self {
        Self(std::array::from_fn(|i| 1 << i))
    }

    /// Of a matrix: where it is not exactly zero.
    pub(crate) fn of(matrix: &DMatrix<f64>) -> Self {
        let size = matrix.nrows();
        let row = |i: usize| (0..size).filter(|&j| matrix[(i, j)] != 0.0).fold(0, |row, j| row | 1 << j);
        Self(std::array::from_fn(|i| if i < size { row(i) } else { 0 }))
    }

    /// What acts on what when `first` comes before this one.
    pub(crate) fn after(&self, first: &Self) -> Self {
        let through = |row: u64| (0..MOST_STATES).filter(|&j| row & 1 << j != 0).fold(0, |sum, j| sum | first.0[j]);
        Self(self.0.map(through))
    }

    /// The strongly connected components that hold states of a controller and of what it controls.
    pub(crate) fn loops(&self) -> Vec<Vec<usize>> {
        let mut reached = self.0;
        for via in 0..MOST_STATES {
            for i in 0..MOST_STATES {
                if reached[i] & 1 << via != 0 {
                    reached[i] |= reached[via];
                }
            }
        }
        let acts = |j: usize, i: usize| reached[i] & 1 << j != 0;
        let mut is_seen = [false; MOST_STATES];
        let mut loops = Vec::new();
        for i in 0..MOST_STATES {
            if is_seen[i] || !acts(i, i) {
                continue;
            }
            let component: Vec<usize> = (i..MOST_STATES).filter(|&j| acts(i, j) && acts(j, i)).collect();
            for &j in &component {
                is_seen[j] = true;
            }
            if component.iter().any(|&j| j >= CONTROLLER) && component.iter().any(|&j| j < CONTROLLER) {
                loops.push(component);
            }
        }
        loops
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pattern(edges: &[(usize, usize)]) -> Pattern {
        let mut matrix = DMatrix::zeros(MOST_STATES, MOST_STATES);
        for &(from, to) in edges {
            matrix[(to, from)] = 1e-300;
        }
        Pattern::of(&matrix)
    }

    /// A ring through a controller, a ring without one, a chain behind them, a ring of controllers.
    #[test]
    fn only_rings_through_a_controller_are_loops() {
        let c = CONTROLLER;
        let ring = pattern(&[(0, c), (c, 2), (2, 0), (3, 4), (4, 3), (2, 5), (5, c + 1)]);
        assert_eq!(ring.loops(), [vec![0, 2, c]]);
        assert_eq!(pattern(&[(c, c), (0, 0), (1, c), (c + 1, c + 2), (c + 2, c + 1)]).loops(), [[0; 0]; 0]);
    }

    #[test]
    fn patterns_multiply_as_matrices_do() {
        let first = pattern(&[(0, 1), (1, 1)]);
        let second = pattern(&[(1, 2)]);
        assert_eq!(second.after(&first), pattern(&[(0, 2), (1, 2)]));
        assert_eq!(second.after(&Pattern::identity()), second);
    }
}
