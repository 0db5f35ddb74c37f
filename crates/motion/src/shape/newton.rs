//! Newton's method for the equations of a shaper, and continuation to a damped mode.

/// First step of the damping ratio, halved if Newton's method fails, and the smallest step.
const STEP: (f64, f64) = (0.05, 1e-4);

/// Continues the solution `y` of an undamped mode to that of the damping ratio `zeta`, which is raised in steps; each has to pass
/// `is_shaper`. `None` if one is not found.
pub(super) fn damped<const N: usize>(
    zeta: f64,
    mut y: [f64; N],
    equations: impl Fn(&[f64; N], f64) -> [f64; N],
    is_shaper: impl Fn(&[f64; N], f64) -> bool,
) -> Option<[f64; N]> {
    let (mut known, (mut step, smallest)) = (0.0, STEP);
    while known < zeta {
        let next = zeta.min(known + step);
        match newton(y, |y| equations(y, next)).filter(|y| is_shaper(y, next)) {
            Some(solved) => (y, known) = (solved, next),
            None if step > smallest => step *= 0.5,
            None => return None,
        }
    }
    Some(y)
}

/// Root of the `equations`, starting from `y`; `None` without convergence.
fn newton<const N: usize>(mut y: [f64; N], equations: impl Fn(&[f64; N]) -> [f64; N]) -> Option<[f64; N]> {
    // Three to six steps are usual.
    for _ in 0..30 {
        let f = equations(&y);
        let mut rows = [[0.0; N]; N];
        for column in 0..N {
            // Newton's method leaves the error of a central difference, h², times that of the remaining step.
            let h = 1e-5;
            let [mut above, mut below] = [y, y];
            above[column] += h;
            below[column] -= h;
            let [above, below] = [equations(&above), equations(&below)];
            for (row, (above, below)) in rows.iter_mut().zip(above.into_iter().zip(below)) {
                row[column] = (above - below) / (2.0 * h);
            }
        }
        let step = eliminate(rows, f.map(|f| -f))?;
        let mut largest = 0.0_f64;
        for (y, step) in y.iter_mut().zip(step) {
            *y += step;
            largest = largest.max(step.abs());
        }
        if largest >= 1.0 {
            return None;
        }
        if largest < 4e-15 {
            return Some(y);
        }
    }
    // Rounding may keep the last step above the bound: only the equations must hold.
    equations(&y).iter().all(|f| f.abs() < 1e-13).then_some(y)
}

/// Solves linear equations by elimination with row pivoting.
fn eliminate<const N: usize>(mut rows: [[f64; N]; N], mut right: [f64; N]) -> Option<[f64; N]> {
    for i in 0..N {
        let pivot = (i..N).max_by(|p, q| rows[*p][i].abs().total_cmp(&rows[*q][i].abs()))?;
        rows.swap(i, pivot);
        right.swap(i, pivot);
        let row = rows[i];
        if row[i].abs() <= 1e-14 || row[i].is_nan() {
            return None;
        }
        for other in i + 1..N {
            let factor = rows[other][i] / row[i];
            for (value, pivot) in rows[other].iter_mut().zip(row) {
                *value -= factor * pivot;
            }
            right[other] -= factor * right[i];
        }
    }
    let mut y = [0.0; N];
    for i in (0..N).rev() {
        let known: f64 = (i + 1..N).map(|k| rows[i][k] * y[k]).sum();
        y[i] = (right[i] - known) / rows[i][i];
    }
    Some(y)
}
