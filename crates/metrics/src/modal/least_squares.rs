//! Linear least squares by orthonormal columns.
#![expect(clippy::inline_always, reason = "what is inlined is compiled for the registers of its caller")]

use servobench_base::wide_registers;

/// Below this share of its own length, what is left of a column after projection is rounding.
const DEPENDENT: f64 = 1e-11;
/// A projection that leaves more than this share of a vector (squared) has not cancelled.
const SOUND: f64 = 0.1;

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
        columns.iter().try_for_each(|column| basis.push(column.clone()))?;
        Some(basis)
    }

    /// Adds a column; `None` when it depends on those that are there, or is not finite.
    fn push(&mut self, column: Vec<f64>) -> Option<()> {
        let (column, above) = beside(self.columns.iter(), column)?;
        self.columns.push(column);
        self.triangle.push(above);
        Some(())
    }

    /// How much of the sum of squares of `residual`, orthogonal to what is there, further `columns` would take; `None` when they depend on
    /// what is there, or on each other.
    pub(crate) fn gain(&self, columns: Vec<Vec<f64>>, residual: &[f64]) -> Option<f64> {
        let mut further: Vec<Vec<f64>> = Vec::with_capacity(columns.len());
        for column in columns {
            let (column, _) = beside(self.columns.iter().chain(&further), column)?;
            further.push(column);
        }
        Some(further.iter().map(|q| dot(q, residual)).map(|along| along * along).sum())
    }

    /// Subtracts from `vector` its projection on the columns and returns the projection's coordinates.
    pub(crate) fn remove_from(&self, vector: &mut [f64]) -> Vec<f64> {
        remove(self.columns.iter(), vector)
    }

    /// [`remove_from`](Self::remove_from) in one pass: not orthogonal to the last digit where it cancels.
    pub(crate) fn remove_once(&self, vector: &mut [f64]) -> Vec<f64> {
        remove_once(self.columns.iter(), vector)
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

/// Solves the symmetric positive definite `a·x = b` by Cholesky, of `a` the lower triangle; `None` when it is not
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

/// `column` as a unit vector orthogonal to the `columns`, and its own column of R; `None` when it depends on them, or is not finite.
fn beside<'a>(
    columns: impl Iterator<Item = &'a Vec<f64>> + Clone,
    mut column: Vec<f64>,
) -> Option<(Vec<f64>, Vec<f64>)> {
    let length = norm(&column);
    let mut above = remove(columns, &mut column);
    let left = norm(&column);
    if !(left.is_finite() && left > DEPENDENT * length) {
        return None;
    }
    for x in &mut column {
        *x /= left;
    }
    above.push(left);
    Some((column, above))
}

/// Subtracts from `vector` its projection on the `columns` and returns the projection's coordinates. Modified Gram–Schmidt; where it
/// cancels, a second time, which is enough (Giraud, Langou, Rozložník, 2005).
fn remove<'a>(columns: impl Iterator<Item = &'a Vec<f64>> + Clone, vector: &mut [f64]) -> Vec<f64> {
    let before = dot(vector, vector);
    let mut coordinates = remove_once(columns.clone(), vector);
    if dot(vector, vector) <= SOUND * before {
        let more = remove_once(columns, vector);
        coordinates.iter_mut().zip(more).for_each(|(sum, more)| *sum += more);
    }
    coordinates
}

fn remove_once<'a>(columns: impl Iterator<Item = &'a Vec<f64>>, vector: &mut [f64]) -> Vec<f64> {
    columns.map(|column| remove_along(column, vector)).collect()
}

/// Subtracts from `vector` its projection on the unit vector `column` and returns how long that is.
fn remove_along(column: &[f64], vector: &mut [f64]) -> f64 {
    wide_registers!(remove_along_in_any(column, vector), remove_along_in_wide_registers, column, vector)
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn remove_along_in_wide_registers(column: &[f64], vector: &mut [f64]) -> f64 {
    remove_along_in_any(column, vector)
}

#[inline(always)]
fn remove_along_in_any(column: &[f64], vector: &mut [f64]) -> f64 {
    let along = dot_in_any(column, vector);
    vector.iter_mut().zip(column).for_each(|(x, q)| *x -= along * q);
    along
}

/// Sum of products, always in the same order: eight interleaved sums, so that a processor can work on them side by side.
pub(crate) fn dot(one: &[f64], two: &[f64]) -> f64 {
    wide_registers!(dot_in_any(one, two), dot_in_wide_registers, one, two)
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn dot_in_wide_registers(one: &[f64], two: &[f64]) -> f64 {
    dot_in_any(one, two)
}

#[inline(always)]
fn dot_in_any(one: &[f64], two: &[f64]) -> f64 {
    let ((ones, one_rest), (twos, two_rest)) = (one.as_chunks::<8>(), two.as_chunks::<8>());
    let mut sums = [0.0; 8];
    for (a, b) in ones.iter().zip(twos) {
        for (sum, (a, b)) in sums.iter_mut().zip(a.iter().zip(b)) {
            *sum += a * b;
        }
    }
    let rest: f64 = one_rest.iter().zip(two_rest).map(|(a, b)| a * b).sum();
    sums.iter().sum::<f64>() + rest
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

    /// About their mean 4/3 the values (1, 1, 2) have 2/3; of that the line of the test above takes 1/2.
    #[test]
    fn the_gain_of_a_column_is_what_a_fit_with_it_takes() {
        let basis = Orthonormal::of(&[vec![1.0, 1.0, 1.0]]).unwrap();
        let mut y = vec![1.0, 1.0, 2.0];
        basis.remove_from(&mut y);
        for _ in 0..2 {
            let gain = basis.gain(vec![vec![0.0, 1.0, 2.0]], &y).unwrap();
            assert!((gain - 0.5).abs() < 1e-15, "{gain}");
            assert_eq!(basis.gain(vec![vec![3.0, 3.0, 3.0]], &y), None);
        }
    }

    #[test]
    fn dependent_columns_are_refused() {
        assert!(Orthonormal::of(&[vec![1.0, 2.0, 3.0], vec![0.1, 0.2, 0.3]]).is_none());
        assert!(Orthonormal::of(&[vec![1.0, f64::NAN, 3.0]]).is_none());
    }

    #[test]
    fn cholesky_solves_and_refuses() {
        let x = solve_definite(vec![vec![4.0], vec![2.0, 3.0]], vec![2.0, 5.0]).unwrap();
        assert!((x[0] + 0.5).abs() < 1e-15 && (x[1] - 2.0).abs() < 1e-15, "{x:?}");
        assert!(solve_definite(vec![vec![1.0], vec![2.0, 1.0]], vec![1.0, 1.0]).is_none());
    }

    /// What a processor with wide registers gives and what any other gives are the same bits.
    #[test]
    fn both_kinds_of_processors_give_the_same_bits() {
        let mut random = servobench_testkit::Random::seeded(19);
        for length in (0..70).chain([1000, 1001, 1007]) {
            let column: Vec<f64> = (0..length).map(|_| random.signed()).collect();
            let vector: Vec<f64> = (0..length).map(|_| 1e3 * random.signed()).collect();
            assert_eq!(dot(&column, &vector).to_bits(), dot_in_any(&column, &vector).to_bits(), "{length}");
            let (mut here, mut in_any) = (vector.clone(), vector);
            let along = [remove_along(&column, &mut here), remove_along_in_any(&column, &mut in_any)];
            assert_eq!((along[0].to_bits(), here), (along[1].to_bits(), in_any), "{length}");
        }
    }

    /// Whole numbers, so that the sum is exact: 0·1 + 1·2 + … + 20·21 = 20·21·22/3.
    #[test]
    fn a_sum_of_products_leaves_nothing_out() {
        let one: Vec<f64> = (0..21).map(f64::from).collect();
        let two: Vec<f64> = (1..22).map(f64::from).collect();
        assert!((dot(&one, &two) - 3080.0).abs() < 1e-12);
    }
}
