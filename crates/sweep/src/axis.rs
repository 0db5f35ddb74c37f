//! A key and the values that it takes one after the other.
use crate::error::SweepError;
use servobench_base::Shortest;
use servobench_config::choices;

choices! {
    /// How the values of a range lie between its ends.
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
    /// Anything else, as a scenario has it: a name, a list, `true`.
    Text(String),
}

impl Value {
    /// As it stands behind the key on the command line: `50 m/s3`.
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

    /// Its unit; empty where there is none.
    #[must_use]
    pub fn unit(&self) -> &str {
        match self {
            Self::Number(_, unit) => unit,
            Self::Text(_) => "",
        }
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
    /// `key` over `count` values in `unit`, the ends among them.
    ///
    /// # Errors
    /// As [`spaced`].
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

/// `count` numbers from one end to the other, both of which are among them to the bit.
///
/// # Errors
/// [`SweepError::NotFinite`], [`SweepError::TooFew`], [`SweepError::NoLogarithm`] name `key`.
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
    // A product below the smallest number is 0 although neither end is.
    let same_sign = from.signum() * to.signum() > 0.0 && from != 0.0 && to != 0.0;
    if spacing == Spacing::Logarithmic && !same_sign {
        return Err(SweepError::NoLogarithm { key: key(), from, to });
    }
    let last = count - 1;
    let at = |k: usize| {
        let share = k as f64 / last as f64;
        match spacing {
            _ if k == 0 => from,
            _ if k == last => to,
            // Not the difference of the ends, which may be beyond all numbers.
            Spacing::Linear => from * (1.0 - share) + to * share,
            Spacing::Logarithmic => {
                let (low, high) = (libm::log(from.abs()), libm::log(to.abs()));
                from.signum() * libm::exp(low * (1.0 - share) + high * share)
            }
        }
    };
    Ok((0..count).map(at).collect())
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

    #[test]
    fn what_is_no_range_is_refused_by_name() {
        let refusal = |ends, count, spacing| spaced("load.mass", ends, count, spacing).unwrap_err().to_string();
        assert!(refusal([0.0, 1.0], 3, Spacing::Logarithmic).contains("`load.mass`: from 0 to 1"));
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
        /// The ends to the bit, in order, nothing beyond them; and each text is read as the number that it is of.
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
