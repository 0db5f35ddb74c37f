//! Conversions of a factor group.
use core::f64::consts::TAU;

use super::ratio::product;
use super::{Ratio, UnitError};

/// Conversions between increments of the encoder and the units of the axis, by [`FactorGroup::scaling`](super::FactorGroup::scaling).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Scaling {
    pub(super) position_per_increment: Ratio,
    pub(super) velocity_per_increment: Ratio,
    /// Length in metres or revolutions.
    pub(super) length_per_increment: Ratio,
    pub(super) radians: bool,
    pub(super) position_inverted: bool,
    pub(super) velocity_inverted: bool,
}

impl Scaling {
    /// Increments of the encoder at a position in user-defined units, such as the target position (607Ah).
    ///
    /// # Errors
    /// [`UnitError::CountOverflow`] beyond 127 bits, here and in every conversion of counts.
    pub fn increments(&self, position: i128) -> Result<i128, UnitError> {
        self.position_per_increment.inverse().of(signed(position, self.position_inverted)?)
    }

    /// Position in user-defined units at a number of increments.
    ///
    /// # Errors
    /// As [`increments`](Self::increments).
    pub fn position(&self, increments: i128) -> Result<i128, UnitError> {
        self.position_per_increment.of(signed(increments, self.position_inverted)?)
    }

    /// Increments per second at a velocity in user-defined units, such as the target velocity (60FFh).
    ///
    /// # Errors
    /// As [`increments`](Self::increments).
    pub fn increments_per_second(&self, velocity: i128) -> Result<i128, UnitError> {
        self.velocity_per_increment.inverse().of(signed(velocity, self.velocity_inverted)?)
    }

    /// Velocity in user-defined units at a number of increments per second.
    ///
    /// # Errors
    /// As [`increments`](Self::increments).
    pub fn velocity(&self, increments_per_second: i128) -> Result<i128, UnitError> {
        self.velocity_per_increment.of(signed(increments_per_second, self.velocity_inverted)?)
    }

    /// Position of the axis (m or rad): metres are rounded once, radians once more by the factor 2π.
    ///
    /// # Errors
    /// As [`increments`](Self::increments).
    pub fn metres_or_radians(&self, increments: i128) -> Result<f64, UnitError> {
        let length = self.length_per_increment.of_as_f64(signed(increments, self.position_inverted)?)?;
        Ok(if self.radians { length * TAU } else { length })
    }

    /// Increments nearest to a position of the axis (m or rad); radians are divided by 2π first.
    ///
    /// # Errors
    /// [`UnitError::NotCountable`] if the position is not finite or beyond 2⁶³ increments.
    pub fn increments_at(&self, metres_or_radians: f64) -> Result<i128, UnitError> {
        let length = if self.radians { metres_or_radians / TAU } else { metres_or_radians };
        let circumference = if self.radians { TAU } else { 1.0 };
        let ratio = self.length_per_increment;
        let furthest = i128::from(i64::MAX);
        ratio
            .inverse()
            .of_f64(if self.position_inverted { -length } else { length })
            .filter(|counts| counts.abs() <= furthest)
            .ok_or(UnitError::NotCountable {
                name: "position",
                value: metres_or_radians,
                highest: furthest as f64 * circumference * ratio.numerator() as f64 / ratio.denominator() as f64,
            })
    }
}

/// Value with the sign of the polarity.
fn signed(value: i128, inverted: bool) -> Result<i128, UnitError> {
    if inverted { product(value, -1) } else { Ok(value) }
}
