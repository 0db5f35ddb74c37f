//! A key and the values that it takes in turn.
use crate::error::SweepError;
use servobench_base::Shortest;
use servobench_config::choices;

choices! {
    /// Spacing of the values of a range.
    pub enum Spacing default Linear {
        /// At equal distances.
        Linear = "linear",
        /// At equal ratios.
        Logarithmic = "log",
    }
}

/// A value of a key.
#[derive(Debug, Clone, PartialEq)]
pub enum Value {
    /// A number in a unit; the unit of a pure number is empty.
    Number(f64, String),
    /// Any other value of a scenario: a name, a list, `true`.
    Text(String),
}

impl Value {
    /// The value as written after the key on the command line: `50 m/s3`.
    #[must_use]
    pub fn written(&self) -> String {
        match self {
            Self::Number(number, unit) if unit.is_empty() => Shortest(*number).to_string(),
            Self::Number(number, unit) => format!("{} {unit}", Shortest(*number)),
            Self::Text(text) => text.clone(),
        }
    }

    /// The number, if it is one.
    #[must_use]
    pub const fn number(&self) -> Option<f64> {
        match self {
            Self::Number(number, _) => Some(*number),
            Self::Text(_) => None,
        }
    }

    /// Its unit; empty if it has none.
    #[must_use]
    pub fn unit(&self) -> &str {
        match self {
            Self::Number(_, unit) => unit,
            Self::Text(_) => "",
        }
    }
}

/// A pure number.
impl From<f64> for Value {
    fn from(number: f64) -> Self {
        Self::Number(number, String::new())
    }
}

/// A number and its unit.
impl From<(f64, &str)> for Value {
    fn from((number, unit): (f64, &str)) -> Self {
        Self::Number(number, unit.to_owned())
    }
}

/// As the file would have it: `200 m/s3`, a name, a list.
impl From<&str> for Value {
    fn from(text: &str) -> Self {
        Self::Text(text.to_owned())
    }
}

impl From<bool> for Value {
    fn from(value: bool) -> Self {
        Self::Text(value.to_string())
    }
}

/// A key of a scenario, and the values that it takes.
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    /// The key: `setpoint.jerk`.
    pub key: String,
    /// Its values, in the order of the runs.
    pub values: Vec<Value>,
}

impl Axis {
    /// `key` over `count` values in `unit`, including both ends.
    ///
    /// # Errors
    /// Those of [`spaced`].
    pub fn range(
        key: &str,
        [from, to]: [f64; 2],
        unit: &str,
        count: usize,
        spacing: Spacing,
    ) -> Result<Self, SweepError> {
        let numbers = spaced(key, [from, to], count, spacing)?;
        let values = numbers.into_iter().map(|number| Value::Number(number, unit.to_owned())).collect();
        Ok(Self { key: key.to_owned(), values })
    }
}

/// `count` numbers from one end to the other, including both ends to the bit.
///
/// # Errors
/// [`SweepError::NotFinite`], [`SweepError::TooFew`], [`SweepError::NoLogarithm`], with the name `key`.
pub fn spaced(key: &str, [from, to]: [f64; 2], count: usize, spacing: Spacing) -> Result<Vec<f64>, SweepError> {
    let key = || key.to_owned();
    for (what, value) in [("`from`", from), ("`to`", to)] {
        if !value.is_finite() {
            return Err(SweepError::NotFinite { key: key(), what, value });
        }
    }
    if count < 2 {
        return Err(SweepError::TooFew { key: key(), count });
    }
    // A product below the smallest number is 0 even if neither end is.
    let same_sign = from.signum() * to.signum() > 0.0 && from != 0.0 && to != 0.0;
    if spacing == Spacing::Logarithmic && !same_sign {
        return Err(SweepError::NoLogarithm { key: key(), from, to });
    }
    let (last, size) = (count - 1, from.abs().max(to.abs()));
    let at = |k: usize| {
        let share = k as f64 / last as f64;
        match spacing {
            _ if k == 0 => from,
            _ if k == last => to,
            // Not the difference of the ends, which may overflow.
            Spacing::Linear => neat(from * (1.0 - share) + to * share, size, ROUNDING),
            Spacing::Logarithmic => {
                let (low, high) = (libm::log(from.abs()), libm::log(to.abs()));
                let value = from.signum() * libm::exp(low * (1.0 - share) + high * share);
                // The rounding error of the value grows with the magnitude of its logarithm.
                neat(value, value.abs(), ROUNDING * (1.0 + low.abs().max(high.abs())))
            }
        }
        .clamp(from.min(to), from.max(to))
    };
    Ok((0..count).map(at).collect())
}

/// Rounding error of a value between two ends, relative to the larger one.
const ROUNDING: f64 = 4.0 * f64::EPSILON;
/// Number of digits up to which a value counts as an intended decimal number.
const DIGITS: i32 = 12;

/// `value`, which has a rounding error of `rounding`, relative to `size`; replaced by a decimal number of few digits within that error, if
/// there is one: 11 for 10.999999999999998, and 0 for 2e-17 between -1 and 1.
fn neat(value: f64, size: f64, rounding: f64) -> f64 {
    let off = rounding * size;
    if value.abs() <= off {
        return 0.0;
    }
    // The decimal place of the last digit of a number as large as `size`.
    #[expect(clippy::cast_possible_truncation, reason = "at most twice the exponents of a number")]
    let digits = DIGITS - (libm::floor(libm::log10(size)) - libm::floor(libm::log10(value.abs()))) as i32;
    let Some(decimals) = usize::try_from(digits - 1).ok() else { return value };
    let near: f64 = format!("{value:.decimals$e}").parse().unwrap_or(value);
    if (near - value).abs() <= off { near } else { value }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn values_lie_as_they_are_asked_to() {
        let linear = spaced("k", [10.0, 20.0], 5, Spacing::Linear).unwrap();
        assert_eq!(linear, [10.0, 12.5, 15.0, 17.5, 20.0]);
        let decades = spaced("k", [1e-3, 1e3], 7, Spacing::Logarithmic).unwrap();
        for (decade, value) in (-3..).zip(&decades) {
            assert!((value / 10_f64.powi(decade) - 1.0).abs() < 1e-14, "{decades:?}");
        }
        // Down, and below zero.
        assert_eq!(spaced("k", [3.0, 1.0], 3, Spacing::Linear).unwrap(), [3.0, 2.0, 1.0]);
        let negative = spaced("k", [-1.0, -100.0], 3, Spacing::Logarithmic).unwrap();
        assert!((negative[1] + 10.0).abs() < 1e-13, "{negative:?}");
    }

    /// Every range from 1 to N, up and down and through zero: each number exact as written by hand.
    #[test]
    fn whole_numbers_stay_whole() {
        for last in 2..=400_u32 {
            let up = spaced("seed", [1.0, f64::from(last)], last as usize, Spacing::Linear).unwrap();
            assert!(up.iter().zip(1..).all(|(x, k)| x.to_bits() == f64::from(k).to_bits()), "1 to {last}");
        }
        for half in 1..=100_i32 {
            let count = 2 * half.unsigned_abs() as usize + 1;
            let ends = [f64::from(-half), f64::from(half)];
            let through = spaced("x", ends, count, Spacing::Linear).unwrap();
            assert!(through.iter().zip(-half..).all(|(x, k)| x.to_bits() == f64::from(k).to_bits()), "±{half}");
            // The same in tenths and in thousandths of a millimetre.
            for unit in [10.0, 1e6] {
                let through = spaced("x", ends.map(|end| end / unit), count, Spacing::Linear).unwrap();
                let is_near = |(x, k): (&f64, i32)| x.to_bits() == (f64::from(k) / unit).to_bits();
                assert!(through.iter().zip(-half..).all(is_near), "±{half}/{unit}");
            }
        }
        let (zero, uneven) = (spaced("x", [-0.1, 0.3], 5, Spacing::Linear).unwrap(), [-0.1, 0.0, 0.1, 0.2, 0.3]);
        assert!(zero.iter().zip(uneven).all(|(x, k)| x.to_bits() == f64::to_bits(k)), "{zero:?}");
        let decades = spaced("x", [1e-3, 1e6], 10, Spacing::Logarithmic).unwrap();
        assert_eq!(decades, [1e-3, 1e-2, 0.1, 1.0, 10.0, 100.0, 1e3, 1e4, 1e5, 1e6]);
        let twice = spaced("x", [1.0, 1024.0], 11, Spacing::Logarithmic).unwrap();
        assert_eq!(twice, [1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0, 128.0, 256.0, 512.0, 1024.0]);
        // Large seeds; a number that is not a short decimal keeps its digits.
        let large = spaced("seed", [4_294_967_286.0, 4_294_967_295.0], 10, Spacing::Linear).unwrap();
        assert_eq!(large[3].to_bits(), 4_294_967_289_f64.to_bits());
        assert_eq!(spaced("x", [0.0, 1.0], 4, Spacing::Linear).unwrap()[1].to_bits(), (1.0_f64 / 3.0).to_bits());
    }

    #[test]
    fn what_is_no_range_is_refused_by_name() {
        let refusal = |ends, count, spacing| spaced("load.mass", ends, count, spacing).unwrap_err().to_string();
        assert!(refusal([0.0, 1.0], 3, Spacing::Logarithmic).contains("`load.mass`: a scale from 0 to 1"));
        assert!(refusal([-1.0, 1.0], 3, Spacing::Logarithmic).contains("the same sign"));
        assert!(refusal([f64::NAN, 1.0], 3, Spacing::Linear).contains("`from` is NaN"));
        assert!(refusal([0.0, f64::INFINITY], 3, Spacing::Linear).contains("`to` is inf"));
        assert!(refusal([0.0, 1.0], 1, Spacing::Linear).contains("at least 2"));
    }

    #[test]
    fn a_value_is_written_as_a_scenario_has_it() {
        let number = |number, unit: &str| Value::Number(number, unit.into()).written();
        assert_eq!(number(50.0, "m/s3"), "50 m/s3");
        assert_eq!(
            (number(0.1 + 0.2, ""), number(1e-9, "m"), number(-2e300, "")),
            ("0.30000000000000004".into(), "1e-9 m".into(), "-2e300".into())
        );
        assert_eq!(Value::Text("zvd".into()).written(), "zvd");
    }

    proptest! {
        /// Both ends to the bit, in order, no value outside; and each text parses to its number.
        #[test]
        fn a_range_has_its_ends_and_its_order(from in -1e300..1e300_f64, to in -1e300..1e300_f64, count in 2..50_usize) {
            let found = spaced("k", [from, to], count, Spacing::Linear).unwrap();
            prop_assert_eq!((found[0].to_bits(), found[count - 1].to_bits()), (from.to_bits(), to.to_bits()));
            let (low, high) = (from.min(to), from.max(to));
            prop_assert!(found.iter().all(|x| (low..=high).contains(x)));
            for number in found {
                prop_assert_eq!(Shortest(number).to_string().parse::<f64>().unwrap().to_bits(), number.to_bits());
            }
        }
    }
}
