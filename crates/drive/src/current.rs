//! Current control in the rotor frame: PI per axis, cross-coupling and back-EMF decoupled, vector voltage limit.
//!
//! ```text
//! e = i_ref − i           v = k_p·e + I + decoupling      u = limit(v)
//! decoupling_d = −ω·L_q·i_q      decoupling_q = ω·(L_d·i_d + ψ)
//! dI/dt = k_i·(e + (u − v)/k_p)                           (forward Euler, step h)
//! ```
//! With k_p = α·L and k_i = α·R the loop closes like 1/(1 + s/α) (Harnefors & Nee, IEEE TIA 34(1), 1998); a ramp is
//! followed 1/α late, whatever the dead time in the loop. The voltage limit gives the d axis first call.
//!
//! The voltage computed at tick k is applied from k+1 to k+2: it is turned ahead by 1.5·h·ω to meet the rotor there.
use servobench_base::{AlphaBeta, Dq, ParamError, Rotation, positive};

/// The motor as the firmware knows it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MotorEstimate {
    /// Pole pairs.
    pub pole_pairs: f64,
    /// Stator resistance, phase to neutral (Ω).
    pub resistance: f64,
    /// Inductances (H).
    pub inductance: Dq,
    /// Flux linkage, peak (V·s).
    pub flux_linkage: f64,
}

/// Gains and limits; constant during a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Params {
    /// The motor.
    pub motor: MotorEstimate,
    /// Proportional gains (V/A).
    pub k_p: Dq,
    /// Integral gains (V/(A·s)).
    pub k_i: Dq,
    /// Largest voltage amplitude (V).
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
    /// Torque per q-axis current at i_d = 0 (N·m/A, peak).
    #[must_use]
    pub fn torque_constant(&self) -> f64 {
        1.5 * self.pole_pairs * self.flux_linkage
    }
}

impl Params {
    /// Gains for the closed-loop bandwidth `alpha` (rad/s).
    ///
    /// # Errors
    /// [`ParamError`] names the first argument that is not finite and positive.
    pub fn from_bandwidth(motor: MotorEstimate, alpha: f64, max_voltage: f64) -> Result<Self, ParamError> {
        positive("drive.current.bandwidth", alpha)?;
        positive("drive.estimate.motor.resistance", motor.resistance)?;
        positive("drive.estimate.motor.inductance_d", motor.inductance.d)?;
        positive("drive.estimate.motor.inductance_q", motor.inductance.q)?;
        if max_voltage.is_nan() || max_voltage <= 0.0 {
            return Err(ParamError { name: "drive.dc_link", value: max_voltage, bound: "positive" });
        }
        let k_p = Dq { d: alpha * motor.inductance.d, q: alpha * motor.inductance.q };
        let k_i = Dq { d: alpha * motor.resistance, q: alpha * motor.resistance };
        Ok(Self { motor, k_p, k_i, max_voltage })
    }
}

/// Returns the voltage for tick k, then advances `x` by `h` (s) to tick k+1.
pub fn step(p: &Params, x: &mut State, u: Input, h: f64) -> Output {
    let i = u.current.to_dq(u.rotor);
    let e = Dq { d: u.reference.d - i.d, q: u.reference.q - i.q };
    let motor = &p.motor;
    let v = Dq {
        d: p.k_p.d * e.d + x.integral.d - u.omega_e * motor.inductance.q * i.q,
        q: p.k_p.q * e.q + x.integral.q + u.omega_e * (motor.inductance.d * i.d + motor.flux_linkage),
    };
    let computed = limit_d_first(v, p.max_voltage);
    let saturated = computed != v;
    let windup =
        if saturated { Dq { d: (v.d - computed.d) / p.k_p.d, q: (v.q - computed.q) / p.k_p.q } } else { Dq::default() };
    x.integral.d += h * p.k_i.d * (e.d - windup.d);
    x.integral.q += h * p.k_i.q * (e.q - windup.q);
    let voltage = core::mem::replace(&mut x.pending, computed.to_alpha_beta(u.rotor.ahead(1.5 * h * u.omega_e)));
    Output { voltage, current: i, computed, saturated }
}

/// Cuts `v` to the circle of radius `max`; d keeps what it asks for as long as the circle allows.
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

    const MOTOR: MotorEstimate =
        MotorEstimate { pole_pairs: 3.0, resistance: 3.6, inductance: Dq { d: 36e-3, q: 51e-3 }, flux_linkage: 0.545 };
    const H: f64 = 1.0 / 16_000.0;

    /// Drives an R–L load at standstill, where each axis is exactly i(k+1) = a·i + (1 − a)/R·u.
    fn ramp_lag(alpha: f64) -> f64 {
        let p = Params::from_bandwidth(MOTOR, alpha, 1e6).unwrap();
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

    /// Oracle: with back-calculation the integrator of a saturated axis comes to rest where v is k_p·(e_sat) above u,
    /// so it cannot wind up: it stays bounded by u + k_p·|e|.
    #[test]
    fn the_integrator_does_not_wind_up() {
        let p = Params::from_bandwidth(MOTOR, 2_000.0, 300.0).unwrap();
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
        assert!(x.integral.q.abs() <= 300.0 + p.k_p.q * 100.0, "{:?}", x.integral);
    }

    #[test]
    fn the_voltage_meets_the_rotor_one_and_a_half_ticks_later() {
        let p = Params::from_bandwidth(MOTOR, 2_000.0, 1e6).unwrap();
        let mut x = State::default();
        let (rotor, omega_e) = (Rotation::default().ahead(0.7), 2_000.0);
        let input = Input { reference: Dq { d: 1.0, q: 2.0 }, current: AlphaBeta::default(), rotor, omega_e };
        let computed = step(&p, &mut x, input, H).computed;
        let met = step(&p, &mut x, input, H).voltage.to_dq(rotor.ahead(1.5 * H * omega_e));
        assert!((met.d - computed.d).abs() < 1e-10 && (met.q - computed.q).abs() < 1e-10, "{met:?} {computed:?}");
    }
}
