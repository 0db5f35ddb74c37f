//! Units of recordings as units of FMI: exponents of the SI base units, and display units.
use servobench_fmi::{BaseUnit, DisplayUnit, Exponents, Unit};
use std::f64::consts::PI;
use thiserror::Error;

/// A unit symbol that has no definition.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("the unit `{symbol}` has no definition for FMI")]
pub(crate) struct NoUnit {
    symbol: String,
}

/// The unit written as `symbol` in recordings: products with a space, one stroke, superscripts.
///
/// # Errors
/// [`NoUnit`].
pub(crate) fn definition(symbol: &str) -> Result<Unit, NoUnit> {
    let unknown = || NoUnit { symbol: symbol.into() };
    let (over, under) = symbol.split_once('/').unwrap_or((symbol, ""));
    let mut exponents = Exponents::default();
    for (factors, sign) in [(over, 1), (under, -1)] {
        for factor in factors.split(' ').filter(|factor| !factor.is_empty() && *factor != "1") {
            let base = factor.trim_end_matches(['²', '³', '⁴']);
            let power = match &factor[base.len()..] {
                "" => 1,
                "²" => 2,
                "³" => 3,
                "⁴" => 4,
                _ => return Err(unknown()),
            };
            let own = derived(base).ok_or_else(unknown)?;
            for (sum, one) in [
                (&mut exponents.kg, own.kg),
                (&mut exponents.m, own.m),
                (&mut exponents.s, own.s),
                (&mut exponents.a, own.a),
                (&mut exponents.k, own.k),
                (&mut exponents.rad, own.rad),
            ] {
                *sum += sign * power * one;
            }
        }
    }
    let offset = if symbol == "°C" { 273.15 } else { 0.0 };
    let base = Some(BaseUnit { exponents, factor: 1.0, offset });
    let shown = |(name, factor): &(&str, f64)| DisplayUnit {
        name: (*name).into(),
        factor: *factor,
        offset: 0.0,
        inverse: false,
    };
    let display = match symbol {
        "m" => &[("mm", 1e3), ("um", 1e6)][..],
        "m/s" => &[("m/min", 60.0), ("mm/s", 1e3)],
        "rad" => &[("deg", 180.0 / PI)],
        "rad/s" => &[("rpm", 30.0 / PI), ("deg/s", 180.0 / PI)],
        _ => &[],
    };
    Ok(Unit { name: ascii(symbol), base, display: display.iter().map(shown).collect() })
}

/// Exponents of a named unit.
fn derived(symbol: &str) -> Option<Exponents> {
    let none = Exponents::default();
    Some(match symbol {
        "kg" => Exponents { kg: 1, ..none },
        "m" => Exponents { m: 1, ..none },
        "s" => Exponents { s: 1, ..none },
        "A" => Exponents { a: 1, ..none },
        "°C" => Exponents { k: 1, ..none },
        "rad" => Exponents { rad: 1, ..none },
        "N" => Exponents { kg: 1, m: 1, s: -2, ..none },
        "W" => Exponents { kg: 1, m: 2, s: -3, ..none },
        "V" => Exponents { kg: 1, m: 2, s: -3, a: -1, ..none },
        _ => return None,
    })
}

/// The name in the form recommended by the standard: `kg.m2`, `N.m.s/rad`.
fn ascii(symbol: &str) -> String {
    symbol.replace('°', "deg").replace(' ', ".").replace('²', "2").replace('³', "3").replace('⁴', "4")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: the definitions of the SI.
    #[test]
    fn exponents_are_those_of_the_si() {
        let of = |symbol: &str| {
            let unit = definition(symbol).unwrap();
            let Exponents { kg, m, s, a, rad, .. } = unit.base.unwrap().exponents;
            (unit.name, [kg, m, s, a, rad])
        };
        for (symbol, name, exponents) in [
            ("m/s⁴", "m/s4", [0, 1, -4, 0, 0]),
            ("rad/s²", "rad/s2", [0, 0, -2, 0, 1]),
            ("N m", "N.m", [1, 2, -2, 0, 0]),
            ("W", "W", [1, 2, -3, 0, 0]),
            ("N m s/rad", "N.m.s/rad", [1, 2, -1, 0, -1]),
            ("N/m", "N/m", [1, 0, -2, 0, 0]),
            ("V", "V", [1, 2, -3, -1, 0]),
            ("kg m²", "kg.m2", [1, 2, 0, 0, 0]),
            ("1/s", "1/s", [0, 0, -1, 0, 0]),
        ] {
            assert_eq!(of(symbol), (name.to_owned(), exponents));
        }
        assert_eq!(definition("furlong").unwrap_err().to_string(), "the unit `furlong` has no definition for FMI");
    }

    /// Oracle: the zero of the Celsius scale in kelvin.
    #[test]
    fn degrees_celsius_are_kelvin_above_their_zero() {
        let unit = definition("°C").unwrap();
        let BaseUnit { exponents, factor, offset } = unit.base.unwrap();
        assert_eq!((unit.name.as_str(), exponents), ("degC", Exponents { k: 1, ..Exponents::default() }));
        assert!((factor - 1.0).abs() < 1e-15 && (offset - 273.15).abs() < 1e-12);
    }

    /// Oracle: 1 rad/s is 60/2π rpm.
    #[test]
    fn display_units_show_the_same_value() {
        let unit = definition("rad/s").unwrap();
        assert!((unit.display[0].shown(2.0 * PI, false) - 60.0).abs() < 1e-13);
    }
}
