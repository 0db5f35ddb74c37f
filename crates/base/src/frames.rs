//! Reference frames of three-phase quantities, amplitude-invariant: a balanced set of phases of amplitude 1 has
//! |αβ| = |dq| = 1.
//!
//! ```text
//! d =  α·cos θ + β·sin θ  q = −α·sin θ + β·cos θ   (Park, θ electrical)
//! ```
//! Source: Krause, *Analysis of Electric Machinery*, 3rd ed., ch. 3 (with factor 2/3).
#![expect(clippy::inline_always, reason = "what is inlined is compiled for the registers of its caller")]
use crate::state::Stateful;

use crate::sine::sincos;

/// Electrical angle of the rotor (rad): pole pairs × mechanical angle. A separate type, because mixing the two is the classic error
/// that dimensions cannot catch.
#[derive(Debug, Clone, Copy, PartialEq, Default, Stateful)]
pub struct ElectricalAngle(pub f64);

impl ElectricalAngle {
    /// From the mechanical angle (rad) and the number of pole pairs.
    #[must_use]
    pub fn from_mechanical(theta_m: f64, pole_pairs: f64) -> Self {
        Self(pole_pairs * theta_m)
    }

    /// The angle advanced by `angle` (rad, electrical).
    #[must_use]
    pub fn ahead(self, angle: f64) -> Self {
        Self(self.0 + angle)
    }

    /// The rotation of the rotor frame at this angle.
    #[inline(always)]
    #[must_use]
    pub fn rotation(self) -> Rotation {
        let (sin, cos) = sincos(self.0);
        Rotation { sin, cos }
    }
}

/// Sine and cosine of an electrical angle: computed once, used for every transformation at that angle.
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub struct Rotation {
    /// Sine of the angle.
    pub sin: f64,
    /// Cosine of the angle.
    pub cos: f64,
}

/// An electrical angle with its rotation, for reuse at exactly the same angle: a sine costs more than a comparison.
#[derive(Debug, Clone, Copy, PartialEq, Default, Stateful)]
pub struct KnownRotation {
    angle: ElectricalAngle,
    rotation: Rotation,
}

impl KnownRotation {
    /// The angle `angle` with its rotation.
    #[inline(always)]
    #[must_use]
    pub fn of(angle: ElectricalAngle) -> Self {
        Self { angle, rotation: angle.rotation() }
    }

    /// The rotation.
    #[inline]
    #[must_use]
    pub const fn rotation(self) -> Rotation {
        self.rotation
    }

    /// The rotation at any `angle`, reused if the angle is equal.
    #[inline]
    #[must_use]
    pub fn at(self, angle: ElectricalAngle) -> Rotation {
        if angle.0.to_bits() == self.angle.0.to_bits() { self.rotation } else { angle.rotation() }
    }
}

impl Default for Rotation {
    fn default() -> Self {
        Self { sin: 0.0, cos: 1.0 }
    }
}

impl Rotation {
    /// The rotation advanced by `angle` (rad, electrical); cheapest for angles below π/4, which need no range reduction.
    #[inline(always)]
    #[must_use]
    pub fn ahead(self, angle: f64) -> Self {
        let (sin, cos) = sincos(angle);
        Self { sin: self.sin * cos + self.cos * sin, cos: self.cos * cos - self.sin * sin }
    }
}

/// Rotor frame: d along the magnet flux, q ahead of it by 90° electrical.
#[derive(Debug, Clone, Copy, PartialEq, Default, Stateful)]
pub struct Dq {
    /// Direct component.
    pub d: f64,
    /// Quadrature component.
    pub q: f64,
}

/// Stator frame: α along phase a.
#[derive(Debug, Clone, Copy, PartialEq, Default, Stateful)]
pub struct AlphaBeta {
    /// Component along phase a.
    pub alpha: f64,
    /// Component 90° ahead.
    pub beta: f64,
}

impl Dq {
    /// Transforms to the stator frame, with the rotor at `rotor`.
    #[inline]
    #[must_use]
    pub fn to_alpha_beta(self, rotor: Rotation) -> AlphaBeta {
        let Rotation { sin, cos } = rotor;
        AlphaBeta { alpha: self.d * cos - self.q * sin, beta: self.d * sin + self.q * cos }
    }

    /// Magnitude of the vector (peak value of the phase quantity).
    #[inline]
    #[must_use]
    pub fn magnitude(self) -> f64 {
        libm::sqrt(self.d * self.d + self.q * self.q)
    }
}

impl AlphaBeta {
    /// Transforms to the rotor frame, with the rotor at `rotor`.
    #[inline]
    #[must_use]
    pub fn to_dq(self, rotor: Rotation) -> Dq {
        let Rotation { sin, cos } = rotor;
        Dq { d: self.alpha * cos + self.beta * sin, q: -self.alpha * sin + self.beta * cos }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Oracle: by hand. With the rotor at 90° the d axis is β and the q axis −α.
    #[test]
    fn the_q_axis_is_ahead_of_the_d_axis() {
        let quarter = ElectricalAngle(core::f64::consts::FRAC_PI_2).rotation();
        let dq = AlphaBeta { alpha: 3.0, beta: 2.0 }.to_dq(quarter);
        assert!((dq.d - 2.0).abs() < 1e-15 * 4.0 && (dq.q + 3.0).abs() < 1e-15 * 4.0, "{dq:?}");
    }

    /// To the bit, including −0 and NaN.
    #[test]
    fn a_known_rotation_is_that_of_its_angle_alone() {
        for known in [0.0, -0.0, 0.3, 1e5, f64::NAN].map(ElectricalAngle) {
            for asked in [0.0, -0.0, 0.3, 0.300_000_000_000_000_04, 1e5, f64::NAN].map(ElectricalAngle) {
                let (found, expected) = (KnownRotation::of(known).at(asked), asked.rotation());
                assert_eq!(
                    (found.sin.to_bits(), found.cos.to_bits()),
                    (expected.sin.to_bits(), expected.cos.to_bits())
                );
            }
        }
    }

    #[test]
    fn two_turns_are_one() {
        for (first, second) in [(0.3, 0.1), (-2.0, 3.0), (100.0, -0.7)] {
            let (turned, at) =
                (ElectricalAngle(first).rotation().ahead(second), ElectricalAngle(first + second).rotation());
            // A few roundings of numbers up to one, and one of the sum of the angles.
            assert!((turned.sin - at.sin).abs() < 2e-14 && (turned.cos - at.cos).abs() < 2e-14, "{turned:?} {at:?}");
        }
    }

    proptest! {
        #[test]
        fn there_and_back_again(d in -1e3..1e3_f64, q in -1e3..1e3_f64, theta in -1e3..1e3_f64) {
            let rotor = ElectricalAngle(theta).rotation();
            let back = Dq { d, q }.to_alpha_beta(rotor).to_dq(rotor);
            // Half a dozen roundings of numbers up to 1.4e3.
            prop_assert!((back.d - d).abs() < 2e-12 && (back.q - q).abs() < 2e-12);
        }
    }
}
