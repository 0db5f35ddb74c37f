//! Distortion of a mode by a method of integration: a shifted frequency, and added damping.
//!
//! ```text
//! half kick – drift – half kick    ω'·h = 2·asin(ω·h/2)           shift (ω·h)²/24, no damping, up to ω·h = 2
//! RK4                              μ·h = ln R(i·ω·h)              damping (ω·h)⁵/144, shift −(ω·h)⁴/120, up to ω·h = 2·√2
//! R(z) = 1 + z + z²/2 + z³/6 + z⁴/24
//! ```
//! Source: Hairer, Lubich & Wanner, *Geometric Numerical Integration*, 2nd ed., §I.1; Hairer & Wanner, *Solving Ordinary
//! Differential Equations II*, §IV.2.
use nalgebra::Complex;

/// Method of integration of mechanics from tick to tick.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Integrator {
    /// By the matrix exponential: no error.
    Exact,
    /// Half kick – drift – half kick, also known as Störmer–Verlet or leapfrog.
    Leapfrog,
    /// The classic Runge–Kutta method of fourth order.
    Rk4,
}

/// Distortion of an undamped mode.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Distortion {
    /// Damping ratio that the method adds.
    pub damping: f64,
    /// Relative increase of the frequency; negative for a decrease.
    pub shift: f64,
}

impl Integrator {
    /// Largest ω·h of an undamped mode; infinite without a bound.
    #[must_use]
    pub const fn stable_below(self) -> f64 {
        match self {
            Self::Exact => f64::INFINITY,
            Self::Leapfrog => 2.0,
            Self::Rk4 => 2.0 * std::f64::consts::SQRT_2,
        }
    }

    /// Distortion of an undamped mode of `omega` (rad/s) in ticks of `h` (s); `None` when it grows without bound.
    #[must_use]
    pub fn distortion(self, omega: f64, h: f64) -> Option<Distortion> {
        let angle = omega * h;
        if angle >= self.stable_below() {
            return None;
        }
        match self {
            _ if angle <= 0.0 => Some(Distortion { damping: 0.0, shift: 0.0 }),
            Self::Exact => Some(Distortion { damping: 0.0, shift: 0.0 }),
            Self::Leapfrog => Some(Distortion { damping: 0.0, shift: (angle / 2.0).asin() / (angle / 2.0) - 1.0 }),
            Self::Rk4 => Some(rk4(angle)),
        }
    }

    /// Factor |R(λ·h)| by which a step `h` (s) of RK4 multiplies a motion e^(λt): above one it grows.
    #[must_use]
    pub fn rk4_gain(eigenvalue: Complex<f64>, h: f64) -> f64 {
        rk4_factor(eigenvalue * h).norm()
    }
}

/// R(z), by Horner's rule.
fn rk4_factor(z: Complex<f64>) -> Complex<f64> {
    let one = Complex::new(1.0, 0.0);
    one + z * (one + z / 2.0 * (one + z / 3.0 * (one + z / 4.0)))
}

/// Distortion of a mode of ω·h = `angle`. |R|² = 1 − (ω·h)⁶/72 + (ω·h)⁸/576 without the cancellation of its definition.
fn rk4(angle: f64) -> Distortion {
    let squared = angle * angle;
    let growth = 0.5 * (squared.powi(3) * (squared / 576.0 - 1.0 / 72.0)).ln_1p();
    let turned = rk4_factor(Complex::new(0.0, angle)).arg().rem_euclid(std::f64::consts::TAU);
    Distortion { damping: -growth / turned.hypot(growth), shift: turned / angle - 1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: the leading terms; the next ones are smaller by (ω·h)².
    #[test]
    fn slow_modes_are_distorted_by_the_leading_terms() {
        for angle in [0.03_f64, 0.11, 0.23] {
            let (h, next) = (1.0 / 12e3, angle * angle);
            let leapfrog = Integrator::Leapfrog.distortion(angle / h, h).unwrap();
            assert!((leapfrog.shift / (angle.powi(2) / 24.0) - 1.0).abs() < next, "{leapfrog:?}");
            let rk4 = Integrator::Rk4.distortion(angle / h, h).unwrap();
            assert!((rk4.damping / (angle.powi(5) / 144.0) - 1.0).abs() < next, "{rk4:?}");
            // The shift of 0.03 is 7e-9, of which rounding leaves seven digits.
            assert!((rk4.shift / (-angle.powi(4) / 120.0) - 1.0).abs() < next + 1e-6, "{rk4:?}");
            assert_eq!(Integrator::Exact.distortion(angle / h, h), Some(Distortion { damping: 0.0, shift: 0.0 }));
        }
    }

    /// Oracle: R of the test equation, stepped 50 times.
    #[test]
    fn a_fast_mode_is_damped_as_the_steps_damp_it() {
        let (omega, h) = (2.0 * 500.0, 1.1e-3);
        let mut y = Complex::new(1.0, 0.0);
        for _ in 0..50 {
            let slope = |y: Complex<f64>| y * Complex::new(0.0, omega);
            let k1 = slope(y);
            let k2 = slope(y + k1 * (h / 2.0));
            let k3 = slope(y + k2 * (h / 2.0));
            let k4 = slope(y + k3 * h);
            y += (k1 + k2 * 2.0 + k3 * 2.0 + k4) * (h / 6.0);
        }
        let Distortion { damping, shift } = Integrator::Rk4.distortion(omega, h).unwrap();
        let turned = omega * (1.0 + shift) * 50.0 * h;
        let lost = turned * damping / (1.0 - damping * damping).sqrt();
        assert!((y.norm().ln() / -lost - 1.0).abs() < 1e-10, "{} {lost}", y.norm().ln());
        let wrong = (y / y.norm() - Complex::new(turned.cos(), turned.sin())).norm();
        assert!(wrong < 1e-11, "{wrong:e}");
    }

    #[test]
    fn beyond_its_bound_a_mode_grows() {
        for (integrator, bound) in [(Integrator::Leapfrog, 2.0), (Integrator::Rk4, 8.0_f64.sqrt())] {
            assert!(integrator.distortion(0.999 * bound / 1e-3, 1e-3).is_some());
            assert!(integrator.distortion(1.001 * bound / 1e-3, 1e-3).is_none());
        }
        let at = |angle: f64| Integrator::rk4_gain(Complex::new(0.0, angle), 1.0);
        assert!(at(2.82) < 1.0 && at(2.84) > 1.0, "{} {}", at(2.82), at(2.84));
        assert!(Integrator::Exact.distortion(1e9, 1.0).is_some());
    }
}
