//! A key and its range, as on the command line: `axis.load.frequency=14 Hz..22 Hz`, `axis.load.mass=12 kg±10 %`.
use crate::sweep_file::amount;
use servobench_sweep::Value;
use std::str::FromStr;
use thiserror::Error;

/// A key with its lowest and highest value.
#[derive(Debug, Clone, PartialEq)]
pub struct KeyRange {
    /// The key: `axis.load.frequency`.
    pub key: String,
    /// Lowest and highest value.
    pub ends: [f64; 2],
    /// The unit of both; empty for pure numbers.
    pub unit: String,
}

/// Reason why a text is not a range of a key.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{0}; write it as axis.load.frequency=14 Hz..22 Hz or axis.load.mass=12 kg±10 %")]
pub struct KeyRangeError(String);

impl FromStr for KeyRange {
    type Err = KeyRangeError;

    fn from_str(text: &str) -> Result<Self, KeyRangeError> {
        let wrong = |why: String| KeyRangeError(why);
        let (key, range) = text.split_once('=').ok_or_else(|| wrong(format!("`{text}` has no `=`")))?;
        let key = key.trim().to_owned();
        if key.is_empty() {
            return Err(wrong(format!("`{text}` does not name a key")));
        }
        let (ends, unit) = if let Some((low, high)) = range.split_once("..") {
            let ((low, own), (high, unit)) = (number(low)?, number(high)?);
            if !own.is_empty() && own != unit {
                return Err(wrong(format!("`{low} {own}` and `{high} {unit}` have different units")));
            }
            ([low, high], unit)
        } else if let Some((middle, tolerance)) = range.split_once('±').or_else(|| range.split_once("+-")) {
            let ((middle, unit), (tolerance, of)) = (number(middle)?, number(tolerance)?);
            let off = match of.as_str() {
                "%" => (middle * tolerance / 100.0).abs(),
                of if of == unit => tolerance.abs(),
                of => return Err(wrong(format!("a tolerance is in % or in `{unit}`, not in `{of}`"))),
            };
            ([middle - off, middle + off], unit)
        } else {
            return Err(wrong(format!("`{range}` is not a range")));
        };
        if ends[0] > ends[1] || !ends.iter().all(|end| end.is_finite()) {
            return Err(wrong(format!(
                "a range goes from a lower to a higher value, not from {} to {}",
                ends[0], ends[1]
            )));
        }
        Ok(Self { key, ends, unit })
    }
}

fn number(text: &str) -> Result<(f64, String), KeyRangeError> {
    match amount(text) {
        Value::Number(number, unit) => Ok((number, unit)),
        Value::Text(text) => Err(KeyRangeError(format!("`{}` is not a number with a unit", text.trim()))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_range_has_a_key_and_two_ends_in_one_unit() {
        let range = |text: &str| text.parse::<KeyRange>().map(|range| (range.key, range.ends, range.unit));
        let of = |key: &str, ends, unit: &str| Ok((key.to_owned(), ends, unit.to_owned()));
        assert_eq!(range("axis.load.frequency=14 Hz..22 Hz"), of("axis.load.frequency", [14.0, 22.0], "Hz"));
        assert_eq!(range("a = 14..22 Hz"), of("a", [14.0, 22.0], "Hz"));
        assert_eq!(range("a=0.5..1.5"), of("a", [0.5, 1.5], ""));
        assert_eq!(range("a=-2e1 m..-1 m"), of("a", [-20.0, -1.0], "m"));
        assert_eq!(range("a=10 kg±10 %"), of("a", [9.0, 11.0], "kg"));
        assert_eq!(range("a=10 kg+-2 kg"), of("a", [8.0, 12.0], "kg"));
        for wrong in [
            "a",
            "=1..2",
            "a=1",
            "a=2 m..1 m",
            "a=1 m..2 mm",
            "a=x..2",
            "a=1 m±2 s",
            "a=1..inf",
            "a=NaN..2",
            "",
            "a=..",
            "a=1...2",
        ] {
            let refusal = range(wrong).unwrap_err().to_string();
            assert!(refusal.contains("14 Hz..22 Hz"), "{wrong}: {refusal}");
        }
    }
}
