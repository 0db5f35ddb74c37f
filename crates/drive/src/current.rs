//! Current control in the rotor frame: PI per axis, cross-coupling and back-EMF decoupled, vector voltage limit.
//!
//! ```text
//! e = i_ref − i           v = k_p·e + I + decoupling      u = limit(v)
//! decoupling_d = −ω·L_q·i_q      decoupling_q = ω·(L_d·i_d + ψ)
//! dI/dt = k_i·(e + (u − v)/k_p)                           (forward Euler, step h)
//! ```
//! With k_p = α·L and k_i = k_p·R/L = α·R the loop closes like 1/(1 + s/α) (Harnefors & Nee, IEEE TIA 34(1), 1998); a
//! ramp is followed 1/α late, whatever the dead time in the loop. The voltage limit gives the d axis first call.
//!
//! The voltage computed at tick k is applied from k+1 to k+2: it is turned ahead by 1.5·h·ω to meet the rotor there.
#![expect(clippy::inline_always, reason = "what is inlined is compiled for the registers of its caller")]
use servobench_base::{AlphaBeta, Dq, Rotation, limit};
use servobench_config::Kind::Plain;
use servobench_config::quantities::{
    CURRENT, CURRENT_GAIN, FLUX_LINKAGE, INDUCTANCE, RATIO, RESISTANCE, TIME, VOLTAGE,
};
use servobench_config::{ParameterError, any, positive};

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
        /// Flux linkage, amplitude
        FLUX_LINKAGE "estimate of the flux linkage" = positive(Plain(&FLUX_LINKAGE), "0.545 V s");
    }
}

/// The motor as the firmware knows it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MotorEstimate {
    /// Electrical angle per motor coordinate: pole pairs p (rad/rad), or π/τ_p of a linear motor (rad/m).
    pub electrical_ratio: f64,
    /// Stator resistance, phase to neutral (Ω).
    pub resistance: f64,
    /// Inductances (H).
    pub inductance: Dq,
    /// Flux linkage, peak (V·s).
    pub flux_linkage: f64,
}

/// What the proportional gains follow from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Tuning {
    /// The closed-loop bandwidth (rad/s) and the estimated motor.
    Bandwidth(f64),
    /// They are given (V/A).
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
    /// The motor.
    pub motor: MotorEstimate,
    /// Gains.
    pub gains: Gains,
    /// Reference of the d axis (A, peak); below 0 it weakens the field.
    pub d_reference: f64,
    /// Largest length of the current reference (A, peak); may be infinite.
    pub max_current: f64,
    /// Largest voltage amplitude (V); may be infinite.
    pub max_voltage: f64,
}

/// All that a snapshot must hold.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct State {
    /// Integrators (V).
    pub integral: Dq,
    /// Voltage that goes out at the next tick (V, stator frame).
    pub pending: AlphaBeta,
}

/// Values sampled at tick k.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Input {
    /// Current reference (A, peak).
    pub reference: Dq,
    /// Measured stator current (A, peak).
    pub current: AlphaBeta,
    /// Measured rotor.
    pub rotor: Rotation,
    /// Measured electrical speed (rad/s).
    pub omega_e: f64,
}

/// What tick k gives.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Output {
    /// Voltage to apply from now on (V): the one computed a tick ago.
    pub voltage: AlphaBeta,
    /// Measured current in the rotor frame (A).
    pub current: Dq,
    /// Voltage computed at this tick (V).
    pub computed: Dq,
    /// Whether the limit cut it.
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

    /// Those of `tuning`, with these integral times (s), or L/R of each axis.
    #[must_use]
    pub fn tuned(motor: &MotorEstimate, tuning: Tuning, integral_times: Option<Dq>) -> Self {
        let derived = match tuning {
            Tuning::Bandwidth(alpha) => Self::from_bandwidth(motor, alpha),
            Tuning::Gains(k_p) => Self::cancelling(motor, k_p),
        };
        integral_times.map_or(derived, |t_i| Self::with_integral_times(derived.k_p, t_i))
    }

    /// The proportional gains `k_p` (V/A) with the integral time L/R of each axis: the controller's zero cancels the
    /// motor's pole.
    #[must_use]
    pub fn cancelling(motor: &MotorEstimate, k_p: Dq) -> Self {
        let Dq { d, q } = motor.inductance;
        Self::with_integral_times(k_p, Dq { d: d / motor.resistance, q: q / motor.resistance })
    }

    /// The proportional gains `k_p` (V/A) with the integral times `t_i` (s).
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
        if !is_within || self.effort_constant() <= 0.0 {
            let bound = "below the largest current and leave the motor some torque";
            return Err(ParameterError { name: Parameter::D_REFERENCE, value: self.d_reference, bound });
        }
        limit(Parameter::DC_LINK, self.max_voltage).map(|_| ())
    }

    /// Effort per q-axis current (N·m/A or N/A, peak), as the drive believes.
    #[must_use]
    pub fn effort_constant(&self) -> f64 {
        self.motor.effort_constant(self.d_reference)
    }

    /// Largest q-axis current that the d axis leaves (A, peak): the limit is on the vector.
    #[must_use]
    pub fn max_q_current(&self) -> f64 {
        q_current(self.max_current, self.d_reference)
    }

    /// Largest effort that the current limit leaves (N·m or N).
    #[must_use]
    pub fn max_effort(&self) -> f64 {
        self.effort_constant() * self.max_q_current()
    }
}

/// What a current of the length `max` leaves for the q axis beside `d` (A, peak).
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
    let voltage = core::mem::replace(&mut x.pending, computed.to_alpha_beta(u.rotor.ahead(1.5 * h * u.omega_e)));
    Output { voltage, current: i, computed, saturated }
}

/// Cuts `v` to the circle of radius `max`; d keeps what it asks for as long as the circle allows.
#[inline(always)]
fn limit_d_first(v: Dq, max: f64) -> Dq {
    if v.d * v.d + v.q * v.q <= max * max {
        return v;
    }
    let d = v.d.clamp(-max, max);
    let q_max = libm::sqrt(max * max - d * d);
    Dq { d, q: v.q.clamp(-q_max, q_max) }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MOTOR: MotorEstimate = MotorEstimate {
        electrical_ratio: 3.0,
        resistance: 3.6,
        inductance: Dq { d: 36e-3, q: 51e-3 },
        flux_linkage: 0.545,
    };
    const H: f64 = 1.0 / 16_000.0;

    fn tuned(alpha: f64, max_voltage: f64) -> Params {
        let gains = Gains::from_bandwidth(&MOTOR, alpha);
        Params { motor: MOTOR, gains, d_reference: 0.0, max_current: f64::INFINITY, max_voltage }
    }

    /// Drives an R–L load at standstill, where each axis is exactly i(k+1) = a·i + (1 − a)/R·u.
    fn ramp_lag(alpha: f64) -> f64 {
        let p = tuned(alpha, 1e6);
        let (mut x, mut i) = (State::default(), Dq::default());
        let slope = 100.0;
        for k in 0..1_600 {
            let reference = Dq { d: 0.0, q: slope * f64::from(k) * H };
            let current = AlphaBeta { alpha: i.d, beta: i.q };
            let out = step(&p, &mut x, Input { reference, current, rotor: Rotation::default(), omega_e: 0.0 }, H);
            for (i, u, l) in [(&mut i.d, out.voltage.alpha, 36e-3), (&mut i.q, out.voltage.beta, 51e-3)] {
                let a = (-H * 3.6 / l).exp();
                *i = a * *i + (1.0 - a) / 3.6 * u;
            }
        }
        (slope * 1_600.0 * H - i.q) / slope
    }

    /// Oracle: the final-value theorem: a loop of gain α/s follows a ramp 1/α late, one tick of dead time or not.
    #[test]
    fn a_ramp_is_followed_one_over_alpha_late() {
        for alpha in [500.0, 2_000.0, 6_000.0] {
            // Forward Euler and the exact hold of R–L differ by h·R/2L of the gain.
            assert!((ramp_lag(alpha) * alpha - 1.0).abs() < 5e-3, "{alpha}: {}", ramp_lag(alpha) * alpha);
        }
    }

    #[test]
    fn d_has_first_call_on_the_voltage() {
        let cut = limit_d_first(Dq { d: -240.0, q: 300.0 }, 300.0);
        assert!((cut.d + 240.0).abs() < 1e-12 && (cut.q - 180.0).abs() < 1e-12, "{cut:?}");
        assert_eq!(limit_d_first(Dq { d: 400.0, q: 1.0 }, 300.0), Dq { d: 300.0, q: 0.0 });
    }

    /// Oracle: with the voltage at u_max, v = k_p·e + I and dI/dt = k_i·(e + (u_max − v)/k_p) = (u_max − I)·k_i/k_p: the
    /// integrator comes to rest at u_max, whatever the error.
    #[test]
    fn the_integrator_of_a_saturated_axis_rests_at_the_limit() {
        let p = tuned(2_000.0, 300.0);
        let mut x = State::default();
        let input = Input {
            reference: Dq { d: 0.0, q: 100.0 },
            current: AlphaBeta::default(),
            rotor: Rotation::default(),
            omega_e: 0.0,
        };
        for _ in 0..160_000 {
            assert!(step(&p, &mut x, input, H).saturated);
        }
        // Each step rounds v, of 10 kV, and a difference of its size; what is rounded decays with k_i/k_p.
        assert!((x.integral.q - 300.0).abs() < 1e-10, "{:?}", x.integral);
    }

    /// Oracle: by hand. T_i = L/R of each axis: 10 V/A · 3.6 Ω / 36 mH and 20 V/A · 3.6 Ω / 51 mH; or as given.
    #[test]
    fn each_axis_has_its_own_integral_gain() {
        let k_p = Dq { d: 10.0, q: 20.0 };
        let k_i = Gains::cancelling(&MOTOR, k_p).k_i;
        assert!((k_i.d / 1000.0 - 1.0).abs() < 1e-15 && (k_i.q / (72.0 / 0.051) - 1.0).abs() < 1e-15, "{k_i:?}");
        let given = Gains::with_integral_times(k_p, Dq { d: 0.5, q: 0.25 });
        assert_eq!(given, Gains { k_p, k_i: Dq { d: 20.0, q: 80.0 } });
        let k_p = Gains::from_bandwidth(&MOTOR, 1_000.0).k_p;
        assert!((k_p.d / 36.0 - 1.0).abs() < 1e-15 && (k_p.q / 51.0 - 1.0).abs() < 1e-15, "{k_p:?}");
    }

    /// Oracle: by hand. 3-4-5: −3 A in d leave 4 of 5 A, and (36 − 51) mH · −3 A add 45 mVs to the flux linkage.
    #[test]
    fn the_current_limit_is_one_of_the_vector() {
        let p = Params { d_reference: -3.0, max_current: 5.0, ..tuned(2_000.0, 300.0) };
        assert!((p.max_q_current() - 4.0).abs() < 1e-15);
        assert!((p.max_effort() - 1.5 * 3.0 * (0.545 + 0.045) * 4.0).abs() < 1e-14, "{}", p.max_effort());
        assert_eq!(p.check(), Ok(()));
        let said = |d_reference| Params { d_reference, ..p }.check().unwrap_err().to_string();
        let bound = "below the largest current and leave the motor some torque";
        assert_eq!(said(-5.0), format!("`reference of the current in d` must be {bound}, got -5"), "all of it");
        assert!(said(f64::NAN).ends_with("got NaN"));
        let far = Params { d_reference: 37.0, max_current: 100.0, ..p };
        assert!(far.check().is_err(), "0.545 V·s less 37 A · 15 mH turns the motor round");
        assert_eq!(Params { d_reference: 36.0, ..far }.check(), Ok(()));
    }

    #[test]
    fn errors_name_the_parameter() {
        let good = tuned(2_000.0, 300.0);
        assert_eq!(good.check(), Ok(()));
        let said = |p: Params| p.check().unwrap_err().to_string();
        let weak = MotorEstimate { flux_linkage: 0.0, ..MOTOR };
        assert_eq!(
            said(Params { motor: weak, ..good }),
            "`estimate of the flux linkage` must be finite and positive, got 0"
        );
        assert_eq!(said(Params { max_current: -1.0, ..good }), "`largest current` must be positive, got -1");
        assert_eq!(
            said(Params { max_voltage: f64::NAN, ..good }),
            "`voltage of the DC link` must be positive, got NaN"
        );
        assert!(Params { gains: Gains::from_bandwidth(&MOTOR, 0.0), ..good }.check().is_err());
    }

    #[test]
    fn the_voltage_meets_the_rotor_one_and_a_half_ticks_later() {
        let p = tuned(2_000.0, 1e6);
        let mut x = State::default();
        let (rotor, omega_e) = (Rotation::default().ahead(0.7), 2_000.0);
        let input = Input { reference: Dq { d: 1.0, q: 2.0 }, current: AlphaBeta::default(), rotor, omega_e };
        let computed = step(&p, &mut x, input, H).computed;
        let met = step(&p, &mut x, input, H).voltage.to_dq(rotor.ahead(1.5 * H * omega_e));
        assert!((met.d - computed.d).abs() < 1e-10 && (met.q - computed.q).abs() < 1e-10, "{met:?} {computed:?}");
    }
}
