//! The conversions of a factor group.
use core::f64::consts::TAU;

use super::ratio::{nearest, product};
use super::{Carry, Object, Ratio, UnitError};
use crate::difference::Displacement;

/// The conversions between increments of the encoder and the units of the axis, by
/// [`FactorGroup::scaling`](super::FactorGroup::scaling).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Scaling {
    pub(super) position_per_increment: Ratio,
    pub(super) velocity_per_increment: Ratio,
    /// In metres or revolutions.
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

    /// Position in user-defined units at so many increments.
    ///
    /// # Errors
    /// As [`increments`](Self::increments).
    pub fn position(&self, increments: i128) -> Result<i128, UnitError> {
        self.position_per_increment.of(signed(increments, self.position_inverted)?)
    }

    /// [`position`](Self::position) as the position actual value (6064h), a 32-bit integer.
    ///
    /// # Errors
    /// [`UnitError::OutsideObject`] if it does not fit. A [`Counter`](crate::counter::Counter) of 32 bits wraps
    /// instead.
    pub fn position_actual_value(&self, increments: i128) -> Result<i32, UnitError> {
        integer32(0x6064, "position actual value", self.position(increments)?)
    }

    /// Increments per second at a velocity in user-defined units, such as the target velocity (60FFh).
    ///
    /// # Errors
    /// As [`increments`](Self::increments).
    pub fn increments_per_second(&self, velocity: i128) -> Result<i128, UnitError> {
        self.velocity_per_increment.inverse().of(signed(velocity, self.velocity_inverted)?)
    }

    /// Velocity in user-defined units at so many increments per second.
    ///
    /// # Errors
    /// As [`increments`](Self::increments).
    pub fn velocity(&self, increments_per_second: i128) -> Result<i128, UnitError> {
        self.velocity_per_increment.of(signed(increments_per_second, self.velocity_inverted)?)
    }

    /// Velocity in user-defined units over a difference of positions: one rounding.
    ///
    /// # Errors
    /// As [`increments`](Self::increments).
    pub fn velocity_of(&self, displacement: Displacement) -> Result<i128, UnitError> {
        let ratio = self.velocity_per_increment;
        let numerator = i128::from(ratio.numerator()) * 1_000_000_000;
        let increments = signed(displacement.increments(), self.velocity_inverted)?;
        // Two factors of 63 and 64 bits: no overflow.
        let denominator = i128::from(ratio.denominator()) * i128::from(displacement.nanoseconds());
        Ok(nearest(product(increments, numerator)?, denominator))
    }

    /// [`velocity_of`](Self::velocity_of) as the velocity actual value (606Ch), a 32-bit integer.
    ///
    /// # Errors
    /// [`UnitError::OutsideObject`] if it does not fit.
    pub fn velocity_actual_value(&self, displacement: Displacement) -> Result<i32, UnitError> {
        integer32(0x606c, "velocity actual value", self.velocity_of(displacement)?)
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

    /// Converts steps of a set-point in user-defined units into increments, remainders carried.
    #[must_use]
    pub const fn increments_carry(&self) -> Carry {
        Carry::new(self.position_per_increment.inverse()).inverted(self.position_inverted)
    }

    /// Converts increments into steps in user-defined units, remainders carried.
    #[must_use]
    pub const fn position_carry(&self) -> Carry {
        Carry::new(self.position_per_increment).inverted(self.position_inverted)
    }
}

/// The value with the sign of the polarity.
fn signed(value: i128, inverted: bool) -> Result<i128, UnitError> {
    if inverted { product(value, -1) } else { Ok(value) }
}

fn integer32(index: u16, name: &'static str, value: i128) -> Result<i32, UnitError> {
    i32::try_from(value).map_err(|_| UnitError::OutsideObject {
        object: Object { index, subindex: 0 },
        name,
        value,
        lowest: i32::MIN.into(),
        highest: i32::MAX.into(),
    })
}
