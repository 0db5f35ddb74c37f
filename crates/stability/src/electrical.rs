//! The synchronous motor around its operating point: the motor's own step, differentiated.
//!
//! ```text
//! (i_d, i_q)(k+1), T = E·(i_d, i_q, u_d, u_q, ω_e)
//! ```
//! The step is affine in currents and voltages, but for the torque, which is quadratic: central differences are exact to
//! rounding. In ω_e it is not, so that its difference is small: 2⁻¹⁷ rad a tick cost (2⁻¹⁷)²/6 = 1e-11 of the entry. What
//! does not act gives two times the same number, and the entry is exactly zero.
use servobench_base::{Dq, Rotation};
use servobench_plant::pmsm;

/// Rotor's angle in a tick (rad) at the speed of the difference.
const TURN: f64 = 1.0 / 131_072.0;

/// The step of a motor around its operating point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Electrical {
    /// Derivatives of (i_d, i_q, T) by i_d, i_q, u_d, u_q, ω_e.
    by: [[f64; 3]; 5],
    /// Voltage of the operating point (V).
    pub(crate) voltage: Dq,
}

impl Electrical {
    /// Around `current` at standstill, for a tick of `h` (s).
    pub(crate) fn new(motor: &pmsm::Params, current: Dq, h: f64) -> Self {
        let voltage = motor.steady_voltage(current, 0.0);
        let at = |deviation: [f64; 5]| {
            let [i_d, i_q, u_d, u_q, omega_e] = deviation;
            let mut state = pmsm::State { current: Dq { d: current.d + i_d, q: current.q + i_q } };
            let rotor = Rotation::default();
            let voltage = Dq { d: voltage.d + u_d, q: voltage.q + u_q }.to_alpha_beta(rotor);
            let torque = pmsm::step(motor, &mut state, pmsm::Input { voltage, rotor, omega_e }, h);
            [state.current.d, state.current.q, torque]
        };
        let by = std::array::from_fn(|input| {
            let size = if input == 4 { TURN / h } else { 1.0 };
            let deviation = |size: f64| std::array::from_fn(|i| if i == input { size } else { 0.0 });
            let (plus, minus) = (at(deviation(size)), at(deviation(-size)));
            std::array::from_fn(|output| (plus[output] - minus[output]) / (2.0 * size))
        });
        Self { by, voltage }
    }

    /// Currents a tick later and the mean torque over the tick.
    pub(crate) fn step(&self, current: Dq, voltage: Dq, omega_e: f64) -> (Dq, f64) {
        let inputs = [current.d, current.q, voltage.d, voltage.q, omega_e];
        let [d, q, torque] =
            std::array::from_fn(|output| self.by.iter().zip(inputs).map(|(by, input)| by[output] * input).sum());
        (Dq { d, q }, torque)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MOTOR: pmsm::Params = pmsm::Params {
        electrical_ratio: 3.0,
        resistance: 3.6,
        inductance: Dq { d: 36e-3, q: 51e-3 },
        flux_linkage: 0.545,
    };
    const H: f64 = 1.0 / 12_000.0;

    /// Mean over a tick of what decays from 1 to `after`.
    fn mean(after: f64) -> f64 {
        (1.0 - after) / -after.ln()
    }

    /// Oracle: the motor's equations at standstill: a lag of L/R in each axis, the back-EMF ψ·ω_e in q alone, 1.5·p·ψ per
    /// ampere. What does not act is exactly zero.
    #[test]
    fn without_current_the_axes_are_two_lags() {
        let motor = Electrical::new(&MOTOR, Dq::default(), H);
        let (i, torque) = motor.step(Dq { d: 1.0, q: 0.0 }, Dq::default(), 0.0);
        // Whatever rule the motor's step integrates by, of second order at least: (h·R/L)³/6 = 1e-7.
        assert!((i.d - (-H * 3.6 / 36e-3_f64).exp()).abs() < 1e-7, "{i:?}");
        assert_eq!((i.q.to_bits(), torque.to_bits()), (0, 0));
        let (i, torque) = motor.step(Dq { d: 0.0, q: 1.0 }, Dq::default(), 0.0);
        let lag = (-H * 3.6 / 51e-3_f64).exp();
        assert!((i.q - lag).abs() < 1e-7 && i.d.to_bits() == 0, "{i:?}");
        assert!((torque - 1.5 * 3.0 * 0.545 * mean(i.q)).abs() < 1e-12, "{torque}");
        let (emf, _) = motor.step(Dq::default(), Dq::default(), 1.0);
        let (voltage, _) = motor.step(Dq::default(), Dq { d: 0.0, q: -0.545 }, 0.0);
        assert!((emf.q / voltage.q - 1.0).abs() < 1e-10 && emf.d.to_bits() == 0, "{emf:?} {voltage:?}");
    }

    /// Oracle: the torque's equation differentiated: 1.5·p·(ψ + (L_d − L_q)·i_d) per ampere of q, 1.5·p·(L_d − L_q)·i_q
    /// per ampere of d, each as the mean over the tick.
    #[test]
    fn with_current_the_reluctance_torque_counts() {
        let point = Dq { d: -2.5, q: 4.5 };
        let motor = Electrical::new(&MOTOR, point, H);
        let (lag_d, lag_q) = (
            motor.step(Dq { d: 1.0, q: 0.0 }, Dq::default(), 0.0),
            motor.step(Dq { d: 0.0, q: 1.0 }, Dq::default(), 0.0),
        );
        assert!((lag_d.1 - 4.5 * -15e-3 * 4.5 * mean(lag_d.0.d)).abs() < 1e-12, "{lag_d:?}");
        assert!((lag_q.1 - 4.5 * (0.545 + -15e-3 * -2.5) * mean(lag_q.0.q)).abs() < 1e-12, "{lag_q:?}");
        assert!((motor.voltage.d + 9.0).abs() < 1e-14 && (motor.voltage.q - 16.2).abs() < 1e-14);
    }
}
