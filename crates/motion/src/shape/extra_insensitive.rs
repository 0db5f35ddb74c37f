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
use super::newton::damped;
use core::f64::consts::PI;

/// `A_2, A_3, t_2, w_1, w_2`.
type Unknowns = [f64; 5];

/// The three impulses in the time unit 1/ω; `None` if no solution with positive amplitudes is found.
pub(super) fn solve(zeta: f64, tolerable: f64) -> Option<[Impulse; 3]> {
    let low = libm::acos(-(1.0 - tolerable) / (1.0 + tolerable)) / PI;
    let undamped = [(1.0 - tolerable) / 2.0, (1.0 + tolerable) / 4.0, PI, low, 2.0 - low];
    let [a2, a3, t2, ..] = damped(zeta, undamped, |y, zeta| equations(y, zeta, tolerable), is_shaper)?;
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
