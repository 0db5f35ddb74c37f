//! The objects of the factor group.
use super::{Object, Ratio, Scaling, UnitError};

/// Bit 7 of the polarity (607Eh): positions are multiplied by −1.
pub const POLARITY_POSITION: u8 = 1 << 7;
/// Bit 6 of the polarity (607Eh): velocities are multiplied by −1.
pub const POLARITY_VELOCITY: u8 = 1 << 6;
/// Bit 5 of the polarity (607Eh): torques are multiplied by −1. The standard leaves this bit reserved; Mitsubishi's MR-J5-G gives
/// it this meaning, for 6071h, 60B2h, 6074h and 6077h.
pub const POLARITY_TORQUE: u8 = 1 << 5;
/// Supported bits.
pub const POLARITY_BITS: u8 = POLARITY_POSITION | POLARITY_VELOCITY | POLARITY_TORQUE;

/// Objects as written, `[sub-index 01h, sub-index 02h]`; all ones without polarity by default.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct FactorGroup {
    /// 608Fh: encoder increments per number of motor revolutions.
    pub position_encoder_resolution: [u32; 2],
    /// 6091h: motor shaft revolutions per number of driving shaft revolutions.
    pub gear_ratio: [u32; 2],
    /// 6092h: feed (user-defined position units) per number of driving shaft revolutions.
    pub feed_constant: [u32; 2],
    /// 6096h: numerator and denominator of the user-defined velocity unit relative to position units per second, `[60, 1]` for a minute.
    pub velocity_factor: [u32; 2],
    /// 607Eh: any of [`POLARITY_POSITION`], [`POLARITY_VELOCITY`] and [`POLARITY_TORQUE`]; all three reverse the axis.
    pub polarity: u8,
}

impl Default for FactorGroup {
    fn default() -> Self {
        let one = [1, 1];
        Self {
            position_encoder_resolution: one,
            gear_ratio: one,
            feed_constant: one,
            velocity_factor: one,
            polarity: 0,
        }
    }
}

/// Length of the user-defined position unit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum AxisUnit {
    /// A linear axis: fraction of a metre, 1/1 000 000 for µm.
    Metre(Ratio),
    /// A rotary axis: fraction of a revolution, 1/360 000 for a thousandth of a degree.
    Revolution(Ratio),
}

impl FactorGroup {
    /// Conversions by these objects.
    ///
    /// # Errors
    /// [`UnitError::ZeroFactor`] if a sub-index is zero, [`UnitError::ReservedPolarity`] if the polarity has other
    /// bits, [`UnitError::RatioTooLarge`] if a product of the factors does not reduce to 63 bits.
    pub fn scaling(&self, unit: AxisUnit) -> Result<Scaling, UnitError> {
        let resolution =
            fraction(0x608f, ["encoder increments", "motor revolutions"], self.position_encoder_resolution)?;
        let gear = fraction(0x6091, ["motor shaft revolutions", "driving shaft revolutions"], self.gear_ratio)?;
        let feed = fraction(0x6092, ["feed", "driving shaft revolutions"], self.feed_constant)?;
        let factor =
            fraction(0x6096, ["velocity factor numerator", "velocity factor denominator"], self.velocity_factor)?;
        let reserved = self.polarity & !POLARITY_BITS;
        if reserved != 0 {
            return Err(UnitError::ReservedPolarity { polarity: self.polarity, reserved });
        }
        // Three factors of 32 bits: 96 bits at most.
        let position_per_increment = Ratio::reduced(
            "feed constant/(position encoder resolution·gear ratio)",
            feed[0] * resolution[1] * gear[1],
            feed[1] * resolution[0] * gear[0],
        )?;
        let velocity_factor = Ratio::reduced("velocity factor", factor[0], factor[1])?;
        let velocity_per_increment =
            position_per_increment.times(velocity_factor, "velocity per increment per second")?;
        let (AxisUnit::Metre(length) | AxisUnit::Revolution(length)) = unit;
        Ok(Scaling {
            position_per_increment,
            velocity_per_increment,
            length_per_increment: position_per_increment.times(length, "axis units per increment")?,
            radians: matches!(unit, AxisUnit::Revolution(_)),
            position_inverted: self.polarity & POLARITY_POSITION != 0,
            velocity_inverted: self.polarity & POLARITY_VELOCITY != 0,
        })
    }
}

/// Both sub-indices, checked for zero.
fn fraction(index: u16, names: [&'static str; 2], values: [u32; 2]) -> Result<[u128; 2], UnitError> {
    for (subindex, (name, value)) in (1..).zip(names.into_iter().zip(values)) {
        if value == 0 {
            return Err(UnitError::ZeroFactor { object: Object { index, subindex }, name });
        }
    }
    Ok(values.map(u128::from))
}
