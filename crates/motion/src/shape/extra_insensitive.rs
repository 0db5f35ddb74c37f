//! The extra-insensitive shaper of a damped mode.
//!
//! With ω = 1, t_3 = 2π/√(1−ζ²), a whole damped period, and P(w) = Σ A_i·e^(w(ζ + j√(1−ζ²))·t_i), five equations
//!
//! ```text
//! P(w_1) = 0,   P(w_2) = 0 (both complex),   e^(−ζ·t_3)·|P(1)| = v        for A_2, A_3 (A_1 the rest of one), t_2, w_1, w_2
//! ```
//!
//! Undamped they have the closed form A = (1 + v, 2 − 2v, 1 + v)/4 at 0, π, 2π, and cos(π·w) = −(1 − v)/(1 + v) at w_1
//! and w_2 = 2 − w_1. From there the damping ratio is raised in steps, each solved by Newton's method.
use super::Impulse;
use core::f64::consts::PI;

/// `A_2, A_3, t_2, w_1, w_2`.
type Unknowns = [f64; 5];

/// First step of the damping ratio, halved where Newton's method fails, and the smallest that is tried.
const STEP: (f64, f64) = (0.05, 1e-4);

/// The three impulses in the time unit 1/ω; `None` where no solution with positive amplitudes is found.
pub(super) fn solve(zeta: f64, tolerable: f64) -> Option<[Impulse; 3]> {
    let low = libm::acos(-(1.0 - tolerable) / (1.0 + tolerable)) / PI;
    let mut y = [(1.0 - tolerable) / 2.0, (1.0 + tolerable) / 4.0, PI, low, 2.0 - low];
    let (mut known, (mut step, smallest)) = (0.0, STEP);
    while known < zeta {
        let next = zeta.min(known + step);
        match newton(y, next, tolerable).filter(|y| is_shaper(y, next)) {
            Some(solved) => (y, known) = (solved, next),
            None if step > smallest => step *= 0.5,
            None => return None,
        }
    }
    let [a2, a3, t2, ..] = y;
    Some([(0.0, 1.0 - a2 - a3), (t2, a2), (period(zeta), a3)].map(|(time, amplitude)| Impulse { time, amplitude }))
}

/// The damped period 2π/√(1 − ζ²).
fn period(zeta: f64) -> f64 {
    2.0 * PI / libm::sqrt((1.0 - zeta) * (1.0 + zeta))
}

fn is_shaper(&[a2, a3, t2, w1, w2]: &Unknowns, zeta: f64) -> bool {
    let is_positive = a2 > 0.0 && a3 > 0.0 && a2 + a3 < 1.0;
    is_positive && 0.0 < t2 && t2 < period(zeta) && 0.0 < w1 && w1 < 1.0 && 1.0 < w2 && w2 < 2.0
}

/// Where the residuals vanish, from `y` on; `None` when they do not.
fn newton(mut y: Unknowns, zeta: f64, tolerable: f64) -> Option<Unknowns> {
    // Three to six steps are usual.
    for _ in 0..30 {
        let f = equations(&y, zeta, tolerable);
        let mut rows = [[0.0; 6]; 5];
        for column in 0..5 {
            // The error of a central difference, h², times that of the remaining step is what Newton leaves.
            let h = 1e-5;
            let [mut above, mut below] = [y, y];
            above[column] += h;
            below[column] -= h;
            let [above, below] = [equations(&above, zeta, tolerable), equations(&below, zeta, tolerable)];
            for (row, (above, below)) in rows.iter_mut().zip(above.into_iter().zip(below)) {
                row[column] = (above - below) / (2.0 * h);
            }
        }
        for (row, f) in rows.iter_mut().zip(f) {
            row[5] = -f;
        }
        let step = eliminate(rows)?;
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
    // Rounding may keep the last step above the bound: what counts is that the equations hold.
    equations(&y, zeta, tolerable).iter().all(|f| f.abs() < 1e-13).then_some(y)
}

fn equations(&[a2, a3, t2, w1, w2]: &Unknowns, zeta: f64, tolerable: f64) -> Unknowns {
    let ring = libm::sqrt((1.0 - zeta) * (1.0 + zeta));
    let last = period(zeta);
    // e^(−ζw·t_3)·P(w)
    let rest = |w: f64| {
        [(1.0 - a2 - a3, 0.0), (a2, t2), (a3, last)].into_iter().fold([0.0, 0.0], |[re, im], (amplitude, t)| {
            let magnitude = amplitude * libm::exp(zeta * w * (t - last));
            [re + magnitude * libm::cos(ring * w * t), im + magnitude * libm::sin(ring * w * t)]
        })
    };
    let [low, high, middle] = [w1, w2, 1.0].map(rest);
    [low[0], low[1], high[0], high[1], libm::hypot(middle[0], middle[1]) - tolerable]
}

/// Solves five linear equations, the right-hand side in the last column, by elimination with row pivoting.
fn eliminate(mut rows: [[f64; 6]; 5]) -> Option<Unknowns> {
    for i in 0..5 {
        let pivot = (i..5).max_by(|p, q| rows[*p][i].abs().total_cmp(&rows[*q][i].abs()))?;
        rows.swap(i, pivot);
        let row = rows[i];
        if row[i].abs() <= 1e-14 || row[i].is_nan() {
            return None;
        }
        for other in rows.iter_mut().skip(i + 1) {
            let factor = other[i] / row[i];
            for (value, pivot) in other.iter_mut().zip(row) {
                *value -= factor * pivot;
            }
        }
    }
    let mut y = [0.0; 5];
    for i in (0..5).rev() {
        let known: f64 = (i + 1..5).map(|k| rows[i][k] * y[k]).sum();
        y[i] = (rows[i][5] - known) / rows[i][i];
    }
    Some(y)
}
