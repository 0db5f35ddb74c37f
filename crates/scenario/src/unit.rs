//! Units by symbol, with SI prefixes.
use servobench_config::Dimension as D;
use servobench_files::nearest;
use std::f64::consts::{PI, SQRT_2};

/// Value of one unit in SI: `numerator / denominator · 10^power`.
///
/// Powers of ten are kept apart, so that "250 mm" equals `0.25` exactly.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Unit {
    pub(crate) dimension: D,
    pub(crate) numerator: f64,
    pub(crate) denominator: f64,
    pub(crate) power: i32,
}

/// Symbol, unit, and true if SI prefixes apply.
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

const UNITS: [Row; 35] = [
    ("m", si(D::METRE), true),
    ("g", scaled(D::KILOGRAM, 1.0, 1.0, -3), true),
    ("s", si(D::SECOND), true),
    ("min", scaled(D::SECOND, 60.0, 1.0, 0), false),
    ("h", scaled(D::SECOND, 3600.0, 1.0, 0), false),
    ("N", si(D::NEWTON), true),
    ("Nm", si(D::NEWTON_METRE), true),
    ("J", si(D::NEWTON_METRE), true),
    ("W", si(D::NEWTON_METRE.times(D::SECOND, -1)), true),
    ("A", si(D::AMPERE), true),
    ("Apk", si(AMPERE_AMPLITUDE), true),
    ("Arms", scaled(AMPERE_AMPLITUDE, SQRT_2, 1.0, 0), true),
    ("V", si(D::VOLT), true),
    ("Vpk", si(VOLT_AMPLITUDE), true),
    ("Vrms", scaled(VOLT_AMPLITUDE, SQRT_2, 1.0, 0), true),
    ("Ω", OHM, true),
    // The ohm sign, U+2126, and the spellings of keyboards.
    ("\u{2126}", OHM, true),
    ("Ohm", OHM, true),
    ("ohm", OHM, true),
    ("H", si(D::VOLT.times(D::SECOND, 1).times(D::AMPERE, -1)), true),
    ("F", si(D::AMPERE.times(D::SECOND, 1).times(D::VOLT, -1)), true),
    ("Wb", si(D::VOLT.times(D::SECOND, 1)), true),
    ("Hz", si(D::HERTZ), true),
    ("rad", si(D::RADIAN), true),
    ("deg", scaled(D::RADIAN, PI, 180.0, 0), false),
    ("°", scaled(D::RADIAN, PI, 180.0, 0), false),
    ("arcmin", scaled(D::RADIAN, PI, 10_800.0, 0), false),
    ("arcsec", scaled(D::RADIAN, PI, 648_000.0, 0), false),
    ("rev", scaled(D::RADIAN, 2.0 * PI, 1.0, 0), false),
    ("rpm", scaled(D::RADIAN.times(D::SECOND, -1), 2.0 * PI, 60.0, 0), true),
    ("K", si(D::KELVIN), false),
    ("degC", si(D::CELSIUS), false),
    ("°C", si(D::CELSIUS), false),
    ("%", scaled(D::ONE, 1.0, 1.0, -2), false),
    ("1", si(D::ONE), false),
];

/// Prefixes and their powers of ten. Micro has two signs (U+00B5, U+03BC) and a spelling for keyboards.
const PREFIXES: [(&str, i32); 9] =
    [("n", -9), ("u", -6), ("\u{b5}", -6), ("\u{3bc}", -6), ("m", -3), ("c", -2), ("k", 3), ("M", 6), ("G", 9)];

/// The unit of that symbol, with or without prefix.
pub(crate) fn unit(symbol: &str) -> Option<Unit> {
    // Whole symbols come first: "min" is not a milli-inch.
    if let Some((_, unit, _)) = UNITS.iter().find(|(name, ..)| *name == symbol) {
        return Some(*unit);
    }
    PREFIXES.iter().find_map(|(prefix, power)| {
        let rest = symbol.strip_prefix(prefix)?;
        let (_, unit, _) = UNITS.iter().find(|(name, _, prefixes)| *prefixes && *name == rest)?;
        Some(Unit { power: unit.power + power, ..*unit })
    })
}

/// Spellings that are not symbols here, with a correction. None of them is a typing error that leads to another prefix.
const SPELLINGS: [(&[&str], &str); 19] = [
    (&["MM"], "did you mean `mm`?"),
    (&["micron", "microns", "micrometer", "micrometre", "mu"], "did you mean `um`?"),
    (&["meter", "metre", "meters", "metres"], "did you mean `m`?"),
    (&["sec", "secs", "sek", "second", "seconds"], "did you mean `s`?"),
    (&["msec", "millisecond", "milliseconds"], "did you mean `ms`?"),
    (&["usec", "microsecond", "microseconds"], "did you mean `us`?"),
    (&["minute", "minutes"], "did you mean `min`?"),
    (&["hertz", "Hertz", "cps"], "did you mean `Hz`?"),
    (&["newton", "Newton", "newtons"], "did you mean `N`?"),
    (&["kilo", "kilos"], "did you mean `kg`?"),
    (&["degree", "degrees"], "did you mean `deg`?"),
    (&["r", "R", "turn", "turns", "U", "tr", "revs", "revolution", "revolutions"], "did you mean `rev`?"),
    (&["rps"], "did you mean `rev/s`?"),
    (&["upm", "Upm", "UPM"], "did you mean `rpm`?"),
    (&["in", "inch", "inches"], "an inch is 25.4 mm"),
    (&["ft", "foot", "feet"], "a foot is 304.8 mm"),
    (&["lb", "lbs", "lbf"], "a pound is 0.45359237 kg, as a force 4.4482216152605 N"),
    (&["kgf", "kp"], "the weight of 1 kg is 9.80665 N"),
    (&["gn", "G", "gee", "grav"], "gravity is 9.80665 m/s2"),
];

/// Correction of an unknown symbol, if known. A prefix that is not written is never proposed: a wrong guess would be wrong by a power
/// of ten.
pub(crate) fn hint(symbol: &str) -> Option<String> {
    if let Some((_, help)) = SPELLINGS.iter().find(|(spellings, _)| spellings.contains(&symbol)) {
        return Some((*help).to_owned());
    }
    run_together(symbol).or_else(|| of_other_case(symbol)).or_else(|| slip(symbol))
}

/// All symbols, those without a prefix first.
fn symbols() -> impl Iterator<Item = String> {
    let prefixed = UNITS.iter().filter(|(.., prefixes)| *prefixes).flat_map(|(name, ..)| {
        PREFIXES.iter().filter(|(prefix, _)| prefix.is_ascii()).map(move |(prefix, _)| format!("{prefix}{name}"))
    });
    UNITS.iter().map(|(name, ..)| (*name).to_owned()).chain(prefixed)
}

/// "khz": differs from a symbol in case only. A symbol without prefix comes first; of two prefixes the one written, and both when all
/// letters are capitals, which do not reveal the prefix.
fn of_other_case(symbol: &str) -> Option<String> {
    let lower = symbol.to_lowercase();
    let mut all: Vec<String> = symbols().filter(|known| known.to_lowercase() == lower).collect();
    let as_written = |known: &String| known.chars().next() == symbol.chars().next();
    if all.first().is_some_and(|first| UNITS.iter().any(|(name, ..)| name == first)) {
        all.truncate(1);
    } else if symbol != symbol.to_uppercase() && all.iter().any(as_written) {
        all.retain(as_written);
    }
    let quoted: Vec<String> = all.iter().map(|known| format!("`{known}`")).collect();
    (!quoted.is_empty()).then(|| format!("did you mean {}?", quoted.join(" or ")))
}

/// "Ns": two units without a space between them; if they can be split in two ways, both.
fn run_together(symbol: &str) -> Option<String> {
    let parted: Vec<String> = symbol
        .char_indices()
        .skip(1)
        .map(|(at, _)| symbol.split_at(at))
        // "Kg" is an error of case.
        .filter(|(first, second)| *first != "K" && unit(first).is_some() && unit(second).is_some())
        .map(|(first, second)| format!("`{first} {second}`"))
        .collect();
    (!parted.is_empty()).then(|| format!("write {}", parted.join(" or ")))
}

/// "rmp": a typing error in a symbol without prefix, if both are long enough to recognize.
fn slip(symbol: &str) -> Option<String> {
    let is_long = |name: &&str| name.chars().count() >= 3;
    let long = UNITS.iter().map(|(name, ..)| *name).filter(is_long);
    Some(symbol).filter(is_long).and_then(|symbol| nearest(symbol, long)).map(|near| format!("did you mean `{near}`?"))
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
            assert_eq!(hint(wrong), Some(format!("did you mean `{right}`?")));
        }
        assert_eq!(hint("furlong"), None);
    }

    #[test]
    fn a_prefix_is_never_guessed() {
        assert_eq!(hint("MHZ").as_deref(), Some("did you mean `mHz` or `MHz`?"));
        assert_eq!(hint("MS").as_deref(), Some("did you mean `ms` or `Ms`?"));
        assert_eq!(hint("mHZ").as_deref(), Some("did you mean `mHz`?"));
        for symbol in ["xm", "pm", "dm", "Tm"] {
            assert_eq!(hint(symbol), None, "{symbol}");
        }
    }

    #[test]
    fn what_engineers_write_is_understood() {
        for (spelling, help) in [
            ("MM", "did you mean `mm`?"),
            ("micron", "did you mean `um`?"),
            ("in", "an inch is 25.4 mm"),
            ("U", "did you mean `rev`?"),
            ("gn", "gravity is 9.80665 m/s2"),
            ("Ns", "write `N s`"),
            ("kgm", "write `kg m`"),
            ("kgcm", "write `kg cm`"),
            ("Nmm", "write `N mm` or `Nm m`"),
            ("Nms", "write `N ms` or `Nm s`"),
            ("Vs", "write `V s`"),
            ("arcmn", "did you mean `arcmin`?"),
            ("rmp", "did you mean `rpm`?"),
        ] {
            assert_eq!(hint(spelling).as_deref(), Some(help), "{spelling}");
        }
        for (spellings, help) in SPELLINGS {
            for spelling in spellings {
                assert_eq!(unit(spelling), None, "`{spelling}` is a symbol");
            }
            if let Some(symbol) = help.strip_prefix("did you mean `").and_then(|rest| rest.strip_suffix("`?")) {
                assert!(symbol.split('/').all(|symbol| unit(symbol).is_some()), "{symbol}");
            }
        }
    }
}
