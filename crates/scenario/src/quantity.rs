//! Quantities as text: a number and a unit, `"30 m/min"`.
//!
//! ```text
//! quantity = number [unit]
//! unit     = factor { ("·" | "*" | space) factor } { "/" (factor | "(" product ")") }
//! factor   = symbol [power]          m2  m^2  m²  s-1  s^-1  s⁻¹  1
//! ```
//! A product after a quotient ("N/m s") is ambiguous and is refused.
use crate::unit::{hint, unit};
use servobench_base::Shortest;
use servobench_config::Dimension;
use std::ops::{Range, RangeInclusive};
use winnow::ascii::digit1;
use winnow::combinator::{alt, delimited, opt, preceded, repeat, separated};
use winnow::error::{ContextError, ErrMode};
use winnow::prelude::*;
use winnow::stream::LocatingSlice;
use winnow::token::{one_of, take_while};

/// A number in SI with its dimension.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Quantity {
    pub(crate) value: f64,
    pub(crate) dimension: Dimension,
    /// True if there is a unit.
    pub(crate) has_unit: bool,
}

/// Mistake in a text that should be a quantity.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct QuantityError {
    /// Byte range in the text.
    pub(crate) at: Range<usize>,
    pub(crate) message: String,
    pub(crate) help: String,
    /// True if the text does not resemble a quantity: an example of the wanted quantity helps.
    pub(crate) is_shapeless: bool,
}

impl QuantityError {
    fn new(at: Range<usize>, message: impl Into<String>, help: impl Into<String>) -> Self {
        Self { at, message: message.into(), help: help.into(), is_shapeless: false }
    }
}

/// A symbol with its power and its place.
#[derive(Debug, Clone, PartialEq)]
struct Factor {
    symbol: String,
    power: i32,
    at: Range<usize>,
}

type Input<'i> = LocatingSlice<&'i str>;
type Res<T> = Result<T, ErrMode<ContextError>>;

/// Largest power of a unit; no quantity here goes beyond s⁻⁴.
const MAX_POWER: i32 = 9;

/// Magnitudes in SI that a quantity can have. No machine comes near, and values derived from several quantities, such as a gain
/// from a bandwidth or an inertia times a squared transmission, stay inside the range of f64.
const MAGNITUDES: RangeInclusive<f64> = 1e-30..=1e30;

/// The mistake in the magnitude of `value`, if any; `is_zero`: the number was written as zero.
pub(crate) fn objection(value: f64, is_zero: bool) -> Option<&'static str> {
    let magnitude = value.abs();
    if is_zero || MAGNITUDES.contains(&magnitude) {
        None
    } else if magnitude < *MAGNITUDES.start() {
        Some("the number is too small: below 1e-30 in SI")
    } else {
        Some("the number is too large: above 1e30 in SI")
    }
}

/// Reads `text`.
///
/// # Errors
/// [`QuantityError`] with the place, the mistake and, if known, a correction.
pub(crate) fn parse(text: &str) -> Result<Quantity, QuantityError> {
    let mut input = LocatingSlice::new(text);
    let wrong = |at: usize, message: &str, help: &str| {
        let end = text[at..].chars().next().map_or(at, |c| at + c.len_utf8());
        Err(QuantityError::new(at..end, message, help))
    };
    let shapeless = |at: usize, message: &str| {
        wrong(at, message, "").map_err(|error| QuantityError { is_shapeless: true, ..error })
    };
    let number = match spaced(number).parse_next(&mut input) {
        Ok(number) => number,
        Err(_) if is_non_finite(text) => return wrong(0, "the number must be finite", ""),
        Err(_) => return shapeless(0, "a quantity begins with a number"),
    };
    if input.starts_with(',') {
        return wrong(at(&input, text), "the decimal sign is a point", "");
    }
    let factors = opt(spaced(unit_expression)).parse_next(&mut input).ok().flatten().unwrap_or_default();
    if let Some(next) = input.chars().next() {
        let place = at(&input, text);
        if text[..place].contains('/') && (next.is_alphabetic() || "·*(".contains(next)) {
            let help = "write \"N s/m\" or \"N/(m s)\", whichever is meant";
            return wrong(place, "a unit ends with its quotient", help);
        }
        return shapeless(place, "not a unit");
    }
    evaluate(text, number, &factors)
}

/// Factor from a number with a unit to SI.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Scale {
    numerator: f64,
    denominator: f64,
    tens: i32,
    dimension: Dimension,
}

impl Scale {
    /// Scale of the unit `text`.
    ///
    /// # Errors
    /// As [`parse`].
    pub(crate) fn read(text: &str) -> Result<Self, QuantityError> {
        let mut input = LocatingSlice::new(text);
        match spaced(unit_expression).parse_next(&mut input) {
            Ok(factors) if input.is_empty() => Self::of(&factors),
            _ => Err(QuantityError::new(0..text.len(), "not a unit", "")),
        }
    }

    fn of(factors: &[Factor]) -> Result<Self, QuantityError> {
        let mut scale = Self { numerator: 1.0, denominator: 1.0, tens: 0, dimension: Dimension::ONE };
        for Factor { symbol, power, at } in factors {
            let Some(unit) = unit(symbol) else {
                let message = format!("unknown unit `{symbol}`");
                let help = hint(symbol).unwrap_or_default();
                return Err(QuantityError::new(at.clone(), message, help));
            };
            if power.abs() > MAX_POWER {
                let message = format!("the power of `{symbol}` must be from -{MAX_POWER} to {MAX_POWER}");
                return Err(QuantityError::new(at.clone(), message, ""));
            }
            let (above, below) =
                if *power < 0 { (unit.denominator, unit.numerator) } else { (unit.numerator, unit.denominator) };
            scale.numerator *= above.powi(power.abs());
            scale.denominator *= below.powi(power.abs());
            scale.tens += unit.power * power;
            scale.dimension = scale.dimension.times(unit.dimension, *power);
        }
        Ok(scale)
    }

    /// Scale of a unit of which `units` are one metre or radian, for numbers written in `10^tens` units.
    pub(crate) const fn per(units: f64, tens: i32) -> Self {
        Self { numerator: 1.0, denominator: units, tens, dimension: Dimension::ONE }
    }

    /// `number` in SI.
    ///
    /// # Errors
    /// The mistake in its magnitude.
    pub(crate) fn value(&self, number: &str) -> Result<f64, &'static str> {
        let value = with_power_of_ten(number, self.tens) * self.numerator / self.denominator;
        let is_zero = number.bytes().take_while(|b| !matches!(b, b'e' | b'E')).all(|b| !(b'1'..=b'9').contains(&b));
        objection(value, is_zero).map_or(Ok(value), Err)
    }

    /// [`value`](Self::value) of a number that is not text; `None` if its magnitude is out of bounds.
    pub(crate) fn of_number(&self, number: f64) -> Option<f64> {
        let scaled = if self.tens == 0 { number } else { with_power_of_ten(&Shortest(number).to_string(), self.tens) };
        let value = scaled * self.numerator / self.denominator;
        (value.is_finite() && objection(value, number == 0.0).is_none()).then_some(value)
    }

    /// Dimension of the unit.
    pub(crate) const fn dimension(&self) -> Dimension {
        self.dimension
    }
}

fn evaluate(text: &str, number: &str, factors: &[Factor]) -> Result<Quantity, QuantityError> {
    let scale = Scale::of(factors)?;
    let value = scale.value(number).map_err(|message| QuantityError::new(0..text.len(), message, ""))?;
    Ok(Quantity { value, dimension: scale.dimension, has_unit: !factors.is_empty() })
}

/// `number · 10^tens`, rounded once.
fn with_power_of_ten(number: &str, tens: i32) -> f64 {
    if tens == 0 {
        return number.parse().unwrap_or(f64::NAN);
    }
    let (mantissa, exponent) = number.split_once(['e', 'E']).unwrap_or((number, "0"));
    // An exponent beyond 32 bits yields infinity or zero without help.
    let exponent = exponent.parse::<i32>().map(|exponent| exponent.saturating_add(tens));
    let text = exponent.map_or_else(|_| number.to_owned(), |exponent| format!("{mantissa}e{exponent}"));
    text.parse().unwrap_or(f64::NAN)
}

/// True if `text` could be a quantity.
pub(crate) fn begins_with_a_number(text: &str) -> bool {
    spaced(number).parse_next(&mut LocatingSlice::new(text)).is_ok() || is_non_finite(text)
}

fn is_non_finite(text: &str) -> bool {
    let text = text.trim_start().trim_start_matches(['+', '-']).to_ascii_lowercase();
    text.starts_with("nan") || text.starts_with("inf")
}

fn at(input: &Input<'_>, text: &str) -> usize {
    text.len() - input.len()
}

fn spaced<'i, T>(
    parser: impl Parser<Input<'i>, T, ErrMode<ContextError>>,
) -> impl Parser<Input<'i>, T, ErrMode<ContextError>> {
    delimited(spaces, parser, spaces)
}

fn spaces(input: &mut Input<'_>) -> Res<()> {
    take_while(0.., |c: char| c.is_whitespace()).void().parse_next(input)
}

/// Digits with a point and an exponent; the exponent only if it has digits ("2 e" is a number and a unit).
fn number<'i>(input: &mut Input<'i>) -> Res<&'i str> {
    let sign = || opt(one_of(['+', '-']));
    let mantissa = alt(((digit1, opt(('.', opt(digit1)))).void(), ('.', digit1).void()));
    (sign(), mantissa, opt((one_of(['e', 'E']), sign(), digit1))).take().parse_next(input)
}

fn unit_expression(input: &mut Input<'_>) -> Res<Vec<Factor>> {
    let mut factors = product(input)?;
    let below = alt((delimited((spaces, '(', spaces), product, (spaces, ')')), factor.map(|factor| vec![factor])));
    let quotients: Vec<Vec<Factor>> = repeat(0.., preceded((spaces, '/', spaces), below)).parse_next(input)?;
    factors.extend(quotients.into_iter().flatten().map(|factor| Factor { power: -factor.power, ..factor }));
    Ok(factors)
}

fn product(input: &mut Input<'_>) -> Res<Vec<Factor>> {
    let sign = (spaces, one_of(['·', '*', '\u{22c5}']), spaces).void();
    let gap = take_while(1.., |c: char| c.is_whitespace()).void();
    separated(1.., factor, alt((sign, gap))).parse_next(input)
}

fn factor(input: &mut Input<'_>) -> Res<Factor> {
    let letters = take_while(1.., |c: char| c.is_alphabetic() || matches!(c, '%' | '°'));
    let one = "1".map(|one| (one, None));
    let ((symbol, power), at) = alt(((letters, opt(power)), one)).with_span().parse_next(input)?;
    Ok(Factor { symbol: symbol.to_owned(), power: power.unwrap_or(1), at })
}

fn power(input: &mut Input<'_>) -> Res<i32> {
    let plain = preceded(opt('^'), (opt('-'), digit1).take().map(saturating));
    let raised = take_while(1.., |c| raised_digit(c).is_some())
        .map(|text: &str| saturating(&text.chars().filter_map(raised_digit).collect::<String>()));
    alt((plain, raised)).parse_next(input)
}

/// An integer clamped to 32 bits: far beyond [`MAX_POWER`] anyway.
fn saturating(text: &str) -> i32 {
    text.parse().unwrap_or(if text.starts_with('-') { -i32::MAX } else { i32::MAX })
}

fn raised_digit(c: char) -> Option<char> {
    let raised = "⁰¹²³⁴⁵⁶⁷⁸⁹⁻".chars().position(|raised| raised == c)?;
    "0123456789-".chars().nth(raised)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use servobench_config::Dimension as D;
    use std::f64::consts::{PI, SQRT_2};

    /// Oracle: the same value as Rust reads it from the decimal text on the right.
    #[test]
    fn quantities_are_si_numbers_to_the_bit() {
        let velocity = D::METRE.times(D::SECOND, -1);
        let jerk = D::METRE.times(D::SECOND, -3);
        let inertia = D::KILOGRAM.times(D::METRE, 2);
        for (text, value, dimension) in [
            ("250 mm", 0.25, D::METRE),
            ("250mm", 0.25, D::METRE),
            (" 0.1 um ", 1e-7, D::METRE),
            ("0.1 \u{b5}m", 1e-7, D::METRE),
            ("0.1 \u{3bc}m", 1e-7, D::METRE),
            ("30 m/min", 0.5, velocity),
            ("-30 m / min", -0.5, velocity),
            ("36 km/h", 10.0, velocity),
            ("8 kHz", 8000.0, D::HERTZ),
            ("50 m/s3", 50.0, jerk),
            ("50 m/s^3", 50.0, jerk),
            ("50 m/s³", 50.0, jerk),
            ("50 m s-3", 50.0, jerk),
            ("50 m·s⁻³", 50.0, jerk),
            ("50 m/s/s/s", 50.0, jerk),
            ("50 m/(s s2)", 50.0, jerk),
            ("50000 mm s^-3", 50.0, jerk),
            ("1.27 Nm", 1.27, D::NEWTON_METRE),
            ("1.27 N m", 1.27, D::NEWTON_METRE),
            ("127 N cm", 1.27, D::NEWTON_METRE),
            ("0.00018 kg m2", 0.00018, inertia),
            ("1.8e-4 kg·m²", 0.00018, inertia),
            ("1.8 kg cm2", 0.00018, inertia),
            ("160.18 1/s", 160.18, D::ONE.times(D::SECOND, -1)),
            ("243.45 V s/m", 243.45, D::VOLT.times(D::SECOND, 1).times(D::METRE, -1)),
            ("5 %", 0.05, D::ONE),
            ("12.5", 12.5, D::ONE),
            ("1e3 s", 1000.0, D::SECOND),
            (".5 s", 0.5, D::SECOND),
            ("5. s", 5.0, D::SECOND),
            ("0 mm", 0.0, D::METRE),
        ] {
            let read = parse(text).unwrap_or_else(|e| panic!("{text}: {}", e.message));
            assert_eq!((read.value.to_bits(), read.dimension), (f64::to_bits(value), dimension), "{text}: {read:?}");
        }
    }

    #[test]
    fn factors_that_are_no_powers_of_ten() {
        for (text, value) in [
            ("3000 rpm", 100.0 * PI),
            ("3 krpm", 100.0 * PI),
            ("90 deg", PI / 2.0),
            ("90°", PI / 2.0),
            ("1 rev", 2.0 * PI),
            ("4.2 Arms", 4.2 * SQRT_2),
            ("1 Apk", 1.0),
            ("2 Nm/Arms", SQRT_2),
            ("3600 arcsec", PI / 180.0),
        ] {
            let read = parse(text).unwrap().value;
            // One rounding for each of the two factors and their product.
            assert!((read / value - 1.0).abs() < 4e-16, "{text}: {read}");
        }
    }

    #[test]
    fn what_is_wrong_is_pointed_at() {
        for (text, at, message, help) in [
            ("", 0..0, "a quantity begins with a number", ""),
            ("mm", 0..1, "a quantity begins with a number", ""),
            ("nan mm", 0..1, "the number must be finite", ""),
            ("-inf mm", 0..1, "the number must be finite", ""),
            ("1e999 mm", 0..8, "the number is too large: above 1e30 in SI", ""),
            ("1.1e36 um", 0..9, "the number is too large: above 1e30 in SI", ""),
            ("1e-320 nm", 0..9, "the number is too small: below 1e-30 in SI", ""),
            ("-1e-400 nm", 0..10, "the number is too small: below 1e-30 in SI", ""),
            ("1,5 mm", 1..2, "the decimal sign is a point", ""),
            ("8 khz", 2..5, "unknown unit `khz`", "did you mean `kHz`?"),
            ("8 m/sek", 4..7, "unknown unit `sek`", "did you mean `s`?"),
            ("8 m10", 2..5, "the power of `m` must be from -9 to 9", ""),
            ("8 m999999999999", 2..15, "the power of `m` must be from -9 to 9", ""),
            ("8 N/m s", 6..7, "a unit ends with its quotient", "write \"N s/m\" or \"N/(m s)\", whichever is meant"),
            ("8 m; s", 3..4, "not a unit", ""),
            ("8 m/s ?", 6..7, "not a unit", ""),
            ("8 /s", 2..3, "not a unit", ""),
        ] {
            let e = parse(text).unwrap_err();
            assert_eq!((e.at, e.message.as_str(), e.help.as_str()), (at, message, help), "{text}");
        }
    }

    proptest! {
        #[test]
        fn any_text_is_read_or_refused(text in "\\PC*") {
            if let Err(e) = parse(&text) {
                prop_assert!(text.get(e.at).is_some(), "a place in the text");
            }
        }

        #[test]
        fn near_quantities_are_read_or_refused(text in "[-+0-9.eE ]{0,8}[mskNAVH1%°µ·*/^()2³⁻ -]{0,12}") {
            if let Ok(quantity) = parse(&text) {
                prop_assert!(quantity.value.is_finite());
            }
        }

        /// Oracle: Rust's own reading of the number with the exponent of the prefix.
        #[test]
        fn prefixes_round_once(mantissa in 1u32..1_000_000, exponent in -9i32..9) {
            let read = parse(&format!("{mantissa}e{exponent} um")).unwrap().value;
            let exact: f64 = format!("{mantissa}e{}", exponent - 6).parse().unwrap();
            prop_assert_eq!(read.to_bits(), exact.to_bits());
        }
    }
}
