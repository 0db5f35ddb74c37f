//! Velocity control: P or PI with back-calculation anti-windup, effort (torque or force) out.
//!
//! ```text
//! e = ω_ref − ω      v = τ_ff + k_p·e + τ_i      τ = sat(v, ±τ_max)
//! dτ_i/dt = k_p/T_i·e + (τ − v)/T_i              (forward Euler, step h)
//! ```
//! Source: Åström & Murray, *Feedback Systems*, 2nd ed., §11.4, tracking time T_t = T_i. The motor's coordinate.
use servobench_base::{ParamError, non_negative, positive};

/// Gains and limits; constant during a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Params {
    /// Proportional gain (N·m·s/rad or N·s/m).
    pub k_p: f64,
    /// Integral time (s); `None` for a P controller.
    pub integral_time: Option<f64>,
    /// Effort limit, symmetric (N·m or N); may be infinite.
    pub max_effort: f64,
}

/// All that a snapshot must hold.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct State {
    /// Integrator effort (N·m or N).
    pub integral: f64,
}

/// Values sampled at tick k.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Input {
    /// Velocity reference (rad/s or m/s).
    pub reference: f64,
    /// Measured velocity (rad/s or m/s).
    pub velocity: f64,
    /// Effort fed forward (N·m or N).
    pub feedforward: f64,
}

/// What tick k gives.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Output {
    /// Effort reference (N·m or N).
    pub effort: f64,
    /// Whether the limit cut it.
    pub saturated: bool,
}

impl Params {
    /// # Errors
    /// [`ParamError`] names the first parameter out of its bound.
    pub fn check(&self) -> Result<(), ParamError> {
        non_negative("drive.velocity.gain", self.k_p)?;
        if let Some(integral_time) = self.integral_time {
            positive("drive.velocity.integral_time", integral_time)?;
        }
        if self.max_effort.is_nan() || self.max_effort <= 0.0 {
            return Err(ParamError { name: "drive.max_effort", value: self.max_effort, bound: "positive" });
        }
        Ok(())
    }
}

/// Returns the effort reference for tick k, then advances `x` by `h` (s) to tick k+1.
pub fn step(p: &Params, x: &mut State, u: Input, h: f64) -> Output {
    let e = u.reference - u.velocity;
    let v = u.feedforward + p.k_p * e + x.integral;
    let effort = v.clamp(-p.max_effort, p.max_effort);
    if let Some(integral_time) = p.integral_time {
        x.integral += h / integral_time * (p.k_p * e + (effort - v));
    }
    #[expect(clippy::float_cmp, reason = "a clamp that does not bind returns the very same bits")]
    Output { effort, saturated: effort != v }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const J: f64 = 2e-3;
    const OMEGA_N: f64 = 50.0;

    /// Speed after 40 ms of a 1 rad/s step with both poles at −ω_n: k_p = 2·J·ω_n, T_i = 2/ω_n. The plant
    /// `J·dω/dt = τ` is exact under a zero-order hold.
    fn speed_at_40_ms(h: f64) -> f64 {
        let p = Params { k_p: 2.0 * J * OMEGA_N, integral_time: Some(2.0 / OMEGA_N), max_effort: 1e3 };
        let (mut x, mut omega) = (State::default(), 0.0);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small count")]
        for _ in 0..(0.04 / h).round() as u32 {
            let u = Input { reference: 1.0, velocity: omega, feedforward: 0.0 };
            omega += h / J * step(&p, &mut x, u, h).effort;
        }
        omega
    }

    /// Oracle: ω(t) = 1 − (1 − ω_n·t)·exp(−ω_n·t). Forward Euler: halving h halves the error.
    #[test]
    fn step_response_converges_with_order_one() {
        let a = OMEGA_N * 0.04;
        let exact = 1.0 - (1.0 - a) * (-a).exp();
        let err = |h| (speed_at_40_ms(h) - exact).abs();
        let order = (err(1e-4) / err(5e-5)).log2();
        assert!((order - 1.0).abs() < 0.02, "observed order {order}");
        assert!(err(1e-6) < 1e-4, "and it converges to the closed form: {}", err(1e-6));
    }

    proptest! {
        #[test]
        fn effort_never_exceeds_the_limit(e in -1e6..1e6_f64, integral in -1e6..1e6_f64, ff in -1e6..1e6_f64) {
            let p = Params { k_p: 0.2, integral_time: Some(0.04), max_effort: 2.4 };
            let u = Input { reference: e, velocity: 0.0, feedforward: ff };
            let mut x = State { integral };
            prop_assert!(step(&p, &mut x, u, 1e-3).effort.abs() <= 2.4);
        }
    }

    #[test]
    fn a_p_controller_has_no_memory() {
        let p = Params { k_p: 3.0, integral_time: None, max_effort: f64::INFINITY };
        let mut x = State::default();
        let u = Input { reference: 2.0, velocity: 0.5, feedforward: 1.0 };
        assert_eq!(step(&p, &mut x, u, 1e-3), Output { effort: 5.5, saturated: false });
        assert_eq!(x, State::default());
    }

    #[test]
    fn errors_name_the_parameter() {
        let p = Params { k_p: 1.0, integral_time: Some(0.0), max_effort: 1.0 };
        assert_eq!(
            p.check().unwrap_err().to_string(),
            "`drive.velocity.integral_time` must be finite and positive, got 0"
        );
        assert!(Params { max_effort: f64::NAN, integral_time: None, ..p }.check().is_err());
    }
}
