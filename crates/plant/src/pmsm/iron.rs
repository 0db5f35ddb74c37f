//! Loss in the iron: the field turns through it, which brakes the rotor.
//!
//! ```text
//! P = (P_h·|v|/v_n·s + P_e·(v/v_n)²)·(λ/ψ)²         λ² = (L_d·i_d + ψ)² + (L_q·i_q)²
//! drag = P/v                                        s = |v|/√(v² + (v_n/100)²)
//! ```
//! P_h hysteresis and P_e eddy currents at the speed v_n without current. Steinmetz with the exponent 2 of the flux: Krishnan, *Permanent
//! Magnet Synchronous and Brushless DC Motor Drives*, 2010. As a drag the loss costs torque and not current:
//! the effect on the currents of a resistance parallel to the inductances is left out.
//!
//! s takes the hysteresis torque through zero: below a hundredth of v_n it falls instead of holding the rotor, since the iron has then
//! not passed a whole loop (assumed: data sheets do not give the part). Friction holds a rotor at rest.
use super::{FluxMap, Params, State};
use servobench_base::{Dq, ParamError};
use servobench_config::Kind::{Motor, Plain};
use servobench_config::quantities::{POWER, VELOCITY};
use servobench_config::{not_negative, positive};

servobench_config::parameters! {
    /// A parameter of the iron loss.
    pub enum IronLossParameter {
        /// Speed of the motor at which the losses are given
        SPEED "speed of the iron loss" = positive(Motor(&VELOCITY), "3000 rpm");
        /// Loss by hysteresis at that speed without current: it grows with the speed
        HYSTERESIS "hysteresis loss" = not_negative(Plain(&POWER), "6 W");
        /// Loss by eddy currents at that speed without current: it grows with the square of the speed
        EDDY "eddy-current loss" = not_negative(Plain(&POWER), "10 W");
    }
}

/// Loss in the iron of a motor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct IronLoss {
    /// Speed at which the losses are given (motor coordinate).
    pub speed: f64,
    /// By hysteresis, without current (W).
    pub hysteresis: f64,
    /// By eddy currents, without current (W).
    pub eddy: f64,
}

/// Share of the given speed below which the hysteresis torque falls.
const SMOOTHED: f64 = 0.01;

impl IronLoss {
    /// # Errors
    /// [`ParamError`] names the first parameter that is out of its bound.
    pub fn check(&self) -> Result<(), ParamError> {
        IronLossParameter::SPEED.check_in_words(self.speed)?;
        IronLossParameter::HYSTERESIS.check_in_words(self.hysteresis)?;
        IronLossParameter::EDDY.check_in_words(self.eddy)?;
        Ok(())
    }

    /// Drag (N·m or N) at `speed` with `flux` times the square of the magnets' flux linkage; against the motion.
    #[must_use]
    pub fn drag(&self, speed: f64, flux: f64) -> f64 {
        let part = speed / self.speed;
        let hysteresis = self.hysteresis * part / libm::sqrt(part * part + SMOOTHED * SMOOTHED);
        flux * (hysteresis + self.eddy * part) / self.speed
    }
}

/// Square of the flux linkage of stator and magnets relative to that of the magnets by the data sheet, ψ (V·s).
pub(super) fn relative_flux(p: &Params, psi: f64, map: Option<&FluxMap>, [before, after]: [State; 2]) -> f64 {
    let [d, q] = [before.current.d + after.current.d, before.current.q + after.current.q].map(|sum| sum / 2.0);
    let (along, across) = if let Some(map) = map {
        let flux = map.flux(Dq { d, q });
        ((p.flux_linkage - psi + flux.d) / psi, flux.q / psi)
    } else {
        ((p.flux_linkage + p.inductance.d * d) / psi, p.inductance.q * q / psi)
    };
    along * along + across * across
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: the losses as they are given, at the given speed, at half of it and against it; s leaves out 5e-5 of the hysteresis loss at
    /// the given speed, 2e-4 at half of it.
    #[test]
    fn the_loss_is_the_given_one() {
        let iron = IronLoss { speed: 314.0, hysteresis: 6.0, eddy: 10.0 };
        for (share, expected) in [(1.0, 16.0), (0.5, 3.0 + 2.5), (-0.5, 3.0 + 2.5), (-1.7, 10.2 + 28.9)] {
            let speed = share * 314.0;
            let loss = iron.drag(speed, 1.0) * speed;
            assert!((loss - expected).abs() < 2e-4 * expected, "{share}: {loss} W");
            assert!((iron.drag(speed, 1.3) * speed - 1.3 * loss).abs() < 1e-12, "{share}");
        }
        assert_eq!(iron.drag(0.0, 1.0).to_bits(), 0.0_f64.to_bits());
    }
}
