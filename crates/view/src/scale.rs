//! Readable units: µm for a following error, mm/s for a slow axis.
use servobench_metrics::Quantity;

/// Numbers from here on have an exponent.
const MANY: f64 = 1e7;

/// Factor from SI to the displayed unit.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Scale {
    /// Shown value per SI value.
    pub(crate) factor: f64,
    /// Unit with its prefix; empty for a pure number.
    pub(crate) unit: String,
}

/// The unit `unit` of a channel for display: a product with its dot, a current or voltage that is an amplitude marked as such.
pub(crate) fn shown_unit(unit: &str, amplitude: bool) -> String {
    match unit {
        "A" | "V" if amplitude => format!("{unit}pk"),
        _ => unit.replace(' ', "·"),
    }
}

impl Scale {
    /// The unit in which `peak` (SI) is a number from a half to 500, as far as there is a prefix for it.
    pub(crate) fn for_peak(unit: &str, peak: f64) -> Self {
        let (unit, size) = Quantity::axis_unit(peak, unit);
        // 1/0.000001 computed is not always a whole number.
        let factor = 1.0 / size;
        Self { factor: if factor > 1.0 { factor.round() } else { factor }, unit }
    }

    /// A value (SI) in this unit, to `digits` significant digits, with the unit.
    pub(crate) fn show(&self, value: f64, digits: u8) -> String {
        let number = self.number(value, digits);
        if self.unit.is_empty() { number } else { format!("{number} {}", self.unit) }
    }

    /// A value (SI) in this unit, to `digits` significant digits.
    pub(crate) fn number(&self, value: f64, digits: u8) -> String {
        short(self.rounded(value, digits))
    }

    /// A value (SI) in this unit, to `digits` significant digits.
    fn rounded(&self, value: f64, digits: u8) -> f64 {
        let shown = value * self.factor;
        let places = f64::from(digits) - 1.0 - shown.abs().log10().floor();
        if !places.is_finite() {
            return shown;
        }
        // Dividing by a whole power of ten gives the nearest number to the decimal one; multiplying by 0.1 does not.
        let (shift, power) = (places.abs(), 10_f64.powf(places.abs()).round());
        if places >= 0.0 && shift <= 300.0 { (shown * power).round() / power } else { (shown / power).round() * power }
    }

    /// `name (unit)`, or the name alone for a pure number.
    pub(crate) fn title(&self, name: &str) -> String {
        if self.unit.is_empty() { name.to_owned() } else { format!("{name} ({})", self.unit) }
    }
}

/// A number as text, with an exponent if it is large: that of a diverging run has more digits than a title has space for.
pub(crate) fn short(number: f64) -> String {
    if number.abs() < MANY { number.to_string() } else { format!("{number:.2e}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn currents_and_voltages_say_when_they_are_amplitudes() {
        let shown =
            [("A", true), ("V", true), ("V", false), ("N m", false), ("m/s²", true)].map(|(u, a)| shown_unit(u, a));
        assert_eq!(shown, ["Apk", "Vpk", "V", "N·m", "m/s²"]);
    }

    #[test]
    fn the_factor_is_that_of_the_unit() {
        let scale = Scale::for_peak("m", 83e-6);
        assert!(scale.unit == "µm" && (scale.factor - 1e6).abs() < 1e-6, "{scale:?}");
        assert_eq!(Scale::for_peak("", 0.3), Scale { factor: 1.0, unit: String::new() });
    }

    #[test]
    fn values_are_rounded_to_significant_digits() {
        let show = |value, factor| Scale { factor, unit: String::new() }.show(value, 4);
        for (value, factor, shown) in [
            (18.809_04, 1.0, "18.81"),
            (5e-6, 1e6, "5"),
            (311.769_145, 1.0, "311.8"),
            (0.3, 1e3, "300"),
            (9_000.0, 1.0, "9000"),
            (123_456.0, 1.0, "123500"),
            (-0.012_345, 1.0, "-0.01235"),
            (0.0, 1e6, "0"),
            (2.713_4e114, 1.0, "2.71e114"),
            (-3e300, 1.0, "-3.00e300"),
        ] {
            assert_eq!(show(value, factor), shown, "{value}");
        }
        assert_eq!(Scale::for_peak("m", 408e-6).show(407.92e-6, 3), "408 µm");
    }
}
