//! Integral and derivative of the position error, added to the proportional part of the position loop.
//!
//! ```text
//! ω_ref = K_v·(e + I + D) + g·v_ref        I += T_p/T_i·e        D: the filtered derivative of e ([`derivative`])
//! ```
//! Forward Euler, as in the velocity loop. Conditional integration (anti-windup): while the speed limit or the effort limit cuts the demand
//! of the loops, the integral does not grow in the direction of the cut. The derivative adds a velocity loop of gain K_v·T_d to the
//! reference that is fed forward.
//! Sources: Åström & Hägglund, *Advanced PID Control*, 2006, §3.4 and §3.5.
use super::derivative;
use servobench_base::Stateful;
use servobench_config::Kind::Plain;
use servobench_config::quantities::TIME;
use servobench_config::{ParameterError, positive};

servobench_config::parameters! {
    /// A parameter of the position loop other than its gain.
    pub enum Parameter {
        /// Integral time of the position loop
        INTEGRAL_TIME "integral time of the position loop" = positive(Plain(&TIME), "50 ms");
    }
}

/// Parameters; constant during a run.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Params {
    /// Integral time T_i (s); `None` without an integral.
    pub integral_time: Option<f64>,
    /// Derivative; `None` without one.
    pub derivative: Option<derivative::Params>,
}

/// State from tick to tick.
#[derive(Debug, Clone, Copy, PartialEq, Default, Stateful)]
pub struct State {
    /// Integral I (axis coordinate).
    pub integral: f64,
    /// Derivative.
    pub derivative: derivative::State,
}

impl Params {
    /// # Errors
    /// [`ParameterError`] names the first parameter out of its bound.
    pub fn check(&self) -> Result<(), ParameterError> {
        if let Some(integral_time) = self.integral_time {
            Parameter::INTEGRAL_TIME.check(integral_time)?;
        }
        let named = [derivative::Parameter::POSITION_TIME, derivative::Parameter::POSITION_FILTER_TIME];
        self.derivative.map_or(Ok(()), |derivative| derivative.check(named))
    }
}

/// Returns e + I + D in a cycle with the position error `error`, then advances `x` by `h` (s). `cut` has the sign in which a limit below
/// cuts, 0 if none does.
pub fn step(p: &Params, x: &mut State, error: f64, cut: f64, h: f64) -> f64 {
    let derivative = p.derivative.map_or(0.0, |derivative| derivative::step(&derivative, &mut x.derivative, error, h));
    let sum = error + x.integral + derivative;
    if let Some(integral_time) = p.integral_time
        && error * cut <= 0.0
    {
        x.integral += h / integral_time * error;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A position that follows its velocity command at once, against a velocity error `v`: x' = K_v·(e + I) − v. Oracle: with K_v·T_i = 4
    /// both poles are at −K_v/2, and from rest e(t) = v·t·exp(−K_v·t/2). Forward Euler: first order.
    #[test]
    fn an_integral_takes_a_constant_error_away() {
        let (gain, v, end) = (57.0, 0.013, 61e-3);
        let p = Params { integral_time: Some(4.0 / gain), derivative: None };
        let found = |n: u32| {
            let (mut x, mut position, h) = (State::default(), 0.0, end / f64::from(n));
            for _ in 0..n {
                position += h * (gain * step(&p, &mut x, -position, 0.0, h) - v);
            }
            -position
        };
        let exact = v * end * (-gain * end / 2.0).exp();
        let order = ((found(2_000) - exact) / (found(4_000) - exact)).log2();
        assert!((order - 1.0).abs() < 0.02, "{order}");
        assert!((found(64_000) / exact - 1.0).abs() < 1e-3);
    }

    /// Oracle: by hand. The integral grows against the direction of the cut, and not in it.
    #[test]
    fn a_limit_that_cuts_stops_the_integral_in_its_direction() {
        let p = Params { integral_time: Some(0.5), derivative: None };
        for (cut, error, gathered) in
            [(1.0, 2.0, 0.0), (-1.0, -2.0, 0.0), (1.0, -2.0, -0.4), (-1.0, 2.0, 0.4), (0.0, 2.0, 0.4)]
        {
            let mut x = State::default();
            assert_eq!(step(&p, &mut x, error, cut, 0.1).to_bits(), f64::to_bits(error));
            assert!((x.integral - gathered).abs() < 1e-15, "{cut} {error}: {x:?}");
        }
    }

    #[test]
    fn errors_name_the_parameter() {
        let said = |params: Params| params.check().unwrap_err().to_string();
        let none = Params::default();
        assert!(said(Params { integral_time: Some(0.0), ..none }).starts_with("`integral time of the position loop`"));
        let derivative = Some(derivative::Params { time: 1e-3, filter_time: -1.0 });
        assert!(said(Params { derivative, ..none }).starts_with("`derivative filter of the position loop`"));
    }
}
