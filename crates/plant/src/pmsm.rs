//! Permanent-magnet synchronous motor in the rotor frame.
//!
//! ```text
//! L_d·di_d/dt = u_d − R·i_d + ω·L_q·i_q
//! L_q·di_q/dt = u_q − R·i_q − ω·(L_d·i_d + ψ)        ω electrical
//! T = 3/2·p·(ψ·i_q + (L_d − L_q)·i_d·i_q)
//! ```
//! Amplitude-invariant: currents are phase peaks, R and L phase to neutral, ψ the peak flux linkage.
//! Source: Krause, *Analysis of Electric Machinery*, 3rd ed., §4.10 (PMSM in rotor reference frame).
//!
//! The inverter holds its voltage in the stator frame, so in the rotor frame it turns backwards during a tick; its mean
//! there is the vector at the middle of the tick, shortened by sinc(ωh/2). With that mean the currents take one step of
//! the trapezoidal rule, solved in closed form; the torque is the mean of both ends. Second order in the tick, stable
//! for every tick, however small L/R is, and in steady state the mean current is exact.
use servobench_base::{AlphaBeta, Dq, ParamError, Rotation, positive};

/// Parameters of the motor; constant during a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Params {
    /// Pole pairs, `p`.
    pub pole_pairs: f64,
    /// Stator resistance, phase to neutral (Ω).
    pub resistance: f64,
    /// Inductances, phase to neutral (H).
    pub inductance: Dq,
    /// Flux linkage of the magnets, peak (V·s).
    pub flux_linkage: f64,
}

/// All that a snapshot must hold.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct State {
    /// Stator current in the rotor frame (A, peak).
    pub current: Dq,
}

/// What acts on the motor from tick k to k+1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Input {
    /// Stator voltage, held over the tick (V, peak, phase to neutral).
    pub voltage: AlphaBeta,
    /// Rotor at tick k.
    pub rotor: Rotation,
    /// Mean electrical speed over the tick (rad/s).
    pub omega_e: f64,
}

impl Params {
    /// # Errors
    /// [`ParamError`] names the first parameter that is not finite and positive.
    pub fn check(&self) -> Result<(), ParamError> {
        positive("pole_pairs", self.pole_pairs)?;
        positive("resistance", self.resistance)?;
        positive("inductance_d", self.inductance.d)?;
        positive("inductance_q", self.inductance.q)?;
        positive("flux_linkage", self.flux_linkage)?;
        Ok(())
    }

    /// Torque at `current` (N·m).
    #[must_use]
    pub fn torque(&self, current: Dq) -> f64 {
        let reluctance = (self.inductance.d - self.inductance.q) * current.d;
        1.5 * self.pole_pairs * (self.flux_linkage + reluctance) * current.q
    }

    /// Voltage at which `current` stays what it is at the electrical speed `omega_e` (V).
    #[must_use]
    pub fn steady_voltage(&self, current: Dq, omega_e: f64) -> Dq {
        let Self { resistance, inductance, flux_linkage, .. } = self;
        Dq {
            d: resistance * current.d - omega_e * inductance.q * current.q,
            q: resistance * current.q + omega_e * (inductance.d * current.d + flux_linkage),
        }
    }
}

/// Advances the currents by `h` (s) to tick k+1 and returns the mean torque over the tick (N·m).
pub fn step(p: &Params, x: &mut State, u: Input, h: f64) -> f64 {
    let half = u.omega_e * h / 2.0;
    // sinc to second order: the tick's turn is far below one radian in any sane set-up, and the rest of the scheme
    // is of second order too.
    let sinc = 1.0 - half * half / 6.0;
    let middle = u.voltage.to_dq(u.rotor.ahead(half));
    let voltage = Dq { d: sinc * middle.d, q: sinc * middle.q };

    // (1 + z)·Δi = h·f(i), with f(i) = (u − u_steady(i))/L the slope at tick k and −2z/h its derivative:
    // | 1 + a_d   −b_d   |   a = h·R/2L        b_d = h·ω·L_q/2L_d
    // |   b_q   1 + a_q  |                     b_q = h·ω·L_d/2L_q
    let steady = p.steady_voltage(x.current, u.omega_e);
    let (per_d, per_q) = (h / p.inductance.d, h / p.inductance.q);
    let (force_d, force_q) = (per_d * (voltage.d - steady.d), per_q * (voltage.q - steady.q));
    let (a_d, a_q) = (1.0 + per_d * p.resistance / 2.0, 1.0 + per_q * p.resistance / 2.0);
    let (b_d, b_q) = (half * per_d / per_q, half * per_q / per_d);
    let per_determinant = 1.0 / (a_d * a_q + b_d * b_q);
    let before = p.torque(x.current);
    x.current.d += per_determinant * (a_q * force_d + b_d * force_q);
    x.current.q += per_determinant * (a_d * force_q - b_q * force_d);
    f64::midpoint(before, p.torque(x.current))
}

#[cfg(test)]
mod tests {
    use super::*;
    use servobench_base::ElectricalAngle;
    use std::f64::consts::PI;

    /// Saarakkala/Hinkkanen, 2.2 kW.
    const MOTOR: Params =
        Params { pole_pairs: 3.0, resistance: 3.6, inductance: Dq { d: 36e-3, q: 51e-3 }, flux_linkage: 0.545 };

    /// Runs at constant speed with a voltage that is constant in the rotor frame, and returns current and last torque.
    fn run(p: &Params, omega_e: f64, voltage: Dq, h: f64, ticks: u32) -> (Dq, f64) {
        let mut x = State::default();
        let mut torque = 0.0;
        for k in 0..ticks {
            let theta = ElectricalAngle(omega_e * f64::from(k) * h);
            // Held in the stator frame at the angle of the middle of the tick, as a drive with compensation does.
            let voltage = voltage.to_alpha_beta(theta.ahead(omega_e * h / 2.0).rotation());
            torque = step(p, &mut x, Input { voltage, rotor: theta.rotation(), omega_e }, h);
        }
        (x.current, torque)
    }

    /// Oracle: at standstill i(t) = u/R·(1 − e^(−t·R/L)) in each axis.
    #[test]
    fn at_standstill_each_axis_is_a_first_order_lag() {
        let h = 1.0 / 16_000.0;
        let (i, _) = run(&MOTOR, 0.0, Dq { d: 10.0, q: 20.0 }, h, 160);
        let lag = |u: f64, l: f64| u / 3.6 * (1.0 - (-0.01 * 3.6 / l).exp());
        // Trapezoidal rule with h·R/L = 6e-3: relative error (6e-3)²/12 of the time constant.
        assert!((i.d - lag(10.0, 36e-3)).abs() < 1e-5 && (i.q - lag(20.0, 51e-3)).abs() < 1e-5, "{i:?}");
    }

    /// Oracle: the Modelica Standard Library's `SM_PermanentMagnet` at 100 V, 100 A (RMS), 1500 rpm: 181.4 N·m, rotor
    /// angle 20.75°, power factor 0.98; p = 2, R = 0.03 Ω, X = 0.4 Ω at 50 Hz, E = 112.3 V RMS.
    #[test]
    fn the_modelica_machine_gives_its_published_torque() {
        let omega = 2.0 * PI * 50.0;
        let l = 0.4 / omega;
        let p = Params {
            pole_pairs: 2.0,
            resistance: 0.03,
            inductance: Dq { d: l, q: l },
            flux_linkage: 112.3 * 2.0_f64.sqrt() / omega,
        };
        let (angle, u) = (20.756_f64.to_radians(), 100.0 * 2.0_f64.sqrt());
        let voltage = Dq { d: -u * angle.sin(), q: u * angle.cos() };
        // L/R = 42 ms: after 1 s the transient is below 1e-10.
        let (i, torque) = run(&p, omega, voltage, 1.0 / 64_000.0, 64_000);
        assert!((torque - 181.44).abs() < 0.1, "published to 4 digits, the angle to 5: {torque}");
        assert!((i.magnitude() / 2.0_f64.sqrt() - 100.0).abs() < 0.1, "{i:?}");
        let power = 1.5 * (voltage.d * i.d + voltage.q * i.q);
        let factor = power / (1.5 * u * i.magnitude());
        assert!((factor - 0.98004).abs() < 2e-4, "{factor}");
    }

    /// Oracle: the steady state of the equations themselves, whatever the tick: here one of 40 time constants.
    #[test]
    fn the_steady_state_is_exact_and_stable_for_a_tick_far_beyond_the_time_constant() {
        let p = Params { inductance: Dq { d: 1e-6, q: 2e-6 }, ..MOTOR };
        let (i, _) = run(&p, 0.0, Dq { d: 10.0, q: 20.0 }, 20e-6, 2_000);
        assert!((i.d - 10.0 / 3.6).abs() < 1e-12 && (i.q - 20.0 / 3.6).abs() < 1e-12, "{i:?}");
    }

    /// A voltage held in the stator frame over h turns in the rotor frame; against a 64 times finer tick the error must
    /// fall by four when the tick is halved.
    #[test]
    fn the_tick_is_of_second_order() {
        let omega = 2.0 * PI * 200.0;
        let end = |n: u32| {
            let (h, mut x) = (2e-3 / f64::from(n), State::default());
            for k in 0..n {
                // The same staircase of voltages for every n: it changes every 125 µs.
                let t = f64::from(k) * h;
                let stair = (t / 125e-6 + 1e-9).floor() * 125e-6;
                let voltage =
                    Dq { d: 5.0, q: 90.0 + 1e4 * stair }.to_alpha_beta(ElectricalAngle(omega * stair).rotation());
                let rotor = ElectricalAngle(omega * t).rotation();
                let _ = step(&MOTOR, &mut x, Input { voltage, rotor, omega_e: omega }, h);
            }
            x.current.q
        };
        let exact = end(2048);
        let order = ((end(16) - exact) / (end(32) - exact)).log2();
        assert!((order - 2.0).abs() < 0.1, "observed order {order}");
    }
}
