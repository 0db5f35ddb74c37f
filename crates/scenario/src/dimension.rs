//! Dimensions as exponents.
//!
//! Beside the SI base there are three that the SI counts as 1, because mistaking them is what goes wrong in practice:
//! the angle (rad, deg, rev), the cycle (Hz: `1 kHz` of bandwidth is 2π·1000 rad/s, `1/s` is no frequency), and whether
//! an alternating current or voltage is given by its amplitude or effective value (`Apk`, `Arms`; plain `A` is neither).
use std::fmt;

/// Exponents of metre, kilogram, second, ampere, radian, cycle and amplitude, in this order.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct Dimension([i32; 7]);

const SYMBOLS: [&str; 7] = ["m", "kg", "s", "A", "rad", "cycle", "amplitude"];

impl Dimension {
    pub(crate) const ONE: Self = Self([0; 7]);
    pub(crate) const METRE: Self = Self([1, 0, 0, 0, 0, 0, 0]);
    pub(crate) const KILOGRAM: Self = Self([0, 1, 0, 0, 0, 0, 0]);
    pub(crate) const SECOND: Self = Self([0, 0, 1, 0, 0, 0, 0]);
    pub(crate) const AMPERE: Self = Self([0, 0, 0, 1, 0, 0, 0]);
    pub(crate) const RADIAN: Self = Self([0, 0, 0, 0, 1, 0, 0]);
    pub(crate) const CYCLE: Self = Self([0, 0, 0, 0, 0, 1, 0]);
    pub(crate) const AMPLITUDE: Self = Self([0, 0, 0, 0, 0, 0, 1]);
    pub(crate) const HERTZ: Self = Self::CYCLE.times(Self::SECOND, -1);
    pub(crate) const NEWTON: Self = Self::KILOGRAM.times(Self::METRE, 1).times(Self::SECOND, -2);
    pub(crate) const NEWTON_METRE: Self = Self::NEWTON.times(Self::METRE, 1);
    pub(crate) const VOLT: Self = Self::NEWTON_METRE.times(Self::SECOND, -1).times(Self::AMPERE, -1);

    /// This dimension times `other` to the power `power`.
    pub(crate) const fn times(self, other: Self, power: i32) -> Self {
        let mut exponents = self.0;
        let mut i = 0;
        while i < exponents.len() {
            exponents[i] = exponents[i].saturating_add(other.0[i].saturating_mul(power));
            i += 1;
        }
        Self(exponents)
    }

    /// Exponents of kilogram, metre, second and ampere; angles and cycles are numbers.
    pub(crate) const fn mechanical(self) -> [i32; 4] {
        let [m, kg, s, a, ..] = self.0;
        [kg, m, s, a]
    }

    /// The dimension without any statement about amplitudes.
    pub(crate) const fn without_amplitude(self) -> Self {
        let mut exponents = self.0;
        exponents[6] = 0;
        Self(exponents)
    }
}

/// `kg·m²/s³`, the SI units that make up the dimension.
impl fmt::Display for Dimension {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let side = |sign: i32| -> Vec<String> {
            // Kilogram before metre, as everybody writes it.
            [1, 0, 2, 3, 4, 5, 6]
                .iter()
                .filter(|&&i| self.0[i].signum() == sign)
                .map(|&i| format!("{}{}", SYMBOLS[i], superscript(self.0[i].unsigned_abs())))
                .collect()
        };
        let (above, below) = (side(1), side(-1));
        let above = if above.is_empty() { "1".to_owned() } else { above.join("·") };
        match below.len() {
            0 => f.write_str(&above),
            1 => write!(f, "{above}/{}", below[0]),
            _ => write!(f, "{above}/({})", below.join("·")),
        }
    }
}

fn superscript(power: u32) -> String {
    const DIGITS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    if power == 1 {
        return String::new();
    }
    power.to_string().bytes().map(|digit| DIGITS[usize::from(digit - b'0')]).collect()
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
    }

    #[test]
    fn absurd_powers_saturate() {
        let huge = Dimension::METRE.times(Dimension::METRE, i32::MAX);
        assert_eq!(huge.times(huge, 2), huge);
    }
}
