//! Numbers as an engineer reads them: three significant digits and an SI prefix.
use std::fmt;

/// A value in SI with its unit; displays as `8.30 µm`. A precision is a number of significant
/// digits: `{:.5}` gives `8.3000 µm`. Width and alignment work as everywhere; the default alignment is to the right.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Quantity<'a> {
    /// Value (SI).
    pub value: f64,
    /// Unit symbol: `m`, `rad/s`, `N m`, `Apk`; empty for a pure number.
    pub unit: &'a str,
}

/// SI prefixes and their powers of ten.
const PREFIXES: [(&str, i32); 8] = [("p", -12), ("n", -9), ("µ", -6), ("m", -3), ("", 0), ("k", 3), ("M", 6), ("G", 9)];
const SIGNIFICANT: usize = 3;
/// Maximum number of digits that are shown to distinguish two numbers.
const MOST: usize = 7;

impl<'a> Quantity<'a> {
    /// A value (SI) with its unit.
    #[must_use]
    pub const fn new(value: f64, unit: &'a str) -> Self {
        Self { value, unit }
    }

    /// Symbol with the prefix that suits an axis up to `largest` (SI), and its size in the plain unit (SI): `mm` and
    /// 0.001 for 0.25 m. The largest number at the axis is from a half to 500.
    #[must_use]
    pub fn axis_unit(largest: f64, unit: &str) -> (String, f64) {
        let symbol = unit.replace(' ', "·");
        let exponent = format!("{:.2e}", 2.0 * largest).split_once('e').and_then(|(_, e)| e.parse().ok());
        match exponent.and_then(|exponent| prefix(unit, exponent)) {
            Some((prefix, power)) if largest != 0.0 && largest.is_finite() => {
                (format!("{prefix}{symbol}"), format!("1e{power}").parse().unwrap_or(1.0))
            }
            _ => (symbol, 1.0),
        }
    }

    /// Number of significant digits, from three to seven, that show two numbers apart by two units or more in the last digit.
    #[must_use]
    pub fn digits_apart(one: f64, two: f64) -> usize {
        let (largest, difference) = (one.abs().max(two.abs()), (one - two).abs());
        let exponent = format!("{largest:e}").split_once('e').and_then(|(_, e)| e.parse::<i32>().ok());
        let Some(exponent) = exponent.filter(|_| difference > 0.0) else { return SIGNIFICANT };
        let (mut digits, mut last) = (SIGNIFICANT, 10_f64.powi(exponent - 2));
        while digits < MOST && difference < 2.0 * last {
            (digits, last) = (digits + 1, last / 10.0);
        }
        digits
    }

    /// The text with the prefix of `largest` (SI), so that the numbers of a row share one; with its own when it is
    /// smaller by more than three powers of ten.
    #[must_use]
    pub fn beside(&self, largest: f64) -> String {
        let Self { value, unit } = *self;
        let exponent = |value: f64| {
            let text = format!("{value:.*e}", SIGNIFICANT - 1);
            text.split_once('e').and_then(|(mantissa, e)| Some((mantissa.to_owned(), e.parse::<i32>().ok()?)))
        };
        let (Some((mantissa, own)), Some((_, of_largest))) = (exponent(value), exponent(largest)) else {
            return self.to_string();
        };
        match prefix(unit, of_largest) {
            Some((prefix, power)) if value != 0.0 && !unit.is_empty() && own + 3 >= of_largest && own <= of_largest => {
                format!("{} {prefix}{}", shifted(&mantissa, own - power), unit.replace(' ', "·"))
            }
            _ => self.to_string(),
        }
    }

    /// The text with `digits` significant digits, at least one.
    fn text(&self, digits: usize) -> String {
        let Self { value, unit } = *self;
        let symbol = unit.replace(' ', "·");
        let space = if unit.is_empty() { "" } else { " " };
        if value == 0.0 {
            return format!("0{space}{symbol}");
        }
        // The decimal point is moved in the rounded decimals: no second rounding, and 999.9 µm is 1.00 mm.
        let scientific = format!("{value:.*e}", digits.saturating_sub(1));
        let parts = scientific.split_once('e').and_then(|(m, e)| Some((m, e.parse::<i32>().ok()?)));
        let Some((mantissa, exponent)) = parts else {
            return format!("{value}{space}{symbol}"); // infinite or not a number
        };
        let Some((prefix, power)) = prefix(unit, exponent) else {
            return format!("{scientific}{space}{symbol}");
        };
        format!("{}{space}{prefix}{symbol}", shifted(mantissa, exponent - power))
    }
}

/// Prefix for a number of the decimal order `exponent`, `None` where scientific notation reads better.
fn prefix(unit: &str, exponent: i32) -> Option<(&'static str, i32)> {
    let first = unit.split(['/', ' ', '·']).next().unwrap_or_default();
    let (lowest, highest) = match first {
        "" | "1" => return (-4..6).contains(&exponent).then_some(("", 0)),
        // A prefix on a power or on the kilogram would mean something else.
        _ if first.ends_with(['²', '³', '⁴']) || first == "kg" => {
            return (-4..6).contains(&exponent).then_some(("", 0));
        }
        // Kilometres of travel, kiloseconds and kiloradians are not in use.
        "m" | "s" | "rad" => (-12, 0),
        _ => (-12, 9),
    };
    let power = (exponent.div_euclid(3) * 3).min(highest);
    let readable = power >= lowest && exponent < highest + 6;
    PREFIXES.iter().copied().find(|(_, p)| readable && *p == power)
}

/// `mantissa` (one digit before the point) with the point moved right by `places`.
fn shifted(mantissa: &str, places: i32) -> String {
    let (sign, mantissa) = mantissa.strip_prefix('-').map_or(("", mantissa), |rest| ("-", rest));
    let digits: String = mantissa.chars().filter(char::is_ascii_digit).collect();
    match usize::try_from(places) {
        Ok(places) if places + 1 < digits.len() => {
            format!("{sign}{}.{}", &digits[..=places], &digits[places + 1..])
        }
        Ok(places) => format!("{sign}{digits:0<width$}", width = places + 1),
        Err(_) => {
            let zeros = usize::try_from(-1 - places).unwrap_or_default();
            format!("{sign}0.{:0<zeros$}{digits}", "")
        }
    }
}

impl fmt::Display for Quantity<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // `Formatter::pad` would cut the text at the precision.
        let text = self.text(f.precision().unwrap_or(SIGNIFICANT));
        let missing = f.width().unwrap_or(0).saturating_sub(text.chars().count());
        let before = match f.align() {
            Some(fmt::Alignment::Left) => 0,
            Some(fmt::Alignment::Center) => missing / 2,
            Some(fmt::Alignment::Right) | None => missing,
        };
        write!(f, "{:before$}{text}{:after$}", "", "", after = missing - before)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn show(value: f64, unit: &str) -> String {
        Quantity::new(value, unit).to_string()
    }

    #[test]
    fn reads_as_an_engineer_writes() {
        for (value, unit, text) in [
            (8.3e-6, "m", "8.30 µm"),
            (-0.8141e-3, "m", "-814 µm"),
            (6.3e-9, "m", "6.30 nm"),
            (1.3, "s", "1.30 s"),
            (0.05, "s", "50.0 ms"),
            (0.0, "m", "0 m"),
            (-0.0, "m", "0 m"),
            (12.345, "N m", "12.3 N·m"),
            (0.012345, "N m", "12.3 mN·m"),
            (2346.0, "N", "2.35 kN"),
            (1350.0, "m", "1350 m"),
            (4.2, "Apk", "4.20 Apk"),
            (84.22, "Hz", "84.2 Hz"),
            (16e3, "Hz", "16.0 kHz"),
            (5.0, "m/s²", "5.00 m/s²"),
            (0.005, "kg·m²", "0.00500 kg·m²"),
            (0.998, "", "0.998"),
            (0.00169, "", "0.00169"),
            (1.2e-7, "", "1.20e-7"),
            (1e-16, "m", "1.00e-16 m"),
            (3e9, "m", "3.00e9 m"),
            (f64::INFINITY, "m", "inf m"),
        ] {
            assert_eq!(show(value, unit), text);
        }
    }

    #[test]
    fn rounding_up_takes_the_next_prefix() {
        assert_eq!(show(999.96e-6, "m"), "1.00 mm");
        assert_eq!(show(0.9996, "s"), "1.00 s");
        assert_eq!(show(99.96e-6, "m"), "100 µm");
    }

    #[test]
    fn an_axis_has_one_prefix() {
        assert_eq!(Quantity::axis_unit(0.25, "m"), ("mm".into(), 1e-3));
        assert_eq!(Quantity::axis_unit(0.499, "m"), ("mm".into(), 1e-3));
        assert_eq!(Quantity::axis_unit(0.5, "m"), ("m".into(), 1.0));
        assert_eq!(Quantity::axis_unit(-0.24e-6, "m"), ("nm".into(), 1e-9));
        assert_eq!(Quantity::axis_unit(25e3, "N"), ("kN".into(), 1e3));
        assert_eq!(Quantity::axis_unit(0.999_99, "m/s"), ("m/s".into(), 1.0));
        assert_eq!(Quantity::axis_unit(1000.0, "m/s⁴"), ("m/s⁴".into(), 1.0));
        assert_eq!(Quantity::axis_unit(0.0, "N m"), ("N·m".into(), 1.0));
    }

    #[test]
    fn digits_show_a_miss_however_small() {
        for (one, two, digits) in [
            (35.2e-3, 20e-3, 3),
            (39.08, 38.985, 4),
            (814e-6, 812e-6, 3),
            (0.020_000_1, 0.02, 7),
            (1.0 + 1e-9, 1.0, 7),
            (2.0, 2.0, 3),
            (0.0, 0.0, 3),
            (f64::INFINITY, 1.0, 3),
        ] {
            assert_eq!(Quantity::digits_apart(one, two), digits, "{one} {two}");
            assert_eq!(Quantity::digits_apart(two, one), digits, "{one} {two}");
        }
    }

    #[test]
    fn the_numbers_of_a_row_share_a_prefix() {
        for (value, largest, unit, text) in [
            (0.98, 1.01, "N m", "0.980 N·m"),
            (0.756, 1.71, "s", "0.756 s"),
            (0.705, 0.756, "s", "705 ms"),
            (105e-9, 1.7e-6, "m", "0.105 µm"),
            (6.3e-9, 1.7e-3, "m", "6.30 nm"),
            (-0.35e-3, 4.2e-3, "m", "-0.350 mm"),
            (0.0, 1.0, "m", "0 m"),
            (0.0064, 0.5, "", "0.00640"),
            (f64::NAN, 1.0, "m", "NaN m"),
        ] {
            assert_eq!(Quantity::new(value, unit).beside(largest), text);
        }
    }

    #[test]
    fn precision_is_significant_digits_and_width_pads() {
        let x = Quantity::new(0.8094e-3, "m");
        assert_eq!(format!("{x:.5}"), "809.40 µm");
        assert_eq!(format!("{x:>9}|{x:<9}|{x:^9}|"), "   809 µm|809 µm   | 809 µm  |");
    }

    proptest! {
        /// Read back with the prefix, the text is the value to half a unit in the third digit.
        #[test]
        fn text_means_the_value(mantissa in 1.0..10.0_f64, power in -12..9_i32, negative: bool) {
            let value = if negative { -1.0 } else { 1.0 } * mantissa * 10_f64.powi(power);
            let text = show(value, "V");
            let (number, unit) = text.split_once(' ').unwrap();
            let scale = PREFIXES.iter().find(|(p, _)| format!("{p}V") == unit).unwrap().1;
            let back = number.parse::<f64>().unwrap() * 10_f64.powi(scale);
            prop_assert!((back - value).abs() <= 0.005_000_1 * 10_f64.powi(power), "{value} {text}");
            prop_assert!((1.0..1000.0).contains(&number.parse::<f64>().unwrap().abs()));
        }
    }
}
