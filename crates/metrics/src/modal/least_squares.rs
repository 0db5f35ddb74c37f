//! Linear least squares by orthonormal columns.
use super::columns::{Columns, dot, remove_from_each};

/// Below this share of its own length, the remainder of a column after projection is rounding.
const DEPENDENT: f64 = 1e-11;
/// A projection that leaves more than this share of a vector (squared) has not cancelled.
const SOUND: f64 = 0.1;

/// Orthonormal columns Q and the triangle R of `A = Q·R`.
///
/// By modified Gram–Schmidt: each column of Q, once known, is removed from all later ones. Where that cancels, a second time,
/// which is enough (Giraud, Langou, Rozložník, 2005).
#[derive(Debug, Clone)]
pub(crate) struct Orthonormal {
    columns: Columns,
    /// The columns of R, contiguous, each with its zeros.
    triangle: Vec<f64>,
}

/// The best linear combination of columns.
#[derive(Debug, Clone)]
pub(crate) struct Solution {
    pub(crate) basis: Orthonormal,
    /// Factors of the columns.
    pub(crate) coefficients: Vec<f64>,
    /// Difference between the values and the combination.
    pub(crate) residual: Vec<f64>,
}

impl Solution {
    /// The sum of `columns` nearest to `values`; `None` when they are linearly dependent or not finite.
    pub(crate) fn of(columns: &Columns, values: &[f64]) -> Option<Self> {
        let count = columns.count();
        let mut columns = columns.clone();
        columns.push(values.iter().copied());
        let before: Vec<f64> = columns.iter().map(|column| dot(column, column)).collect();
        let (mut triangle, mut along) = (vec![0.0; count * count], vec![0.0; count + 1]);
        let mut coordinates = vec![0.0; count];
        for k in 0..count {
            let (there, rest) = columns.split_at_mut(k);
            let (column, later) = rest.split_at_mut(values.len());
            let above = &mut triangle[k * count..][..count];
            above[k] = make_unit(there.chunks_exact(values.len()), column, before[k], above)?;
            let along = &mut along[k + 1..];
            remove_from_each(column, later, along);
            for (j, along) in (k + 1..count).zip(&*along) {
                triangle[j * count + k] = *along;
            }
            coordinates[k] = along[count - k - 1];
        }
        let mut residual = columns.pop();
        remove_again(columns.iter(), &mut residual, before[count], &mut coordinates);
        let basis = Orthonormal { columns, triangle };
        let coefficients = basis.back_substitute(coordinates);
        Some(Self { basis, coefficients, residual })
    }
}

impl Orthonormal {
    /// Sum of squares of `residual`, orthogonal to the columns present, that each group of further `columns` would remove; `None` when
    /// they depend on those present, or on each other. A group has `width` columns.
    pub(crate) fn gains(&self, mut columns: Columns, width: usize, residual: &[f64]) -> Vec<Option<f64>> {
        let before: Vec<f64> = columns.iter().map(|column| dot(column, column)).collect();
        self.remove_once(&mut columns);
        let groups = columns.all_mut().chunks_exact_mut(width * residual.len()).zip(before.chunks_exact(width));
        groups.map(|(columns, before)| self.gain(columns, before, residual)).collect()
    }

    /// The gain of one group, from which the columns present were removed once.
    fn gain(&self, columns: &mut [f64], before: &[f64], residual: &[f64]) -> Option<f64> {
        let mut sum = 0.0;
        for (k, before) in before.iter().enumerate() {
            let (further, rest) = columns.split_at_mut(k * residual.len());
            let column = &mut rest[..residual.len()];
            for further in further.chunks_exact(residual.len()) {
                remove_from_each(further, column, &mut [0.0]);
            }
            let there = self.columns.iter().chain(further.chunks_exact(residual.len()));
            make_unit(there, column, *before, &mut [])?;
            let along = dot(column, residual);
            sum += along * along;
        }
        Some(sum)
    }

    /// Subtracts from each of `vectors` its projection on the columns, in one pass: not orthogonal to the last digit where it cancels.
    pub(crate) fn remove_once(&self, vectors: &mut Columns) {
        let mut along = vec![0.0; vectors.count()];
        for column in self.columns.iter() {
            remove_from_each(column, vectors.all_mut(), &mut along);
        }
    }

    /// The solution x of `R·x = coordinates`.
    fn back_substitute(&self, mut coordinates: Vec<f64>) -> Vec<f64> {
        let count = coordinates.len();
        for k in (0..count).rev() {
            let column = &self.triangle[k * count..];
            coordinates[k] /= column[k];
            let known = coordinates[k];
            for (x, r) in coordinates[..k].iter_mut().zip(column) {
                *x -= r * known;
            }
        }
        coordinates
    }
}

/// Solves the symmetric positive definite `a·x = b` by Cholesky, from the lower triangle of `a`; `None` when it is not
/// definite.
pub(crate) fn solve_definite(mut a: Vec<Vec<f64>>, mut b: Vec<f64>) -> Option<Vec<f64>> {
    let n = b.len();
    for i in 0..n {
        for j in 0..=i {
            let sum: f64 = a[i][j] - (0..j).map(|k| a[i][k] * a[j][k]).sum::<f64>();
            if i != j {
                a[i][j] = sum / a[j][j];
            } else if sum > 0.0 {
                a[i][i] = sum.sqrt();
            } else {
                return None;
            }
        }
    }
    for i in 0..n {
        b[i] = (b[i] - (0..i).map(|k| a[i][k] * b[k]).sum::<f64>()) / a[i][i];
    }
    for i in (0..n).rev() {
        b[i] = (b[i] - (i + 1..n).map(|k| a[k][i] * b[k]).sum::<f64>()) / a[i][i];
    }
    b.iter().all(|x| x.is_finite()).then_some(b)
}

/// Makes `vector`, which had the squared length `before` and from which the unit vectors `there` were removed once, orthogonal to
/// them, and adds the removed parts to its `coordinates`.
fn remove_again<'a>(
    there: impl Iterator<Item = &'a [f64]>,
    vector: &mut [f64],
    before: f64,
    coordinates: &mut [f64],
) -> f64 {
    let left = dot(vector, vector);
    if left <= SOUND * before {
        let mut coordinates = coordinates.iter_mut();
        for unit in there {
            let mut along = [0.0];
            remove_from_each(unit, vector, &mut along);
            if let Some(sum) = coordinates.next() {
                *sum += along[0];
            }
        }
        return dot(vector, vector);
    }
    left
}

/// The same, and normalises it; `None` when it depends on the others, or is not finite. Returns its length before that.
fn make_unit<'a>(
    there: impl Iterator<Item = &'a [f64]>,
    vector: &mut [f64],
    before: f64,
    coordinates: &mut [f64],
) -> Option<f64> {
    let left = remove_again(there, vector, before, coordinates).sqrt();
    if !(left.is_finite() && left > DEPENDENT * before.sqrt()) {
        return None;
    }
    for x in vector {
        *x /= left;
    }
    Some(left)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn columns(columns: &[[f64; 3]]) -> Columns {
        let mut all = Columns::new(3, columns.len());
        for column in columns {
            all.push(column.iter().copied());
        }
        all
    }

    /// The line through three points, from the normal equations by hand: y = 5/6 + x/2 for (0,1) (1,1) (2,2).
    #[test]
    fn fits_a_line() {
        let solution = Solution::of(&columns(&[[1.0, 1.0, 1.0], [0.0, 1.0, 2.0]]), &[1.0, 1.0, 2.0]).unwrap();
        let (x, left) = (&solution.coefficients, &solution.residual);
        assert!((x[0] - 5.0 / 6.0).abs() < 1e-15 && (x[1] - 0.5).abs() < 1e-15, "{x:?}");
        assert!((dot(left, left) - 1.0 / 6.0).abs() < 1e-15, "{left:?}");
    }

    /// About their mean 4/3 the values (1, 1, 2) have 2/3; of that the line of the test above takes 1/2.
    #[test]
    fn the_gain_of_a_column_is_what_a_fit_with_it_takes() {
        let Solution { basis, residual, .. } = Solution::of(&columns(&[[1.0; 3]]), &[1.0, 1.0, 2.0]).unwrap();
        let gains = basis.gains(columns(&[[0.0, 1.0, 2.0], [3.0, 3.0, 3.0], [0.0, 1.0, 2.0]]), 1, &residual);
        assert!(gains[0].is_some_and(|gain| (gain - 0.5).abs() < 1e-15), "{gains:?}");
        assert_eq!((gains[1], gains[2]), (None, gains[0]));
        // Three columns span all that three values can be.
        let gains = basis.gains(columns(&[[0.0, 1.0, 2.0], [0.0, 1.0, 4.0]]), 2, &residual);
        assert!((gains[0].unwrap() - 2.0 / 3.0).abs() < 1e-15, "{gains:?}");
        assert_eq!(basis.gains(columns(&[[0.0, 1.0, 2.0], [1.0, 3.0, 5.0]]), 2, &residual), [None]);
    }

    /// Columns that are nearly parallel: removed twice, they are orthogonal to the last digit, and fit.
    #[test]
    fn what_cancels_is_taken_out_twice() {
        let nearly = columns(&[[1.0, 1.0, 1.0], [1.0, 1.0 + 1e-8, 1.0]]);
        let Solution { basis, coefficients, residual } = Solution::of(&nearly, &[1.0, 2.0, 1.0]).unwrap();
        assert!(dot(basis.columns.column(0), basis.columns.column(1)).abs() < 1e-15);
        assert!(
            (coefficients[1] / 1e8 - 1.0).abs() < 1e-7 && residual.iter().all(|r| r.abs() < 1e-7),
            "{coefficients:?}"
        );
    }

    #[test]
    fn dependent_columns_are_refused() {
        assert!(Solution::of(&columns(&[[1.0, 2.0, 3.0], [0.1, 0.2, 0.3]]), &[1.0; 3]).is_none());
        assert!(Solution::of(&columns(&[[1.0, f64::NAN, 3.0]]), &[1.0; 3]).is_none());
    }

    #[test]
    fn cholesky_solves_and_refuses() {
        let x = solve_definite(vec![vec![4.0], vec![2.0, 3.0]], vec![2.0, 5.0]).unwrap();
        assert!((x[0] + 0.5).abs() < 1e-15 && (x[1] - 2.0).abs() < 1e-15, "{x:?}");
        assert!(solve_definite(vec![vec![1.0], vec![2.0, 1.0]], vec![1.0, 1.0]).is_none());
    }
}
