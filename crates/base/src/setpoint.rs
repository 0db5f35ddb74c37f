//! The set-point of one instant: position and its four derivatives.
#![expect(clippy::inline_always, reason = "what is inlined is compiled for the registers of its caller")]
use crate::state::Stateful;

/// Position and its derivatives at one instant, in the axis unit (m or rad).
#[derive(Debug, Clone, Copy, PartialEq, Default, Stateful)]
pub struct Setpoint {
    /// Position (m or rad).
    pub x: f64,
    /// Velocity (m/s or rad/s).
    pub v: f64,
    /// Acceleration (m/s² or rad/s²).
    pub a: f64,
    /// Jerk (m/s³ or rad/s³).
    pub j: f64,
    /// Snap (m/s⁴ or rad/s⁴), held until the next switching instant.
    pub s: f64,
}

impl Setpoint {
    /// At rest at `x`.
    #[must_use]
    pub const fn at_rest(x: f64) -> Self {
        Self { x, v: 0.0, a: 0.0, j: 0.0, s: 0.0 }
    }

    /// All components multiplied by `factor`.
    #[must_use]
    pub const fn scaled(self, factor: f64) -> Self {
        let Self { x, v, a, j, s } = self;
        Self { x: factor * x, v: factor * v, a: factor * a, j: factor * j, s: factor * s }
    }

    /// The same position passed at `pace` times the speed: the k-th derivative is `pace`^k times as large.
    #[must_use]
    pub const fn at_pace(self, pace: f64) -> Self {
        let Self { x, v, a, j, s } = self;
        let (two, three) = (pace * pace, pace * pace * pace);
        Self { x, v: pace * v, a: two * a, j: three * j, s: two * two * s }
    }

    /// The set-point `t` seconds later with constant snap: exact, not an approximation.
    #[inline(always)]
    #[must_use]
    pub fn after(self, t: f64) -> Self {
        let Self { x, v, a, j, s } = self;
        Self {
            x: x + t * (v + t / 2.0 * (a + t / 3.0 * (j + t / 4.0 * s))),
            v: v + t * (a + t / 2.0 * (j + t / 3.0 * s)),
            a: a + t * (j + t / 2.0 * s),
            j: j + t * s,
            s,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn after_is_the_taylor_polynomial() {
        let start = Setpoint { x: 1.0, v: 2.0, a: 3.0, j: 5.0, s: 7.0 };
        let t = 0.5_f64;
        let x = 1.0 + 2.0 * t + 3.0 * t.powi(2) / 2.0 + 5.0 * t.powi(3) / 6.0 + 7.0 * t.powi(4) / 24.0;
        assert!((start.after(t).x - x).abs() < 1e-15);
        let twice = start.after(0.2).after(0.3);
        for (one, two) in [(start.after(t).x, twice.x), (start.after(t).v, twice.v), (start.after(t).a, twice.a)] {
            assert!((one - two).abs() < 4e-15, "composing two steps rounds a few times: {one} {two}");
        }
    }
}
