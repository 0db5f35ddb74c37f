//! States in a loop that a controller closes, found only from the structure of the matrices.
//!
//! State j acts on state i when entry (i, j) of the matrix of a tick is not zero. Over the common period that is a graph,
//! whose strongly connected components are the blocks on the diagonal of the block-triangular matrix M: the eigenvalues
//! of M are theirs. A component without a controller's state is not closed by any loop: the position of an axis that is not
//! held, bodies and springs that the drive does not act on; their poles are on the circle or inside, by physics. Neither is one
//! of controllers' states alone: an integrator without input, a filter.
//! Source: Tarjan, *SIAM J. Comput.* 1(2), 1972 (components); Murota, *Matrices and Matroids for Systems Analysis*, §2.
use nalgebra::DMatrix;

/// Structure of a matrix: bit j of row i is set if state j acts on state i.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Pattern(Vec<Row>);

/// A set of states, 64 a word.
type Row = Vec<u64>;

fn contains(row: &Row, j: usize) -> bool {
    row[j / 64] & 1 << (j % 64) != 0
}

fn insert(row: &mut Row, j: usize) {
    row[j / 64] |= 1 << (j % 64);
}

fn unite(row: &mut Row, other: &Row) {
    for (word, other) in row.iter_mut().zip(other) {
        *word |= other;
    }
}

impl Pattern {
    /// The structure of `size` states in which state j acts on state i if `acts(j, i)`.
    #[must_use]
    pub fn with_rows(size: usize, acts: impl Fn(usize, usize) -> bool) -> Self {
        let row = |i: usize| {
            let mut row = vec![0; size.div_ceil(64)];
            (0..size).filter(|&j| acts(j, i)).for_each(|j| insert(&mut row, j));
            row
        };
        Self((0..size).map(row).collect())
    }

    /// The structure of `size` states that act only on themselves.
    #[must_use]
    pub fn identity(size: usize) -> Self {
        Self::with_rows(size, |j, i| i == j)
    }

    /// The structure of a matrix: set where it is not exactly zero.
    #[must_use]
    pub fn of(matrix: &DMatrix<f64>) -> Self {
        Self::with_rows(matrix.nrows(), |j, i| matrix[(i, j)] != 0.0)
    }

    /// The structure of the product with `first`, which comes before this one.
    #[must_use]
    pub fn after(&self, first: &Self) -> Self {
        let through = |row: &Row| {
            let mut sum = vec![0; row.len()];
            (0..self.0.len()).filter(|&j| contains(row, j)).for_each(|j| unite(&mut sum, &first.0[j]));
            sum
        };
        Self(self.0.iter().map(through).collect())
    }

    /// The strongly connected components with states of both a controller, as given by `is_controllers`, and the controlled system.
    #[must_use]
    pub fn loops(&self, is_controllers: &[bool]) -> Vec<Vec<usize>> {
        let is_controllers = |j: &usize| is_controllers[*j];
        let holds_both = |one: &Vec<usize>| one.iter().any(is_controllers) && !one.iter().all(is_controllers);
        self.components().into_iter().filter(holds_both).collect()
    }

    /// The strongly connected components; a state that does not act on itself is not one.
    #[must_use]
    pub fn components(&self) -> Vec<Vec<usize>> {
        let size = self.0.len();
        let mut reached = self.0.clone();
        for via in 0..size {
            let through = reached[via].clone();
            reached.iter_mut().filter(|row| contains(row, via)).for_each(|row| unite(row, &through));
        }
        let acts = |j: usize, i: usize| contains(&reached[i], j);
        let mut is_seen = vec![false; size];
        let mut components = Vec::new();
        for i in 0..size {
            if is_seen[i] || !acts(i, i) {
                continue;
            }
            let component: Vec<usize> = (i..size).filter(|&j| acts(i, j) && acts(j, i)).collect();
            for &j in &component {
                is_seen[j] = true;
            }
            components.push(component);
        }
        components
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Number of states, which takes two words.
    const SIZE: usize = 100;
    const CONTROLLER: usize = 12;

    fn controllers() -> Vec<bool> {
        (0..SIZE).map(|j| (CONTROLLER..60).contains(&j)).collect()
    }

    fn pattern(edges: &[(usize, usize)]) -> Pattern {
        let mut matrix = DMatrix::zeros(SIZE, SIZE);
        for &(from, to) in edges {
            matrix[(to, from)] = 1e-300;
        }
        Pattern::of(&matrix)
    }

    /// A ring through a controller and a late sensor, a ring without one, a chain behind them, a ring of controllers.
    #[test]
    fn only_rings_through_a_controller_are_loops() {
        let c = CONTROLLER;
        let ring = pattern(&[(0, SIZE - 1), (SIZE - 1, c), (c, 2), (2, 0), (3, 4), (4, 3), (2, 5), (5, c + 1)]);
        assert_eq!(ring.loops(&controllers()), [vec![0, 2, c, SIZE - 1]]);
        assert_eq!(
            pattern(&[(c, c), (0, 0), (1, c), (c + 1, c + 2), (c + 2, c + 1)]).loops(&controllers()),
            [[0; 0]; 0]
        );
    }

    #[test]
    fn patterns_multiply_as_matrices_do() {
        let first = pattern(&[(0, 1), (1, 1)]);
        let second = pattern(&[(1, 2)]);
        assert_eq!(second.after(&first), pattern(&[(0, 2), (1, 2)]));
        assert_eq!(second.after(&Pattern::identity(SIZE)), second);
    }
}
