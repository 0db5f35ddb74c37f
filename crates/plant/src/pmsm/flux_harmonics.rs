//! Harmonics of the magnets' flux linkage in the rotor frame: torque ripple and harmonics of the back-EMF from one function.
//!
//! ```text
//! ψ_d(θ) = ψ·(1 + Σ d_n·cos(n·θ + φ_n))      ψ_q(θ) = ψ·Σ q_n·sin(n·θ + φ_n)        θ electrical
//! e_d = ω·(ψ_d′ − ψ_q)                        e_q = ω·(ψ_q′ + ψ_d)
//! T = 3/2·p·((ψ_d + ψ_q′)·i_q + (ψ_d′ − ψ_q)·i_d + (L_d − L_q)·i_d·i_q)
//! ```
//! The torque is the derivative of the co-energy by the angle at constant current, so that 3/2·(e_d·i_d + e_q·i_q) and the torque at its
//! speed are one power. Harmonics of orders 5 and 7 of a phase make order 6 in dq, 11 and 13 order 12; a phase flux of order 5 with the
//! amplitude a₅ and of order 7 with a₇ is d₆ = a₅ + a₇, q₆ = a₇ − a₅. Torque from co-energy: Krause, *Analysis of Electric Machinery*, 3rd ed.,
//! ch. 1.
use servobench_base::{ParamError, Rotation};
use servobench_config::Kind::Plain;
use servobench_config::any;
use servobench_config::quantities::{PHASE, RATIO};

servobench_config::parameters! {
    /// A parameter of a harmonic of the flux linkage.
    pub enum FluxHarmonicParameter {
        /// Amplitude in the d axis, as a part of the magnets' flux linkage: ψ·d·cos(n·θ + φ)
        D "flux harmonic, d axis" = any(Plain(&RATIO), "0.004");
        /// Amplitude in the q axis: ψ·q·sin(n·θ + φ)
        Q "flux harmonic, q axis" = any(Plain(&RATIO), "-0.008");
        /// Angle φ of this harmonic at the electrical angle zero
        PHASE "flux harmonic phase" = any(Plain(&PHASE), "0 deg");
    }
}

/// One harmonic of the flux linkage.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FluxHarmonic {
    /// Its order n, per electrical revolution.
    pub order: u32,
    /// Its amplitude in the d axis, relative to the flux linkage of the magnets.
    pub d: f64,
    /// Its amplitude in the q axis, relative to the same.
    pub q: f64,
    /// Its angle at the electrical angle zero (rad).
    pub phase: f64,
}

/// Flux linkage of the magnets at an angle, and its derivatives with respect to the electrical angle (V·s).
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Flux {
    pub(super) d: f64,
    pub(super) q: f64,
    pub(super) slope_d: f64,
    pub(super) slope_q: f64,
}

impl FluxHarmonic {
    /// Highest order.
    pub const MAX_ORDER: u32 = 120;

    /// # Errors
    /// [`ParamError`] names the first parameter that is out of its bound.
    pub fn check(&self) -> Result<(), ParamError> {
        let (order, bound) = (f64::from(self.order), "from 1 to 120");
        if !(1..=Self::MAX_ORDER).contains(&self.order) {
            return Err(ParamError { name: "order of the flux harmonic", value: order, bound });
        }
        FluxHarmonicParameter::D.check_in_words(self.d)?;
        FluxHarmonicParameter::Q.check_in_words(self.q)?;
        FluxHarmonicParameter::PHASE.check_in_words(self.phase)?;
        Ok(())
    }
}

impl Flux {
    /// Flux of magnets with the flux linkage `psi` (V·s) and these harmonics, with the rotor at `rotor`.
    pub(super) fn at(psi: f64, harmonics: &[FluxHarmonic], rotor: Rotation) -> Self {
        let mut flux = Self { d: psi, q: 0.0, slope_d: 0.0, slope_q: 0.0 };
        for FluxHarmonic { order, d, q, phase } in harmonics {
            let Rotation { sin, cos } = times(rotor, *order).ahead(*phase);
            let n = f64::from(*order);
            flux.d += psi * d * cos;
            flux.slope_d -= psi * d * n * sin;
            flux.q += psi * q * sin;
            flux.slope_q += psi * q * n * cos;
        }
        flux
    }
}

/// The rotation by `n` times the angle.
fn times(rotor: Rotation, mut n: u32) -> Rotation {
    let after =
        |a: Rotation, b: Rotation| Rotation { sin: a.sin * b.cos + a.cos * b.sin, cos: a.cos * b.cos - a.sin * b.sin };
    let (mut power, mut square) = (Rotation::default(), rotor);
    while n > 0 {
        if n & 1 == 1 {
            power = after(power, square);
        }
        square = after(square, square);
        n >>= 1;
    }
    power
}

#[cfg(test)]
mod tests {
    use super::*;
    use servobench_base::ElectricalAngle;
    use std::f64::consts::TAU;

    const HARMONICS: [FluxHarmonic; 2] = [
        FluxHarmonic { order: 6, d: 0.011, q: -0.023, phase: 0.4 },
        FluxHarmonic { order: 12, d: -0.003, q: 0.007, phase: -1.3 },
    ];

    fn at(theta: f64) -> Flux {
        Flux::at(0.545, &HARMONICS, ElectricalAngle(theta).rotation())
    }

    /// Oracle: the cosines and sines themselves, and central differences over 1e-5 rad, which leave out (12·1e-5)²/6 of a slope.
    #[test]
    fn slopes_are_those_of_the_flux() {
        for theta in [-2.3, 0.0, 0.17, 1.9, 44.0] {
            let [flux, before, after] = [theta, theta - 1e-5, theta + 1e-5].map(at);
            let d = 0.545 * (1.0 + 0.011 * (6.0 * theta + 0.4_f64).cos() - 0.003 * (12.0 * theta - 1.3_f64).cos());
            let q = 0.545 * (-0.023 * (6.0 * theta + 0.4_f64).sin() + 0.007 * (12.0 * theta - 1.3_f64).sin());
            assert!((flux.d - d).abs() < 1e-13 && (flux.q - q).abs() < 1e-13, "{theta}: {flux:?} {d} {q}");
            let slopes = [(after.d - before.d) / 2e-5, (after.q - before.q) / 2e-5];
            // Rounding: 1e-16/2e-5.
            assert!((flux.slope_d - slopes[0]).abs() < 1e-9 && (flux.slope_q - slopes[1]).abs() < 1e-9, "{theta}");
        }
    }

    /// Oracle: three phases with a fundamental, a fifth and a seventh harmonic, in dq by Park's definition (2/3 of the projections).
    #[test]
    fn fifth_and_seventh_of_a_phase_are_the_sixth_in_dq() {
        let (a5, a7) = (0.013, -0.006);
        let harmonics = [FluxHarmonic { order: 6, d: a5 + a7, q: a7 - a5, phase: 0.0 }];
        for theta in [0.3, -1.7, 2.6] {
            let phase = |k: f64| {
                let x = theta - k * TAU / 3.0;
                (x, x.cos() + a5 * (5.0 * x).cos() + a7 * (7.0 * x).cos())
            };
            let phases = [0.0, 1.0, 2.0].map(phase);
            let d: f64 = phases.iter().map(|(x, flux)| 2.0 / 3.0 * flux * x.cos()).sum();
            let q: f64 = phases.iter().map(|(x, flux)| -2.0 / 3.0 * flux * x.sin()).sum();
            let flux = Flux::at(1.0, &harmonics, ElectricalAngle(theta).rotation());
            assert!((flux.d - d).abs() < 1e-14 && (flux.q - q).abs() < 1e-14, "{theta}: {flux:?} {d} {q}");
        }
    }
}
