//! Phases with different resistances: the star point is not connected, so that two currents are enough.
//!
//! ```text
//! R_αβ = R·[ (4·f_a + f_b + f_c)/6    (f_c − f_b)/(2·√3) ]      f = resistance of a phase over R
//!          [ (f_c − f_b)/(2·√3)       (f_b + f_c)/2      ]
//! R_dq(θ) = R·[ m + δ·cos 2θ + ε·sin 2θ      −δ·sin 2θ + ε·cos 2θ    ]
//!             [ −δ·sin 2θ + ε·cos 2θ      m − δ·cos 2θ − ε·sin 2θ    ]
//! m = (f_a + f_b + f_c)/3      δ = (2·f_a − f_b − f_c)/6      ε = (f_c − f_b)/(2·√3)
//! ```
//! 3/2·iᵀ·R·i is the sum of the losses of the three phases. The second harmonic is a current of negative sequence, and a ripple of the
//! torque with twice the electrical frequency. Source: Clarke's and Park's transformations (Krause, 3rd ed., ch. 3) of a diagonal matrix.
use servobench_base::{Dq, ParamError, Rotation};
use servobench_config::Kind::Plain;
use servobench_config::positive;
use servobench_config::quantities::RATIO;

servobench_config::parameters! {
    /// A parameter of unequal phases.
    pub enum PhaseParameter {
        /// Resistance of a phase as a part of that of the motor
        RESISTANCE "phase resistance" = positive(Plain(&RATIO), "1.02");
    }
}

const SQRT_12: f64 = 3.464_101_615_137_754_6;

/// Resistance in the rotor frame, relative to the resistance of the motor: symmetric.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct PhaseMatrix {
    mean: f64,
    difference: f64,
    skew: f64,
}

/// Its entries at an angle of the rotor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Entries {
    pub(super) dd: f64,
    pub(super) dq: f64,
    pub(super) qq: f64,
}

impl Entries {
    /// The matrix times `i`.
    pub(super) fn times(&self, i: Dq) -> Dq {
        Dq { d: self.dd * i.d + self.dq * i.q, q: self.dq * i.d + self.qq * i.q }
    }
}

/// # Errors
/// [`ParamError`] for a resistance that is not positive.
pub(super) fn check(factors: &[f64; 3]) -> Result<(), ParamError> {
    factors.iter().try_for_each(|factor| PhaseParameter::RESISTANCE.check_in_words(*factor).map(|_| ()))
}

impl PhaseMatrix {
    pub(super) const EQUAL: Self = Self { mean: 1.0, difference: 0.0, skew: 0.0 };

    pub(super) fn of([a, b, c]: [f64; 3]) -> Self {
        Self { mean: (a + b + c) / 3.0, difference: (2.0 * a - b - c) / 6.0, skew: (c - b) / SQRT_12 }
    }

    /// Largest value in any direction.
    pub(super) fn largest(&self) -> f64 {
        self.mean + libm::hypot(self.difference, self.skew)
    }

    pub(super) fn at(&self, Rotation { sin, cos }: Rotation) -> Entries {
        let (twice_sin, twice_cos) = (2.0 * sin * cos, cos * cos - sin * sin);
        let along = self.difference * twice_cos + self.skew * twice_sin;
        let across = self.skew * twice_cos - self.difference * twice_sin;
        Entries { dd: self.mean + along, dq: across, qq: self.mean - along }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use servobench_base::ElectricalAngle;

    /// Oracle: the losses of the three phases one by one, and voltages of the phases less their mean, for currents without a star point.
    #[test]
    fn the_matrix_has_the_losses_and_the_voltages_of_the_phases() {
        let factors = [1.03, 0.96, 1.21];
        for theta in [0.0, 0.7, -2.1] {
            let rotor = ElectricalAngle(theta).rotation();
            let i = Dq { d: -1.7, q: 4.3 };
            let stator = i.to_alpha_beta(rotor);
            let half = 3.0_f64.sqrt() / 2.0 * stator.beta;
            let phases = [stator.alpha, -stator.alpha / 2.0 + half, -stator.alpha / 2.0 - half];
            let Entries { dd, dq, qq } = PhaseMatrix::of(factors).at(rotor);
            let u = Dq { d: dd * i.d + dq * i.q, q: dq * i.d + qq * i.q };
            let losses: f64 = phases.iter().zip(factors).map(|(i, r)| r * i * i).sum();
            assert!((1.5 * (u.d * i.d + u.q * i.q) - losses).abs() < 1e-13 * losses, "{theta}");
            let of_phases: Vec<f64> = phases.iter().zip(factors).map(|(i, r)| r * i).collect();
            let star = of_phases.iter().sum::<f64>() / 3.0;
            let u = u.to_alpha_beta(rotor);
            // Phase a is α, the voltage between b and c is √3 times β.
            assert!((of_phases[0] - star - u.alpha).abs() < 1e-13, "{theta}");
            assert!((of_phases[1] - of_phases[2] - 3.0_f64.sqrt() * u.beta).abs() < 1e-13, "{theta}");
        }
        assert_eq!(PhaseMatrix::of([1.0; 3]), PhaseMatrix::EQUAL);
    }
}
