//! A base that moves as prescribed, over one tick.
//!
//! The base is the frame of reference. In it each body is subject to an inertial force and the viscous friction of the moving
//! ground, `f(t) = −(m·a(t) + b·v(t))/r`, where a and v are those of the base and r is the transmission. `MuJoCo` holds
//! forces over a tick, so f becomes its mean, which leaves the velocity at the end of the tick correct, and a shift
//! corrects the position:
//!
//! ```text
//! f̄ = 1/h·∫ f dt        δ = 1/m·(∫ (h − t)·f dt − f̄·h²/2)
//! q ← q + δ/2,  step with f̄,  q ← q + δ/2
//! ```
//! One half before and one half after the step: within it the path then differs from the true one by a term of mean
//! zero, which affects a spring on the body in the fourth order only. It affects dampers in the second order: δ over h is a
//! velocity.
use servobench_base::Setpoint;

/// The motion of the base over one tick, in the axis coordinate.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct BaseTick {
    /// State at the start of the tick.
    pub(crate) start: Setpoint,
    /// State at its end.
    pub(crate) end: Setpoint,
    /// Mean velocity (m/s or rad/s) and acceleration.
    mean_v: f64,
    mean_a: f64,
    /// Error of the means in the position at the end: `∫ (h − t)·y dt − ȳ·h²/2` for y = v and y = a.
    miss_v: f64,
    miss_a: f64,
}

impl BaseTick {
    /// The motion from one tick to the next, `h` seconds later.
    pub(crate) fn new(start: Setpoint, h: f64) -> Self {
        let Setpoint { v, a, j, s, .. } = start;
        let twelfth = h * h * h / 12.0;
        Self {
            start,
            end: start.after(h),
            mean_v: v + h / 2.0 * (a + h / 3.0 * (j + h / 4.0 * s)),
            mean_a: a + h / 2.0 * (j + h / 3.0 * s),
            miss_v: -twelfth * (a + h / 2.0 * (j + 0.3 * h * s)),
            miss_a: -twelfth * (j + h / 2.0 * s),
        }
    }

    /// Mean force on a body in its own coordinate (N or N·m).
    pub(crate) fn mean_force(&self, inertia: f64, viscous: f64, transmission: f64) -> f64 {
        -(inertia * self.mean_a + viscous * self.mean_v) / transmission
    }

    /// Half of the shift δ (m or rad), in the own coordinate of a body.
    pub(crate) fn half_shift(&self, inertia: f64, viscous: f64, transmission: f64) -> f64 {
        -0.5 * (self.miss_a + viscous / inertia * self.miss_v) / transmission
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: the integrals by Simpson's rule on 1000 intervals, exact for the cubic integrands and to 1e-12 for the
    /// quintic ones.
    #[test]
    fn means_and_misses_are_the_integrals() {
        let start = Setpoint { x: 0.3, v: -0.7, a: 2.0, j: 5.0, s: -11.0 };
        let h = 0.4;
        let integral = |f: &dyn Fn(f64) -> f64| {
            let n = 1000;
            let dt = h / f64::from(n);
            let simpson = |k: i32| match k {
                0 => 1.0,
                k if k == n => 1.0,
                k if k % 2 == 1 => 4.0,
                _ => 2.0,
            };
            (0..=n).map(|k| simpson(k) * f(f64::from(k) * dt)).sum::<f64>() * dt / 3.0
        };
        let tick = BaseTick::new(start, h);
        for (y, mean, miss) in [
            ((|p: Setpoint| p.v) as fn(Setpoint) -> f64, tick.mean_v, tick.miss_v),
            (|p: Setpoint| p.a, tick.mean_a, tick.miss_a),
        ] {
            let mean_exact = integral(&|t| y(start.after(t))) / h;
            let moment = integral(&|t| (h - t) * y(start.after(t)));
            assert!((mean - mean_exact).abs() < 1e-10, "{mean} {mean_exact}");
            let miss_exact = moment - mean_exact * h * h / 2.0;
            assert!((miss - miss_exact).abs() < 1e-10, "{miss} {miss_exact}");
        }
    }
}
