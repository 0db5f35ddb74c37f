//! Linear least squares by orthonormal columns.

/// Below this share of its own length, what is left of a column after projection is rounding.
const DEPENDENT: f64 = 1e-11;

/// Orthonormal columns Q and the triangle R of `A = Q·R`.
#[derive(Debug, Clone, Default)]
pub(crate) struct Orthonormal {
    columns: Vec<Vec<f64>>,
    /// Column k of R: its first k entries and its diagonal.
    triangle: Vec<Vec<f64>>,
}

impl Orthonormal {
    /// Q and R of `columns`; `None` when they are linearly dependent or not finite.
    pub(crate) fn of(columns: &[Vec<f64>]) -> Option<Self> {
        let mut basis = Self::default();
        for column in columns {
            let length = norm(column);
            let mut rest = column.clone();
            let mut above = basis.remove_from(&mut rest);
            let left = norm(&rest);
            if !(left.is_finite() && left > DEPENDENT * length) {
                return None;
            }
            for x in &mut rest {
                *x /= left;
            }
            above.push(left);
            basis.columns.push(rest);
            basis.triangle.push(above);
        }
        Some(basis)
    }

    /// Subtracts from `vector` its projection on the columns and returns the projection's coordinates. Modified
    /// Gram–Schmidt, twice, which is enough (Giraud, Langou, Rozložník, 2005).
    pub(crate) fn remove_from(&self, vector: &mut [f64]) -> Vec<f64> {
        let mut coordinates = vec![0.0; self.columns.len()];
        for _ in 0..2 {
            for (column, coordinate) in self.columns.iter().zip(&mut coordinates) {
                let along = dot(column, vector);
                *coordinate += along;
                vector.iter_mut().zip(column).for_each(|(x, q)| *x -= along * q);
            }
        }
        coordinates
    }

    /// The x of `R·x = coordinates`.
    pub(crate) fn back_substitute(&self, mut coordinates: Vec<f64>) -> Vec<f64> {
        for k in (0..coordinates.len()).rev() {
            coordinates[k] /= self.triangle[k][k];
            let known = coordinates[k];
            for (i, x) in coordinates.iter_mut().enumerate().take(k) {
                *x -= self.triangle[k][i] * known;
            }
        }
        coordinates
    }
}

/// Solves the symmetric positive definite `a·x = b` by Cholesky; `None` when it is not definite.
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

/// Sum of products, in order.
pub(crate) fn dot(one: &[f64], two: &[f64]) -> f64 {
    one.iter().zip(two).map(|(a, b)| a * b).sum()
}

fn norm(vector: &[f64]) -> f64 {
    dot(vector, vector).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The line through three points, from the normal equations by hand: y = 5/6 + x/2 for (0,1) (1,1) (2,2).
    #[test]
    fn fits_a_line() {
        let columns = [vec![1.0, 1.0, 1.0], vec![0.0, 1.0, 2.0]];
        let basis = Orthonormal::of(&columns).unwrap();
        let mut y = vec![1.0, 1.0, 2.0];
        let along = basis.remove_from(&mut y);
        let x = basis.back_substitute(along);
        assert!((x[0] - 5.0 / 6.0).abs() < 1e-15 && (x[1] - 0.5).abs() < 1e-15, "{x:?}");
        assert!((dot(&y, &y) - 1.0 / 6.0).abs() < 1e-15, "residual {y:?}");
    }

    #[test]
    fn dependent_columns_are_refused() {
        assert!(Orthonormal::of(&[vec![1.0, 2.0, 3.0], vec![0.1, 0.2, 0.3]]).is_none());
        assert!(Orthonormal::of(&[vec![1.0, f64::NAN, 3.0]]).is_none());
    }

    #[test]
    fn cholesky_solves_and_refuses() {
        let x = solve_definite(vec![vec![4.0, 2.0], vec![2.0, 3.0]], vec![2.0, 5.0]).unwrap();
        assert!((x[0] + 0.5).abs() < 1e-15 && (x[1] - 2.0).abs() < 1e-15, "{x:?}");
        assert!(solve_definite(vec![vec![1.0, 2.0], vec![2.0, 1.0]], vec![1.0, 1.0]).is_none());
    }
}
