//! Units by symbol, with SI prefixes.
use crate::dimension::Dimension as D;
use crate::nearest::nearest;
use std::f64::consts::{PI, SQRT_2};

/// What one of a unit is in SI: `numerator / denominator · 10^power`.
///
/// Powers of ten are kept apart, so that "250 mm" is the very number that `0.25` is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Unit {
    pub(crate) dimension: D,
    pub(crate) numerator: f64,
    pub(crate) denominator: f64,
    pub(crate) power: i32,
}

/// Symbol, unit, whether SI prefixes go with it.
type Row = (&'static str, Unit, bool);

const fn si(dimension: D) -> Unit {
    Unit { dimension, numerator: 1.0, denominator: 1.0, power: 0 }
}

const fn scaled(dimension: D, numerator: f64, denominator: f64, power: i32) -> Unit {
    Unit { dimension, numerator, denominator, power }
}

const VOLT_AMPLITUDE: D = D::VOLT.times(D::AMPLITUDE, 1);
const AMPERE_AMPLITUDE: D = D::AMPERE.times(D::AMPLITUDE, 1);
const OHM: Unit = si(D::VOLT.times(D::AMPERE, -1));

const UNITS: [Row; 30] = [
    ("m", si(D::METRE), true),
    ("g", scaled(D::KILOGRAM, 1.0, 1.0, -3), true),
    ("s", si(D::SECOND), true),
    ("min", scaled(D::SECOND, 60.0, 1.0, 0), false),
    ("h", scaled(D::SECOND, 3600.0, 1.0, 0), false),
    ("N", si(D::NEWTON), true),
    ("Nm", si(D::NEWTON_METRE), true),
    ("J", si(D::NEWTON_METRE), true),
    ("A", si(D::AMPERE), true),
    ("Apk", si(AMPERE_AMPLITUDE), true),
    ("Arms", scaled(AMPERE_AMPLITUDE, SQRT_2, 1.0, 0), true),
    ("V", si(D::VOLT), true),
    ("Vpk", si(VOLT_AMPLITUDE), true),
    ("Vrms", scaled(VOLT_AMPLITUDE, SQRT_2, 1.0, 0), true),
    ("Ω", OHM, true),
    // The sign for the unit, U+2126, and what keyboards have.
    ("\u{2126}", OHM, true),
    ("Ohm", OHM, true),
    ("ohm", OHM, true),
    ("H", si(D::VOLT.times(D::SECOND, 1).times(D::AMPERE, -1)), true),
    ("Wb", si(D::VOLT.times(D::SECOND, 1)), true),
    ("Hz", si(D::HERTZ), true),
    ("rad", si(D::RADIAN), true),
    ("deg", scaled(D::RADIAN, PI, 180.0, 0), false),
    ("°", scaled(D::RADIAN, PI, 180.0, 0), false),
    ("arcmin", scaled(D::RADIAN, PI, 10_800.0, 0), false),
    ("arcsec", scaled(D::RADIAN, PI, 648_000.0, 0), false),
    ("rev", scaled(D::RADIAN, 2.0 * PI, 1.0, 0), false),
    ("rpm", scaled(D::RADIAN.times(D::SECOND, -1), 2.0 * PI, 60.0, 0), true),
    ("%", scaled(D::ONE, 1.0, 1.0, -2), false),
    ("1", si(D::ONE), false),
];

/// Prefixes and their powers of ten. Micro has two signs (U+00B5, U+03BC) and a spelling for keyboards.
const PREFIXES: [(&str, i32); 9] =
    [("n", -9), ("u", -6), ("\u{b5}", -6), ("\u{3bc}", -6), ("m", -3), ("c", -2), ("k", 3), ("M", 6), ("G", 9)];

/// The unit of that symbol, with or without prefix.
pub(crate) fn unit(symbol: &str) -> Option<Unit> {
    // A symbol by itself comes first: "min" is no milli-inch.
    if let Some((_, unit, _)) = UNITS.iter().find(|(name, ..)| *name == symbol) {
        return Some(*unit);
    }
    PREFIXES.iter().find_map(|(prefix, power)| {
        let rest = symbol.strip_prefix(prefix)?;
        let (_, unit, _) = UNITS.iter().find(|(name, _, prefixes)| *prefixes && *name == rest)?;
        Some(Unit { power: unit.power + power, ..*unit })
    })
}

/// The known symbol that was probably meant.
pub(crate) fn similar_symbol(symbol: &str) -> Option<String> {
    let prefixed = UNITS.iter().filter(|(.., prefixes)| *prefixes).flat_map(|(name, ..)| {
        PREFIXES.iter().filter(|(prefix, _)| prefix.is_ascii()).map(move |(prefix, _)| format!("{prefix}{name}"))
    });
    let mut all: Vec<String> = UNITS.iter().map(|(name, ..)| (*name).to_owned()).chain(prefixed).collect();
    // Without case "mm" and "Mm" are one: keep the order of the table, and exact letters first.
    all.sort_by_key(|name| !name.starts_with(symbol.chars().next().unwrap_or('m')));
    nearest(symbol, all.iter().map(String::as_str)).map(str::to_owned)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn symbols_come_before_prefixes() {
        assert_eq!(unit("min").map(|unit| unit.numerator.to_bits()), Some(60.0_f64.to_bits()));
        assert_eq!(unit("mm").map(|unit| unit.power), Some(-3));
        assert_eq!(unit("kg").map(|unit| (unit.dimension, unit.power)), Some((D::KILOGRAM, 0)));
        assert_eq!(unit("mNm").map(|unit| (unit.dimension, unit.power)), Some((D::NEWTON_METRE, -3)));
        assert_eq!(unit("kmin"), None);
        assert_eq!(unit(""), None);
    }

    #[test]
    fn no_symbol_reads_in_two_ways() {
        for (name, ..) in UNITS {
            for (prefix, _) in PREFIXES {
                let Some(rest) = name.strip_prefix(prefix) else { continue };
                let other = UNITS.iter().any(|(name, _, prefixes)| *prefixes && *name == rest);
                assert!(!other, "`{name}` is also `{prefix}` + `{rest}`");
            }
        }
    }

    #[test]
    fn slips_of_case_are_understood() {
        for (wrong, right) in [("khz", "kHz"), ("RPM", "rpm"), ("Kg", "kg"), ("NM", "Nm"), ("arms", "Arms")] {
            assert_eq!(similar_symbol(wrong).as_deref(), Some(right));
        }
        assert_eq!(similar_symbol("furlong"), None);
    }
}
