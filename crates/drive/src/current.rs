//! Current control in the rotor frame: PI per axis, cross-coupling and back-EMF decoupled, vector voltage limit.
//!
//! ```text
//! e = i_ref − i           v = k_p·e + I + decoupling      u = limit(v)
//! decoupling_d = −ω·L_q·i_q      decoupling_q = ω·(L_d·i_d + ψ)
//! dI/dt = k_i·(e + (u − v)/k_p)                           (forward Euler, step h)
//! ```
//! With k_p = α·L and k_i = k_p·R/L = α·R the loop closes like 1/(1 + s/α) (Harnefors & Nee, IEEE TIA 34(1), 1998); a ramp is followed with
//! a delay of 1/α, whatever the dead time in the loop. The voltage limit gives the d axis priority.
//!
//! [`operating_point`] computes the current references of an effort; [`dead_time`] compensates the dead time of the inverter.
//!
//! The voltage computed at tick k is applied from k+1 to k+2: it is rotated ahead by 1.5·h·ω to match the rotor then.
#![expect(clippy::inline_always, reason = "what is inlined is compiled for the registers of its caller")]
pub mod dead_time;
pub mod operating_point;

use servobench_base::{AlphaBeta, Dq, Rotation, Stateful, limit};
use servobench_config::Kind::Plain;
use servobench_config::quantities::{
    CURRENT, CURRENT_GAIN, FLUX_LINKAGE, INDUCTANCE, RATIO, RESISTANCE, TIME, VOLTAGE,
};
use servobench_config::{ParameterError, any, not_negative, positive};

servobench_config::parameters! {
    /// A parameter of the current loop.
    pub enum Parameter {
        /// Proportional gain of the d axis
        GAIN_D "gain of the current loop, d axis" = positive(Plain(&CURRENT_GAIN), "12 V/A");
        /// Proportional gain of the q axis
        GAIN_Q "gain of the current loop, q axis" = positive(Plain(&CURRENT_GAIN), "12 V/A");
        /// Integral time of the d axis
        INTEGRAL_TIME_D "integral time of the current loop, d axis" = positive(Plain(&TIME), "5 ms");
        /// Integral time of the q axis
        INTEGRAL_TIME_Q "integral time of the current loop, q axis" = positive(Plain(&TIME), "5 ms");
        /// Reference of the d-axis current
        D_REFERENCE "reference of the current in d" = any(Plain(&CURRENT), "-20 Arms");
        /// Largest phase current
        MAX_CURRENT "largest current" = positive(Plain(&CURRENT), "20 Arms");
        /// Voltage of the DC link
        DC_LINK "voltage of the DC link" = positive(Plain(&VOLTAGE), "540 V");
        /// Pole pairs
        POLE_PAIRS "pole pairs" = positive(Plain(&RATIO), "4");
        /// Stator resistance
        RESISTANCE "estimate of the resistance" = positive(Plain(&RESISTANCE), "0.36 Ohm");
        /// Inductance of the d axis
        INDUCTANCE_D "estimate of the inductance, d axis" = positive(Plain(&INDUCTANCE), "36 mH");
        /// Inductance of the q axis
        INDUCTANCE_Q "estimate of the inductance, q axis" = positive(Plain(&INDUCTANCE), "51 mH");
        /// Flux linkage, amplitude; 0 for a reluctance motor
        FLUX_LINKAGE "estimate of the flux linkage" = not_negative(Plain(&FLUX_LINKAGE), "0.545 V s");
    }
}

/// Motor parameters as estimated by the firmware.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MotorEstimate {
    /// Electrical angle per motor coordinate: pole pairs p (rad/rad), or π/τ_p of a linear motor (rad/m).
    pub electrical_ratio: f64,
    /// Stator resistance, phase to neutral (Ω).
    pub resistance: f64,
    /// Inductances (H).
    pub inductance: Dq,
    /// Flux linkage, peak (V·s); 0 for a reluctance motor.
    pub flux_linkage: f64,
}

/// Origin of the proportional gains.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Tuning {
    /// From the closed-loop bandwidth (rad/s) and the estimated motor.
    Bandwidth(f64),
    /// Given values (V/A).
    Gains(Dq),
}

/// Gains of the two axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gains {
    /// Proportional gains (V/A).
    pub k_p: Dq,
    /// Integral gains (V/(A·s)).
    pub k_i: Dq,
}

/// Gains and limits; constant during a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Params {
    /// Estimated motor.
    pub motor: MotorEstimate,
    /// Gains.
    pub gains: Gains,
    /// Reference of the d axis (A, peak); below 0 it weakens the field.
    pub d_reference: f64,
    /// Largest length of the current reference (A, peak); may be infinite.
    pub max_current: f64,
    /// Largest voltage amplitude (V); may be infinite.
    pub max_voltage: f64,
    /// Choice of the currents for an effort.
    pub operation: operating_point::Params,
    /// Compensation of the inverter's dead time, if any.
    pub dead_time: Option<dead_time::Params>,
}

/// State from tick to tick.
#[derive(Debug, Clone, Copy, PartialEq, Default, Stateful)]
pub struct State {
    /// Integrators (V).
    pub integral: Dq,
    /// Voltage to be applied at the next tick (V, stator frame).
    pub pending: AlphaBeta,
}

/// Values sampled at tick k.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Input {
    /// Current reference (A, peak).
    pub reference: Dq,
    /// Measured stator current (A, peak).
    pub current: AlphaBeta,
    /// Measured rotor angle.
    pub rotor: Rotation,
    /// Measured electrical speed (rad/s).
    pub omega_e: f64,
}

/// Output of tick k.
#[derive(Debug, Clone, Copy, PartialEq, Default, Stateful)]
pub struct Output {
    /// Voltage to apply from now on (V): the one computed a tick ago.
    pub voltage: AlphaBeta,
    /// Measured current in the rotor frame (A).
    pub current: Dq,
    /// Voltage computed at this tick (V).
    pub computed: Dq,
    /// True if the voltage was limited.
    pub saturated: bool,
}

impl MotorEstimate {
    /// Effort per q-axis current at the d-axis current `i_d` (N·m/A or N/A, peak): 1.5·p·(ψ + (L_d − L_q)·i_d).
    #[must_use]
    pub fn effort_constant(&self, i_d: f64) -> f64 {
        1.5 * self.electrical_ratio * (self.flux_linkage + (self.inductance.d - self.inductance.q) * i_d)
    }
}

impl Gains {
    /// Gains for the closed-loop bandwidth `alpha` (rad/s): k_p = α·L.
    #[must_use]
    pub fn from_bandwidth(motor: &MotorEstimate, alpha: f64) -> Self {
        let Dq { d, q } = motor.inductance;
        Self::cancelling(motor, Dq { d: alpha * d, q: alpha * q })
    }

    /// Gains of `tuning`, with these integral times (s), or L/R of each axis.
    #[must_use]
    pub fn tuned(motor: &MotorEstimate, tuning: Tuning, integral_times: Option<Dq>) -> Self {
        let derived = match tuning {
            Tuning::Bandwidth(alpha) => Self::from_bandwidth(motor, alpha),
            Tuning::Gains(k_p) => Self::cancelling(motor, k_p),
        };
        integral_times.map_or(derived, |t_i| Self::with_integral_times(derived.k_p, t_i))
    }

    /// Gains with the proportional part `k_p` (V/A) and the integral time L/R of each axis: the controller's zero cancels the motor's pole.
    #[must_use]
    pub fn cancelling(motor: &MotorEstimate, k_p: Dq) -> Self {
        let Dq { d, q } = motor.inductance;
        Self::with_integral_times(k_p, Dq { d: d / motor.resistance, q: q / motor.resistance })
    }

    /// Gains with the proportional part `k_p` (V/A) and the integral times `t_i` (s).
    #[must_use]
    pub fn with_integral_times(k_p: Dq, t_i: Dq) -> Self {
        Self { k_p, k_i: Dq { d: k_p.d / t_i.d, q: k_p.q / t_i.q } }
    }
}

impl Params {
    /// # Errors
    /// [`ParameterError`] names the first parameter out of its bound.
    pub fn check(&self) -> Result<(), ParameterError> {
        for (name, value) in [
            (Parameter::POLE_PAIRS, self.motor.electrical_ratio),
            (Parameter::RESISTANCE, self.motor.resistance),
            (Parameter::INDUCTANCE_D, self.motor.inductance.d),
            (Parameter::INDUCTANCE_Q, self.motor.inductance.q),
            (Parameter::FLUX_LINKAGE, self.motor.flux_linkage),
            (Parameter::GAIN_D, self.gains.k_p.d),
            (Parameter::GAIN_Q, self.gains.k_p.q),
            (Parameter::INTEGRAL_TIME_D, self.gains.k_p.d / self.gains.k_i.d),
            (Parameter::INTEGRAL_TIME_Q, self.gains.k_p.q / self.gains.k_i.q),
        ] {
            name.check(value)?;
        }
        limit(Parameter::MAX_CURRENT, self.max_current)?;
        let is_within = self.d_reference.is_finite() && self.d_reference.abs() < self.max_current;
        self.operation.check(self.max_current)?;
        let has_torque = self.operation.strategy.has_torque(&self.motor, self.d_reference);
        if !has_torque && self.motor.flux_linkage == 0.0 && self.d_reference == 0.0 {
            let bound = "above 0 where the d axis has no current that makes torque by different inductances";
            return Err(ParameterError { name: Parameter::FLUX_LINKAGE, value: 0.0, bound });
        }
        if !is_within || !has_torque {
            let bound = "below the largest current and leave the motor some torque";
            return Err(ParameterError { name: Parameter::D_REFERENCE, value: self.d_reference, bound });
        }
        if let Some(dead_time) = &self.dead_time {
            dead_time.check()?;
        }
        limit(Parameter::DC_LINK, self.max_voltage).map(|_| ())
    }

    /// Effort per q-axis current (N·m/A or N/A, peak), as estimated by the drive; 0 if the d axis has a current only by maximum torque per
    /// ampere.
    #[must_use]
    pub fn effort_constant(&self) -> f64 {
        self.motor.effort_constant(self.d_reference)
    }

    /// Largest q-axis current beside that of the d axis (A, peak): the limit applies to the vector.
    #[must_use]
    pub fn max_q_current(&self) -> f64 {
        q_current(self.max_current, self.d_reference)
    }

    /// Largest effort within the current limit at standstill (N·m or N).
    #[must_use]
    pub fn max_effort(&self) -> f64 {
        match self.operation.strategy {
            operating_point::Strategy::DReference => self.effort_constant() * self.max_q_current(),
            operating_point::Strategy::Mtpa => {
                let d = self.motor.mtpa_at_current(self.max_current);
                self.motor.effort_constant(d) * q_current(self.max_current, d)
            }
        }
    }
}

/// Largest q-axis current beside `d` for a vector of the length `max` (A, peak).
#[must_use]
pub fn q_current(max: f64, d: f64) -> f64 {
    if d == 0.0 { max } else { libm::sqrt(((max - d) * (max + d)).max(0.0)) }
}

/// Largest phase voltage amplitude on a DC link of `dc_link` (V): the linear range of space-vector modulation, U_dc/√3
/// (Holmes & Lipo, *Pulse Width Modulation for Power Converters*, §6.3).
#[must_use]
pub fn voltage_limit(dc_link: f64) -> f64 {
    dc_link / libm::sqrt(3.0)
}

/// Returns the voltage for tick k, then advances `x` by `h` (s) to tick k+1.
#[inline(always)]
pub fn step(p: &Params, x: &mut State, u: Input, h: f64) -> Output {
    let i = u.current.to_dq(u.rotor);
    let e = Dq { d: u.reference.d - i.d, q: u.reference.q - i.q };
    let motor = &p.motor;
    let v = Dq {
        d: p.gains.k_p.d * e.d + x.integral.d - u.omega_e * motor.inductance.q * i.q,
        q: p.gains.k_p.q * e.q + x.integral.q + u.omega_e * (motor.inductance.d * i.d + motor.flux_linkage),
    };
    let computed = limit_d_first(v, p.max_voltage);
    let saturated = computed != v;
    let windup = if saturated {
        Dq { d: (v.d - computed.d) / p.gains.k_p.d, q: (v.q - computed.q) / p.gains.k_p.q }
    } else {
        Dq::default()
    };
    x.integral.d += h * p.gains.k_i.d * (e.d - windup.d);
    x.integral.q += h * p.gains.k_i.q * (e.q - windup.q);
    let then = u.rotor.ahead(1.5 * h * u.omega_e);
    let mut pending = computed.to_alpha_beta(then);
    if let Some(dead_time) = &p.dead_time {
        let lost = dead_time.voltage(u.reference.to_alpha_beta(then));
        pending = AlphaBeta { alpha: pending.alpha + lost.alpha, beta: pending.beta + lost.beta };
    }
    let voltage = core::mem::replace(&mut x.pending, pending);
    Output { voltage, current: i, computed, saturated }
}

/// Cuts `v` to the circle of radius `max`, with priority for d.
#[inline(always)]
fn limit_d_first(v: Dq, max: f64) -> Dq {
    if v.d * v.d + v.q * v.q <= max * max {
        return v;
    }
    let d = v.d.clamp(-max, max);
    let q_max = libm::sqrt(max * max - d * d);
    // A NaN in d gives no bound: the voltage passes unchanged, and ends the run.
    Dq { d, q: if v.q.abs() > q_max { q_max.copysign(v.q) } else { v.q } }
}

#[cfg(test)]
mod tests;
