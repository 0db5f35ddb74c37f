//! Eigenvalues of a matrix without its eigenvectors, by the QR algorithm with double shifts.
//!
//! The matrix is reduced to Hessenberg form by elimination with pivots; Francis steps then let its subdiagonal decay, and where one of its
//! entries vanishes, one or two eigenvalues split off. Vectors, which cost more than half of the time, are only computed for refinement.
//! If both shifts are real, the one nearer to the corner is used twice: with two different ones the Jordan chains of delays at 0 do not
//! split off.
//! Sources: Wilkinson & Reinsch, *Handbook for Automatic Computation* II, 1971, contributions II/13 (elmhes) and II/14 (hqr); shifts as in
//! LAPACK 3.12, dlahqr.
use nalgebra::{Complex, DMatrix};

/// A row of the matrix.
type Row = Vec<f64>;

/// Number of iterations after which an exceptional shift, which is not an estimate of an eigenvalue, breaks a cycle.
const EXCEPTIONAL: u32 = 10;
/// Iterations allowed for each eigenvalue. Delays make long Jordan chains at 0, which took up to 70.
pub(crate) const ITERATIONS: u32 = 300;

/// The eigenvalues of `matrix`, which should be balanced; `None` if one does not converge within [`ITERATIONS`].
pub(crate) fn eigenvalues(matrix: &DMatrix<f64>) -> Option<Vec<Complex<f64>>> {
    let mut rows: Vec<Row> = matrix.row_iter().map(|row| row.iter().copied().collect()).collect();
    let a = rows.as_mut_slice();
    reduce(a);
    let mut found = Vec::with_capacity(a.len());
    let scale: f64 = a.iter().flatten().map(|entry| entry.abs()).fold(0.0, f64::max);
    let (mut size, mut iterations) = (a.len(), 0);
    while let Some(last) = size.checked_sub(1) {
        let from = split(a, last, scale);
        let corner = a[last][last];
        if from == last {
            found.push(Complex::new(corner, 0.0));
            (size, iterations) = (last, 0);
        } else if from + 1 == last {
            found.extend(pair([a[last - 1][last - 1], corner], a[last][last - 1] * a[last - 1][last]));
            (size, iterations) = (last - 1, 0);
        } else {
            if iterations == ITERATIONS {
                return None;
            }
            let shift = shift(a, from, last, iterations);
            iterations += 1;
            sweep(a, from, last, shift);
        }
    }
    Some(found)
}

/// Shifts of a step on the rows `from` to `last`: x, y and w, so that they are the roots of (x − s)·(y − s) = w.
fn shift(a: &[Row], from: usize, last: usize, iterations: u32) -> [f64; 3] {
    let exceptional = |at: usize, off: f64| {
        let diagonal = a[at][at] + 0.75 * off;
        [diagonal, diagonal, -0.4375 * off * off]
    };
    if iterations > 0 && iterations.is_multiple_of(2 * EXCEPTIONAL) {
        return exceptional(last, a[last][last - 1].abs() + a[last - 1][last - 2].abs());
    }
    if iterations % (2 * EXCEPTIONAL) == EXCEPTIONAL {
        return exceptional(from, a[from + 1][from].abs() + a[from + 2][from + 1].abs());
    }
    let (corner, before, product) = (a[last][last], a[last - 1][last - 1], a[last][last - 1] * a[last - 1][last]);
    let [one, other] = pair([before, corner], product);
    if one.im != 0.0 {
        return [corner, before, product];
    }
    let nearer = if (one.re - corner).abs() < (other.re - corner).abs() { one.re } else { other.re };
    [nearer, nearer, 0.0]
}

/// Hessenberg form.
fn reduce(a: &mut [Row]) {
    let n = a.len();
    for column in 1..n.saturating_sub(1) {
        let largest = |one: &usize, other: &usize| a[*one][column - 1].abs().total_cmp(&a[*other][column - 1].abs());
        let Some(pivot) = (column..n).max_by(largest) else { continue };
        let value = a[pivot][column - 1];
        if value == 0.0 {
            continue;
        }
        if pivot != column {
            a.swap(pivot, column);
            for row in &mut *a {
                row.swap(pivot, column);
            }
        }
        for row in column + 1..n {
            let factor = a[row][column - 1] / value;
            if factor == 0.0 {
                continue;
            }
            let (above, below) = a.split_at_mut(row);
            let (of_pivot, this) = (&above[column], &mut below[0]);
            this[column - 1] = 0.0;
            for (entry, pivot) in this[column..].iter_mut().zip(&of_pivot[column..]) {
                *entry -= factor * pivot;
            }
            for of in &mut *a {
                of[column] += factor * of[row];
            }
        }
    }
}

/// Start of the block that ends with `last`: the subdiagonal entry before it is negligible, and is taken to be 0.
fn split(a: &[Row], last: usize, scale: f64) -> usize {
    let has_faded = |i: &usize| {
        let beside = a[i - 1][i - 1].abs() + a[*i][*i].abs();
        a[*i][i - 1].abs() <= f64::EPSILON / 2.0 * if beside == 0.0 { scale } else { beside }
    };
    (1..=last).rev().find(has_faded).unwrap_or(0)
}

/// Both eigenvalues of a block with this diagonal and this product of the other two entries.
fn pair([a, d]: [f64; 2], product: f64) -> [Complex<f64>; 2] {
    let half = (a - d) / 2.0;
    let square = half * half + product;
    let root = square.abs().sqrt();
    if square < 0.0 {
        return [1.0, -1.0].map(|sign| Complex::new(d + half, sign * root));
    }
    // Avoids the difference of two nearly equal numbers.
    let larger = half + root.copysign(half);
    let smaller = if larger == 0.0 { 0.0 } else { -product / larger };
    [larger, smaller].map(|part| Complex::new(d + part, 0.0))
}

/// A Francis step on the rows `from` to `last`, with the sum and product of two shifts.
fn sweep(a: &mut [Row], from: usize, last: usize, [x, y, w]: [f64; 3]) {
    // The step can begin where two small subdiagonal entries follow each other.
    let first_column = |a: &[Row], m: usize| {
        let z = a[m][m];
        let (r, s) = (x - z, y - z);
        let v = [(r * s - w) / a[m + 1][m] + a[m][m + 1], a[m + 1][m + 1] - z - r - s, a[m + 2][m + 1]];
        let size = v.iter().map(|entry| entry.abs()).sum::<f64>();
        v.map(|entry| entry / size)
    };
    let mut begin = last - 2;
    let mut v = first_column(a, begin);
    while begin > from {
        let left = a[begin][begin - 1].abs() * (v[1].abs() + v[2].abs());
        let around = a[begin - 1][begin - 1].abs() + a[begin][begin].abs() + a[begin + 1][begin + 1].abs();
        if left <= f64::EPSILON / 2.0 * v[0].abs() * around {
            break;
        }
        begin -= 1;
        v = first_column(a, begin);
    }
    for i in begin + 2..=last {
        a[i][i - 2] = 0.0;
        if i > begin + 2 {
            a[i][i - 3] = 0.0;
        }
    }
    for k in begin..last {
        let is_three = k + 1 < last;
        let mut size = 1.0;
        if k > begin {
            v = [a[k][k - 1], a[k + 1][k - 1], if is_three { a[k + 2][k - 1] } else { 0.0 }];
            size = v.iter().map(|entry| entry.abs()).sum();
            if size == 0.0 {
                continue;
            }
            v = v.map(|entry| entry / size);
        }
        let [p, q, r] = v;
        let s = (p * p + q * q + r * r).sqrt().copysign(p);
        if s == 0.0 {
            continue;
        }
        if k > begin {
            a[k][k - 1] = -s * size;
        } else if from < begin {
            a[k][k - 1] = -a[k][k - 1];
        }
        let (p, of_row) = (p + s, [q / (p + s), r / (p + s)]);
        let of_column = [p / s, q / s, r / s];
        let (upper, lower) = a.split_at_mut(k + 1);
        let (middle, lower) = lower.split_at_mut(1);
        let two = upper[k][k..=last].iter_mut().zip(&mut middle[0][k..=last]);
        match lower.first_mut().filter(|_| is_three) {
            None => two.for_each(|(x, y)| {
                let sum = *x + of_row[0] * *y;
                *y -= sum * of_column[1];
                *x -= sum * of_column[0];
            }),
            Some(third) => two.zip(&mut third[k..=last]).for_each(|((x, y), z)| {
                let sum = *x + of_row[0] * *y + of_row[1] * *z;
                *z -= sum * of_column[2];
                *y -= sum * of_column[1];
                *x -= sum * of_column[0];
            }),
        }
        for row in &mut a[from..=last.min(k + 3)] {
            let mut sum = of_column[0] * row[k] + of_column[1] * row[k + 1];
            if is_three {
                sum += of_column[2] * row[k + 2];
                row[k + 2] -= sum * of_row[1];
            }
            row[k + 1] -= sum * of_row[0];
            row[k] -= sum;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The eigenvalues `all`, the largest first.
    fn sorted(mut all: Vec<Complex<f64>>) -> Vec<Complex<f64>> {
        all.sort_by(|a, b| b.re.total_cmp(&a.re).then(b.im.total_cmp(&a.im)));
        all
    }

    /// Oracle: the roots from which the companion matrix was made, as a product of their linear factors.
    #[test]
    fn roots_of_a_polynomial_are_found() {
        let roots = [
            Complex::new(0.93, 0.31),
            Complex::new(0.93, -0.31),
            Complex::new(0.71, 0.0),
            Complex::new(0.2, 0.6),
            Complex::new(0.2, -0.6),
            Complex::new(-0.4, 0.0),
            Complex::new(-1.3, 0.0),
        ];
        let mut polynomial = vec![Complex::new(1.0, 0.0)];
        for root in roots {
            let mut next = polynomial.clone();
            next.push(Complex::default());
            for (i, coefficient) in polynomial.iter().enumerate() {
                next[i + 1] -= root * coefficient;
            }
            polynomial = next;
        }
        let n = roots.len();
        let companion = DMatrix::from_fn(n, n, |i, j| match i {
            0 => -polynomial[j + 1].re,
            _ => f64::from(u8::from(i == j + 1)),
        });
        for (found, root) in sorted(eigenvalues(&companion).unwrap()).iter().zip(sorted(roots.to_vec())) {
            assert!((found - root).norm() < 1e-13, "{found} {root}");
        }
    }

    fn random() -> impl FnMut() -> f64 {
        let mut seed = 7_u64;
        move || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (seed >> 33) as f64 / f64::from(1_u32 << 31) - 0.5
        }
    }

    /// Oracle: the Schur form of nalgebra, of full matrices.
    #[test]
    fn it_agrees_with_the_schur_form() {
        let mut random = random();
        for n in 1..24 {
            let matrix = DMatrix::from_fn(n, n, |_, _| random());
            let found = sorted(eigenvalues(&matrix).unwrap());
            let schur = nalgebra::linalg::Schur::try_new(matrix, f64::EPSILON, 10_000).unwrap();
            let mut left = schur.complex_eigenvalues().iter().copied().collect::<Vec<_>>();
            for value in found {
                let (index, nearest) = left
                    .iter()
                    .map(|other| (other - value).norm())
                    .enumerate()
                    .min_by(|a, b| a.1.total_cmp(&b.1))
                    .unwrap();
                assert!(nearest < 1e-11, "{n}: {value} {nearest:e}");
                left.swap_remove(index);
            }
        }
    }

    /// Delays: Jordan chains of four and six at 0 beside four eigenvalues of a loop. With two different real shifts 4 of 300
    /// did not converge.
    #[test]
    fn chains_of_delays_split_off() {
        let mut random = random();
        let size = 14;
        let jordan = DMatrix::from_fn(size, size, |i, j| match i {
            0..4 if i == j => 0.97 - 0.01 * i as f64,
            4.. if i + 1 == j && i != 8 => 0.5,
            _ => 0.0,
        });
        for _ in 0..300 {
            let basis = DMatrix::from_fn(size, size, |i, j| random() + f64::from(u8::from(i == j)));
            let inverse = basis.clone().try_inverse().unwrap();
            let found = sorted(eigenvalues(&(&basis * &jordan * inverse)).unwrap());
            for (i, value) in found[..4].iter().enumerate() {
                assert!((value - (0.97 - 0.01 * i as f64)).norm() < 1e-6, "{found:?}");
            }
        }
    }

    /// A matrix that permutes in a cycle needs a shift that is not an estimate.
    #[test]
    fn a_permutation_ends() {
        let n = 8;
        let matrix = DMatrix::from_fn(n, n, |i, j| f64::from(u8::from((j + 1) % n == i)));
        let found = eigenvalues(&matrix).unwrap();
        assert!(found.iter().all(|value| (value.norm() - 1.0).abs() < 1e-13), "{found:?}");
    }
}
