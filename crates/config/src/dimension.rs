//! Dimensions as exponents.
//!
//! Beside the SI base there are some dimensions that the SI counts as 1, because confusing them is the usual mistake in practice:
//! the angle (rad, deg, rev), the cycle (Hz: `1 kHz` of bandwidth is 2π·1000 rad/s, `1/s` is not a frequency), the amplitude of an
//! alternating current or voltage as opposed to its effective value (`Apk`, `Arms`; plain `A` is neither), and the zero of a
//! temperature scale as opposed to a difference in kelvin (`K`, `degC`).
use core::fmt;

/// Exponents of metre, kilogram, second, ampere, radian, cycle, amplitude, kelvin and zero of the temperature scale, in this order.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Dimension([i32; 9]);

const SYMBOLS: [&str; 9] = ["m", "kg", "s", "A", "rad", "cycle", "amplitude", "K", "above 0 °C"];

impl Dimension {
    /// A pure number.
    pub const ONE: Self = Self([0; 9]);
    /// Metre.
    pub const METRE: Self = Self([1, 0, 0, 0, 0, 0, 0, 0, 0]);
    /// Kilogram.
    pub const KILOGRAM: Self = Self([0, 1, 0, 0, 0, 0, 0, 0, 0]);
    /// Second.
    pub const SECOND: Self = Self([0, 0, 1, 0, 0, 0, 0, 0, 0]);
    /// Ampere.
    pub const AMPERE: Self = Self([0, 0, 0, 1, 0, 0, 0, 0, 0]);
    /// Radian.
    pub const RADIAN: Self = Self([0, 0, 0, 0, 1, 0, 0, 0, 0]);
    /// A cycle of a periodic quantity.
    pub const CYCLE: Self = Self([0, 0, 0, 0, 0, 1, 0, 0, 0]);
    /// Mark of a voltage or current given by its amplitude.
    pub const AMPLITUDE: Self = Self([0, 0, 0, 0, 0, 0, 1, 0, 0]);
    /// Kelvin.
    pub const KELVIN: Self = Self([0, 0, 0, 0, 0, 0, 0, 1, 0]);
    /// Degrees Celsius: kelvin above the zero of that scale, not a temperature difference.
    pub const CELSIUS: Self = Self([0, 0, 0, 0, 0, 0, 0, 1, 1]);
    /// Cycles per second.
    pub const HERTZ: Self = Self::CYCLE.times(Self::SECOND, -1);
    /// Newton.
    pub const NEWTON: Self = Self::KILOGRAM.times(Self::METRE, 1).times(Self::SECOND, -2);
    /// Newton metre.
    pub const NEWTON_METRE: Self = Self::NEWTON.times(Self::METRE, 1);
    /// Volt.
    pub const VOLT: Self = Self::NEWTON_METRE.times(Self::SECOND, -1).times(Self::AMPERE, -1);

    /// This dimension times `other` to the power `power`.
    #[must_use]
    pub const fn times(self, other: Self, power: i32) -> Self {
        let mut exponents = self.0;
        let mut i = 0;
        while i < exponents.len() {
            exponents[i] = exponents[i].saturating_add(other.0[i].saturating_mul(power));
            i += 1;
        }
        Self(exponents)
    }

    /// Exponents of kilogram, metre, second and ampere; angles and cycles are numbers.
    #[must_use]
    pub const fn mechanical(self) -> [i32; 4] {
        let [m, kg, s, a, ..] = self.0;
        [kg, m, s, a]
    }

    /// The dimension without the mark of amplitudes.
    #[must_use]
    pub const fn without_amplitude(self) -> Self {
        let mut exponents = self.0;
        exponents[6] = 0;
        Self(exponents)
    }
}

/// The SI units of the dimension: `kg·m²/s³`.
impl fmt::Display for Dimension {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let number = |sign: i32| self.0.iter().filter(|exponent| exponent.signum() == sign).count();
        match number(1) {
            0 => f.write_str("1")?,
            _ => self.product(1, f)?,
        }
        match number(-1) {
            0 => Ok(()),
            1 => {
                f.write_str("/")?;
                self.product(-1, f)
            }
            _ => {
                f.write_str("/(")?;
                self.product(-1, f)?;
                f.write_str(")")
            }
        }
    }
}

impl Dimension {
    /// Product of the units whose exponents have this sign.
    fn product(self, sign: i32, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut is_first = true;
        // Kilogram before metre, as is usual.
        for i in [1, 0, 2, 3, 4, 5, 6, 7, 8] {
            if self.0[i].signum() == sign {
                f.write_str(if is_first { "" } else { "·" })?;
                f.write_str(SYMBOLS[i])?;
                superscript(self.0[i].unsigned_abs(), f)?;
                is_first = false;
            }
        }
        Ok(())
    }
}

/// A power as superscript; empty for 1.
fn superscript(power: u32, f: &mut fmt::Formatter<'_>) -> fmt::Result {
    const DIGITS: [&str; 10] = ["⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"];
    if power == 1 {
        return Ok(());
    }
    for place in (0..=power.checked_ilog10().unwrap_or(0)).rev() {
        f.write_str(DIGITS[(power / 10_u32.pow(place) % 10) as usize])?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shows_as_units() {
        assert_eq!(Dimension::NEWTON.to_string(), "kg·m/s²");
        assert_eq!(Dimension::VOLT.to_string(), "kg·m²/(s³·A)");
        assert_eq!(Dimension::ONE.to_string(), "1");
        assert_eq!(Dimension::ONE.times(Dimension::SECOND, -1).to_string(), "1/s");
        assert_eq!(Dimension::METRE.times(Dimension::METRE, 11).to_string(), "m¹²");
        assert_eq!(Dimension::ONE.times(Dimension::SECOND, i32::MAX).to_string(), "s²¹⁴⁷⁴⁸³⁶⁴⁷");
    }

    #[test]
    fn absurd_powers_saturate() {
        let huge = Dimension::METRE.times(Dimension::METRE, i32::MAX);
        assert_eq!(huge.times(huge, 2), huge);
    }
}
