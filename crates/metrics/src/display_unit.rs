//! Display units of positions and their derivatives: those in which a user wrote them.
use crate::quantity::Quantity;
use std::f64::consts::PI;

/// Unit of position or of one of its derivatives.
#[derive(Debug, Clone, PartialEq)]
pub struct DisplayUnit {
    symbol: String,
    /// Size in SI units.
    si: f64,
    /// True for the SI unit, which takes the prefix that suits the number.
    takes_prefix: bool,
}

/// Non-SI units of lengths and angles, each with the beginning of the units of its derivatives. An SI unit takes
/// the prefix that suits each derivative.
const BASES: [(&str, &str, f64); 16] = [
    ("nm", "nm", 1e-9),
    ("um", "um", 1e-6),
    ("\u{b5}m", "\u{b5}m", 1e-6),
    ("\u{3bc}m", "\u{b5}m", 1e-6),
    ("mm", "mm", 1e-3),
    ("cm", "cm", 1e-2),
    ("km", "km", 1e3),
    ("mrad", "mrad", 1e-3),
    ("urad", "urad", 1e-6),
    ("deg", "deg", PI / 180.0),
    ("°", "deg", PI / 180.0),
    ("arcmin", "arcmin", PI / 10_800.0),
    ("arcsec", "arcsec", PI / 648_000.0),
    ("rev", "rev", 2.0 * PI),
    ("rpm", "rev", 2.0 * PI),
    ("krpm", "rev", 2.0 * PI),
];
/// Numbers from here on are written with a power of ten in a drawing.
const LONG: f64 = 1e6;
const POWERS: [&str; 5] = ["", "/s", "/s²", "/s³", "/s⁴"];

impl DisplayUnit {
    /// SI unit, with the prefix that suits each number, of derivative `k`, 0 to 4, of a position in `m` or `rad`.
    #[must_use]
    pub fn si(base: &str, k: usize) -> Self {
        Self { takes_prefix: true, ..Self::plain(base, k) }
    }

    /// SI unit without a prefix.
    #[must_use]
    pub fn plain(base: &str, k: usize) -> Self {
        Self { symbol: format!("{base}{}", POWERS.get(k).unwrap_or(&"")), si: 1.0, takes_prefix: false }
    }

    /// The unit in which `text` was written, whose value is `value` (SI); `None` when it begins with no number or ends
    /// without a unit, and for a value of zero.
    #[must_use]
    pub fn given(text: &str, value: f64) -> Option<Self> {
        let text = text.trim();
        let ends = text.char_indices().map(|(i, c)| i + c.len_utf8());
        let (number, end) = ends.rev().find_map(|end| Some((text[..end].trim_end().parse::<f64>().ok()?, end)))?;
        let (symbol, si) = (text[end..].trim(), value / number);
        (!symbol.is_empty() && si.is_finite() && si > 0.0).then(|| Self {
            symbol: symbol.to_owned(),
            si,
            takes_prefix: false,
        })
    }

    /// Unit of derivative `k` of the length or angle with which this unit, of another derivative, begins.
    #[must_use]
    pub fn of_derivative(&self, k: usize) -> Option<Self> {
        let begin = self.symbol.split('/').next().unwrap_or_default().trim();
        let (_, base, si) = BASES.iter().find(|(symbol, ..)| *symbol == begin)?;
        Some(Self { symbol: format!("{base}{}", POWERS.get(k)?), si: *si, takes_prefix: false })
    }

    /// The same with raised digits for the powers.
    #[must_use]
    pub fn pretty(mut self) -> Self {
        for (plain, raised) in [("s2", "s²"), ("s^2", "s²"), ("s3", "s³"), ("s^3", "s³"), ("s4", "s⁴"), ("s^4", "s⁴")]
        {
            if let Some(rest) = self.symbol.strip_suffix(plain) {
                self.symbol = format!("{rest}{raised}");
                break;
            }
        }
        self
    }

    /// Size in SI units.
    #[must_use]
    pub const fn scale(&self) -> f64 {
        self.si
    }

    /// Its symbol.
    #[must_use]
    pub fn symbol(&self) -> &str {
        &self.symbol
    }

    /// `value` (SI): to six digits, of the SI unit as an engineer reads it.
    #[must_use]
    pub fn text(&self, value: f64) -> String {
        if self.takes_prefix {
            return Quantity::new(value, &self.symbol).to_string();
        }
        format!("{} {}", digits(value / self.si, 6), self.symbol)
    }

    /// `value` (SI) in few digits, for a drawing.
    #[must_use]
    pub fn short(&self, value: f64) -> String {
        if self.takes_prefix {
            return Quantity::new(value, &self.symbol).to_string();
        }
        let number = digits(value / self.si, 4);
        let long = number.parse::<f64>().ok().filter(|number| number.abs() >= LONG);
        let number = long.map_or(number, |long| format!("{long:e}"));
        format!("{number} {}", self.symbol)
    }

    /// True if it takes the prefix that suits the number.
    #[must_use]
    pub const fn takes_prefix(&self) -> bool {
        self.takes_prefix
    }
}

/// Units of position and its derivatives, velocity to snap, as a user wrote them.
#[derive(Debug, Clone, PartialEq)]
pub struct DisplayUnits {
    base: &'static str,
    given: [Option<DisplayUnit>; 5],
}

impl DisplayUnits {
    /// SI units, for positions in `m` or `rad`.
    #[must_use]
    pub const fn new(base: &'static str) -> Self {
        Self { base, given: [const { None }; 5] }
    }

    /// The same with derivative `k` of position, 0 to 4, in the unit in which `text` was written, whose value is `value`
    /// (SI). A text without a unit, and a value of zero, from which the size of the unit cannot be computed, change nothing.
    #[must_use]
    pub fn as_given(mut self, k: usize, text: &str, value: f64) -> Self {
        if let (Some(slot), Some(unit)) = (self.given.get_mut(k), DisplayUnit::given(text, value)) {
            *slot = Some(unit);
        }
        self
    }

    /// Unit in which derivative `k` of position is shown: the given one, else one that matches the nearest given one, else
    /// the SI unit with the prefix that suits the number.
    #[must_use]
    pub fn unit(&self, k: usize) -> DisplayUnit {
        self.known(k).unwrap_or_else(|| DisplayUnit::si(self.base, k))
    }

    /// The same, but the last resort is the SI unit without a prefix.
    #[must_use]
    pub fn plain(&self, k: usize) -> DisplayUnit {
        self.known(k).unwrap_or_else(|| DisplayUnit::plain(self.base, k))
    }

    /// `m` or `rad`.
    #[must_use]
    pub const fn base(&self) -> &'static str {
        self.base
    }

    fn known(&self, k: usize) -> Option<DisplayUnit> {
        let related = || {
            let given = || self.given.iter().enumerate().filter_map(|(i, unit)| Some((i.abs_diff(k), unit.as_ref()?)));
            let nearest = given().min_by_key(|(distance, _)| *distance);
            nearest.and_then(|(_, unit)| unit.of_derivative(k))
        };
        self.given.get(k).cloned().flatten().or_else(related)
    }
}

/// The number to `count` significant digits, without zeros at its end.
#[must_use]
pub fn digits(value: f64, count: usize) -> String {
    let rounded: f64 = format!("{value:.*e}", count - 1).parse().unwrap_or(value);
    // A minus sign before zero reads as a mistake.
    let rounded = if rounded == 0.0 { 0.0 } else { rounded };
    if rounded == 0.0 || (1e-4..1e9).contains(&rounded.abs()) { rounded.to_string() } else { format!("{rounded:e}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quantity_keeps_its_unit() {
        for (text, value, shown, words) in [
            ("90 deg", PI / 2.0, PI / 2.0, "90 deg"),
            ("-90deg", -PI / 2.0, -PI / 2.0, "-90 deg"),
            (" 1e3 m/s4 ", 1e3, 500.0, "500 m/s4"),
            ("3000 rpm", 100.0 * PI, 100.0 / 3.0 * PI, "1000 rpm"),
            ("1 m/s", 1.0, 2.0 / 3.0, "0.666667 m/s"),
            ("1 m/s", 1.0, -0.0, "0 m/s"),
            ("4 m/s2", 4.0, 4e-9, "4e-9 m/s2"),
        ] {
            assert_eq!(DisplayUnit::given(text, value).unwrap().text(shown), words, "{text}");
        }
        assert_eq!(DisplayUnit::given("1 rad/s4", 1.0).unwrap().short(1e7), "1e7 rad/s4");
        for (text, value) in [("5", 5.0), ("fast", 1.0), ("0 mm", 0.0), ("1 m", f64::INFINITY)] {
            assert_eq!(DisplayUnit::given(text, value), None, "{text}");
        }
    }

    /// A velocity in revolutions per minute implies positions in revolutions, and likewise for millimetres.
    #[test]
    fn other_derivatives_go_with_the_given_one() {
        let of = |text, value, k| DisplayUnit::given(text, value).unwrap().of_derivative(k);
        let position = of("60 rpm", 2.0 * PI, 0).unwrap();
        assert_eq!((position.text(PI).as_str(), position.symbol()), ("0.5 rev", "rev"));
        assert_eq!(of("1 deg/s", PI / 180.0, 3).unwrap().symbol(), "deg/s³");
        let jerk = of("1 mm", 1e-3, 3).unwrap();
        assert_eq!((jerk.text(0.25).as_str(), jerk.scale().to_bits()), ("250 mm/s³", 1e-3_f64.to_bits()));
        assert_eq!(of("5 um / s", 5e-6, 0).unwrap().text(1e-6), "1 um");
        assert_eq!(of("1 cm/s2", 1e-2, 1).unwrap().symbol(), "cm/s");
        assert_eq!(of("30 m/min", 0.5, 2), None, "the SI's own has its prefixes");
        assert_eq!(of("1 rad/s", 1.0, 2), None);
        assert_eq!(DisplayUnit::given("1 deg/s2", 1.0).unwrap().pretty().symbol(), "deg/s²");
    }
}
