//! Velocity control: P or PI with back-calculation anti-windup, effort (torque or force) out.
//!
//! ```text
//! e = ω_ref − ω      v = F(τ_ff + k_p·(b·ω_ref − ω) + τ_i)
//! τ = sat(v, ±min(τ_max, τ_avail)), and within the limits of the mode
//! dτ_i/dt = k_p/T_i·e + (τ − v)/T_i              (forward Euler, step h)
//! ```
//! F are the filters of the torque path ([`crate::filter`]), 1 without them. The weight b of the reference is 1 in a PI, 0 in an IP
//! controller, which follows a step without the zero of the PI. τ_avail is the capability of the loop below; since it is known here, like
//! the limits of both directions from the bus, the integrator does not wind up against them.
//! Source: Åström & Murray, *Feedback Systems*, 2nd ed., §11.4, tracking time T_t = T_i. All in the motor's coordinate.
#![expect(clippy::inline_always, reason = "what is inlined is compiled for the registers of its caller")]
use crate::EffortLimits;
use servobench_base::{Stateful, limit};
use servobench_config::Kind::{Motor, Plain};
use servobench_config::quantities::{EFFORT, TIME, VISCOUS};
use servobench_config::{ParameterError, not_negative, positive};

servobench_config::parameters! {
    /// A parameter of the velocity loop.
    pub enum Parameter {
        /// Proportional gain of the velocity loop
        GAIN "gain of the velocity loop" = not_negative(Motor(&VISCOUS), "243.45 N s/m");
        /// Integral time of a PI
        INTEGRAL_TIME "integral time of the velocity loop" = positive(Plain(&TIME), "6 ms");
        /// Largest torque or force that the drive requests
        MAX_EFFORT "largest effort" = positive(Motor(&EFFORT), "12 Nm");
    }
}

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

/// State from tick to tick.
#[derive(Debug, Clone, Copy, Default, PartialEq, Stateful)]
pub struct State {
    /// Integrator effort (N·m or N).
    pub integral: f64,
}

/// Values sampled at tick k.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Input {
    /// Velocity reference (rad/s or m/s).
    pub reference: f64,
    /// Measured velocity (rad/s or m/s).
    pub velocity: f64,
    /// Feedforward effort (N·m or N).
    pub feedforward: f64,
    /// Largest efforts of the loop below.
    pub available: EffortLimits,
    /// Largest permitted efforts in either direction.
    pub limits: EffortLimits,
}

/// Limit that cuts the effort.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Stateful)]
pub enum Cut {
    /// Limit of this loop, [`Params::max_effort`], or of the direction, [`Input::limits`].
    Effort,
    /// Limit of the loop below, [`Input::available`].
    Available,
}

/// Output of tick k.
#[derive(Debug, Clone, Copy, Default, PartialEq, Stateful)]
pub struct Output {
    /// Effort reference (N·m or N).
    pub effort: f64,
    /// Limit that cut the effort, if any.
    pub cut: Option<Cut>,
}

impl Params {
    /// # Errors
    /// [`ParameterError`] names the first parameter out of its bound.
    pub fn check(&self) -> Result<(), ParameterError> {
        Parameter::GAIN.check(self.k_p)?;
        if let Some(integral_time) = self.integral_time {
            Parameter::INTEGRAL_TIME.check(integral_time)?;
        }
        limit(Parameter::MAX_EFFORT, self.max_effort).map(|_| ())
    }
}

/// Returns the effort reference for tick k, then advances `x` by `h` (s) to tick k+1.
#[inline(always)]
pub fn step(p: &Params, x: &mut State, u: Input, h: f64) -> Output {
    step_shaped(p, x, u, h, 1.0, |effort| effort)
}

/// Like [`step`], with the weight `weight` of the reference in the proportional part, and `filter` between the controller and the limits:
/// the excess cut off its output is fed back to the integrator.
#[inline(always)]
pub fn step_shaped(
    p: &Params,
    x: &mut State,
    u: Input,
    h: f64,
    weight: f64,
    filter: impl FnOnce(f64) -> f64,
) -> Output {
    let e = u.reference - u.velocity;
    let v = filter(u.feedforward + p.k_p * (weight * u.reference - u.velocity) + x.integral);
    let output = limited(p, u.available, u.limits, v);
    if let Some(integral_time) = p.integral_time {
        x.integral += h / integral_time * (p.k_p * e + (output.effort - v));
    }
    output
}

/// Limits `effort`.
#[inline(always)]
#[must_use]
pub fn limited(p: &Params, available: EffortLimits, limits: EffortLimits, effort: f64) -> Output {
    let own = limits.at_most(p.max_effort);
    let EffortLimits { forward, backward } = own.within(available);
    let given = effort.clamp(-backward, forward);
    let (limit, available) =
        if effort > 0.0 { (own.forward, available.forward) } else { (own.backward, available.backward) };
    let cut = if limit <= available { Cut::Effort } else { Cut::Available };
    #[expect(clippy::float_cmp, reason = "a clamp that does not bind returns the same bits")]
    Output { effort: given, cut: if given == effort { None } else { Some(cut) } }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const J: f64 = 2e-3;
    const OMEGA_N: f64 = 50.0;
    const FREE: Input = Input {
        reference: 0.0,
        velocity: 0.0,
        feedforward: 0.0,
        available: EffortLimits::NONE,
        limits: EffortLimits::NONE,
    };

    /// Speed after 40 ms of a 1 rad/s step with both poles at −ω_n: k_p = 2·J·ω_n, T_i = 2/ω_n. The plant
    /// `J·dω/dt = τ` is exact under a zero-order hold.
    fn speed_at_40_ms(h: f64) -> f64 {
        let p = Params { k_p: 2.0 * J * OMEGA_N, integral_time: Some(2.0 / OMEGA_N), max_effort: 1e3 };
        let (mut x, mut omega) = (State::default(), 0.0);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small count")]
        for _ in 0..(0.04 / h).round() as u32 {
            let u = Input { reference: 1.0, velocity: omega, ..FREE };
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
        fn effort_never_exceeds_either_limit(
            e in -1e6..1e6_f64,
            integral in -1e6..1e6_f64,
            feedforward in -1e6..1e6_f64,
            available in 0.1..10.0_f64,
            forward in 0.1..10.0_f64,
            backward in 0.1..10.0_f64,
        ) {
            let p = Params { k_p: 0.2, integral_time: Some(0.04), max_effort: 2.4 };
            let mut x = State { integral };
            let limits = EffortLimits { forward, backward };
            let output = step(&p, &mut x, Input { reference: e, feedforward, available: EffortLimits::both(available), limits, ..FREE }, 1e-3);
            let asked = feedforward + 0.2 * e + integral;
            let own = if asked > 0.0 { forward.min(2.4) } else { backward.min(2.4) };
            prop_assert!(output.effort.abs() <= available.min(own));
            let binding = if available < own { Cut::Available } else { Cut::Effort };
            prop_assert_eq!(output.cut, (asked.abs() > available.min(own)).then_some(binding));
        }
    }

    /// Oracle: with the effort at its limit, dτ_i/dt = (τ_max − τ_ff − τ_i)/T_i: the integrator comes to rest at the binding limit, less
    /// the feedforward, whatever the error.
    #[test]
    fn the_integrator_knows_the_limit_that_binds() {
        let p = Params { k_p: 3.0, integral_time: Some(0.04), max_effort: 2.4 };
        let backward_only = EffortLimits { forward: 0.9, backward: f64::INFINITY };
        for (available, limits, limit) in [
            (1.5, EffortLimits::NONE, 1.5),
            (f64::INFINITY, EffortLimits::NONE, 2.4),
            (1.5, backward_only, 0.9),
            (1.5, backward_only.turned(), 1.5),
        ] {
            let mut x = State::default();
            for _ in 0..10_000 {
                let available = EffortLimits::both(available);
                step(&p, &mut x, Input { reference: 40.0, feedforward: 0.5, available, limits, ..FREE }, 1e-3);
            }
            // v is of 120: rounded to 1.4e-14 at each of the 40 steps that the integrator remembers.
            assert!((x.integral - (limit - 0.5)).abs() < 1e-12, "{available}: {x:?}");
        }
    }

    /// Oracle: with both poles at −ω_n and without the PI's zero (b = 0) a step of the reference gives 1 − (1 + ω_n·t)·exp(−ω_n·t), which
    /// does not overshoot; b between adds its share of ω_n·t·exp(−ω_n·t)·2.
    #[test]
    fn the_weight_of_the_reference_moves_the_zero() {
        let h = 1e-6;
        let p = Params { k_p: 2.0 * J * OMEGA_N, integral_time: Some(2.0 / OMEGA_N), max_effort: 1e3 };
        for weight in [0.0, 0.37, 1.0] {
            let (mut x, mut omega) = (State::default(), 0.0);
            for _ in 0..27_000 {
                let u = Input { reference: 1.0, velocity: omega, ..FREE };
                omega += h / J * step_shaped(&p, &mut x, u, h, weight, |effort| effort).effort;
            }
            let a = OMEGA_N * 27e-3;
            let exact = 1.0 - (1.0 + a) * (-a).exp() + 2.0 * weight * a * (-a).exp();
            // First order: the step is 5e-5 of the time constant.
            assert!((omega - exact).abs() < 1e-4, "{weight}: {omega} {exact}");
        }
    }

    #[test]
    fn a_p_controller_has_no_memory() {
        let p = Params { k_p: 3.0, integral_time: None, max_effort: f64::INFINITY };
        let mut x = State::default();
        let u = Input { reference: 2.0, velocity: 0.5, feedforward: 1.0, ..FREE };
        assert_eq!(step(&p, &mut x, u, 1e-3), Output { effort: 5.5, cut: None });
        assert_eq!(x, State::default());
    }

    #[test]
    fn errors_name_the_parameter() {
        let p = Params { k_p: 1.0, integral_time: Some(0.0), max_effort: 1.0 };
        assert_eq!(
            p.check().unwrap_err().to_string(),
            "`integral time of the velocity loop` must be finite and positive, got 0"
        );
        assert!(Params { max_effort: f64::NAN, integral_time: None, ..p }.check().is_err());
    }
}
