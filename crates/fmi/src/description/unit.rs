//! Units, defined by the FMU itself as exponents of the SI base units.
//!
//! ```text
//! SI value      = factor·value + offset            (BaseUnit; without the offset for a difference, `relativeQuantity`)
//! display value = factor·value + offset            (DisplayUnit)
//!               = factor/value + offset            (DisplayUnit, `inverse`)
//! ```
//! Source: FMI 3.0.2, §2.4.4 (`UnitDefinitions`); FMI 2.0.5, §2.2.2.

/// Exponents of the SI base units and the radian.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct Exponents {
    /// Exponent of the kilogram.
    pub kg: i32,
    /// Exponent of the metre.
    pub m: i32,
    /// Exponent of the second.
    pub s: i32,
    /// Exponent of the ampere.
    pub a: i32,
    /// Exponent of the kelvin.
    pub k: i32,
    /// Exponent of the mole.
    pub mol: i32,
    /// Exponent of the candela.
    pub cd: i32,
    /// Exponent of the radian, which the standard counts.
    pub rad: i32,
}

/// Conversion of a variable's values to SI.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BaseUnit {
    /// Its dimension.
    pub exponents: Exponents,
    /// SI units per unit; finite, not zero.
    pub factor: f64,
    /// SI value of its zero; finite.
    pub offset: f64,
}

impl BaseUnit {
    /// The SI value of `value` of this unit; a difference of two values if `is_relative`.
    #[must_use]
    pub fn to_si(&self, value: f64, is_relative: bool) -> f64 {
        self.factor * value + if is_relative { 0.0 } else { self.offset }
    }

    /// The value of this unit that is `si`; a difference of two values if `is_relative`.
    #[must_use]
    pub fn from_si(&self, si: f64, is_relative: bool) -> f64 {
        (si - if is_relative { 0.0 } else { self.offset }) / self.factor
    }
}

/// A unit for display.
#[derive(Debug, Clone, PartialEq)]
pub struct DisplayUnit {
    /// Its name.
    pub name: String,
    /// Display units per unit; finite, not zero.
    pub factor: f64,
    /// Display value of the unit's zero; finite.
    pub offset: f64,
    /// True if the display value falls as the value rises (FMI 3.0).
    pub inverse: bool,
}

impl DisplayUnit {
    /// Display value of `value` of the unit; a difference of two values if `is_relative`.
    #[must_use]
    pub fn shown(&self, value: f64, is_relative: bool) -> f64 {
        let scaled = if self.inverse { self.factor / value } else { self.factor * value };
        scaled + if is_relative { 0.0 } else { self.offset }
    }
}

/// A unit of an FMU.
#[derive(Debug, Clone, PartialEq)]
pub struct Unit {
    /// Its name, which variables refer to.
    pub name: String,
    /// Conversion to SI; optional in an FMU.
    pub base: Option<BaseUnit>,
    /// Units for display.
    pub display: Vec<DisplayUnit>,
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: 0 °C is 273.15 K, water boils 100 K above; 1 rpm is 2π/60 rad/s. Tolerance: one rounding each way.
    #[test]
    fn temperatures_have_an_offset_and_their_differences_none() {
        let exponents = Exponents { k: 1, ..Exponents::default() };
        let celsius = BaseUnit { exponents, factor: 1.0, offset: 273.15 };
        assert!((celsius.to_si(100.0, false) - 373.15).abs() < 1e-13);
        assert!((celsius.to_si(100.0, true) - 100.0).abs() < 1e-13);
        assert!((celsius.from_si(celsius.to_si(21.5, false), false) - 21.5).abs() < 1e-13);
        let rpm = BaseUnit { exponents, factor: std::f64::consts::TAU / 60.0, offset: 0.0 };
        assert!((rpm.from_si(std::f64::consts::TAU, false) - 60.0).abs() < 1e-14);
    }

    /// Oracle: 5 L/100 km are 20 km/L, the example of the standard.
    #[test]
    fn an_inverse_display_unit_divides() {
        let unit = DisplayUnit { name: "L/100 km".into(), factor: 100.0, offset: 0.0, inverse: true };
        assert!((unit.shown(20.0, false) - 5.0).abs() < 1e-15);
    }
}
