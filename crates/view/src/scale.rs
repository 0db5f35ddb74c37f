//! Units a person can read: µm for a following error, mm/s for a slow axis.

/// Factor from SI to the unit that is shown.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Scale {
    /// Shown value per SI value.
    pub(crate) factor: f64,
    /// Unit with its prefix; empty for a pure number.
    pub(crate) unit: String,
}

/// Prefix and how many of the prefixed unit make one of the bare unit, smallest unit first.
const PREFIXES: [(&str, f64); 4] = [("n", 1e9), ("µ", 1e6), ("m", 1e3), ("", 1.0)];

impl Scale {
    /// The coarsest of n, µ, m and no prefix in which `peak` (SI, not negative) is at least one half; k for forces, voltages
    /// and power from 10 000 on. A pure number and a zero stay as they are.
    pub(crate) fn for_peak(unit: &str, peak: f64) -> Self {
        let scale = |(prefix, factor): (&str, f64)| Self { factor, unit: format!("{prefix}{unit}") };
        if unit.is_empty() || peak <= 0.0 || !peak.is_finite() {
            return scale(("", 1.0));
        }
        if peak >= 1e4 && ["N", "N m", "N·m", "V", "W"].contains(&unit) {
            return scale(("k", 1e-3));
        }
        let fits = |(_, factor): &&(&str, f64)| peak * factor >= 0.5;
        scale(*PREFIXES.iter().rev().find(fits).unwrap_or(&PREFIXES[0]))
    }

    /// A value (SI) in this unit, to four significant digits.
    pub(crate) fn show(&self, value: f64) -> f64 {
        let shown = value * self.factor;
        let places = 3.0 - shown.abs().log10().floor();
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

/// The largest number of 1, 2, 5, 10, 20, 50 … that is at most `value`, which is positive.
pub(crate) fn nice_below(value: f64) -> f64 {
    let decade = 10_f64.powf(value.log10().floor());
    // A value such as 0.1 may come out as 0.999… of its decade.
    let digit = value / decade * (1.0 + 1e-9);
    [10.0, 5.0, 2.0].into_iter().find(|step| digit >= *step).unwrap_or(1.0) * decade
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_peak_reads_as_a_half_to_five_hundred() {
        for (unit, peak, factor, shown) in [
            ("m", 1.0, 1.0, "m"),
            ("m", 0.25, 1e3, "mm"),
            ("m", 83e-6, 1e6, "µm"),
            ("m", 0.999, 1.0, "m"),
            ("m", 0.24e-6, 1e9, "nm"),
            ("m", 1e-13, 1e9, "nm"),
            ("rad/s", 314.0, 1.0, "rad/s"),
            ("rad", 2e-4, 1e6, "µrad"),
            ("A", 4.2, 1.0, "A"),
            ("N", 25_000.0, 1e-3, "kN"),
            ("m/s^4", 1e6, 1.0, "m/s^4"),
            ("", 0.3, 1.0, ""),
            ("m", 0.0, 1.0, "m"),
        ] {
            assert_eq!(Scale::for_peak(unit, peak), Scale { factor, unit: shown.into() }, "{peak} {unit}");
        }
    }

    #[test]
    fn four_digits_are_shown() {
        let show = |value, factor| Scale { factor, unit: String::new() }.show(value).to_string();
        for (value, factor, shown) in [
            (18.809_04, 1.0, "18.81"),
            (5e-6, 1e6, "5"),
            (311.769_145, 1.0, "311.8"),
            (0.3, 1e3, "300"),
            (9_000.0, 1.0, "9000"),
            (123_456.0, 1.0, "123500"),
            (-0.012_345, 1.0, "-0.01235"),
            (0.0, 1e6, "0"),
        ] {
            assert_eq!(show(value, factor), shown, "{value}");
        }
    }

    #[test]
    fn nice_numbers_are_1_2_and_5() {
        for (value, nice) in [(1.0, 1.0), (1.9, 1.0), (2.0, 2.0), (4.9, 2.0), (7.0, 5.0), (99.0, 50.0), (100.0, 100.0)]
        {
            assert!((nice_below(value) - nice).abs() < 1e-9 * nice, "{value}");
            assert!((nice_below(value * 1e-6) - nice * 1e-6).abs() < 1e-15 * nice, "{value} millionths");
        }
    }
}
