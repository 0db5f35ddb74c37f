//! Values of variables in few characters.
use super::plain;
use crate::text::elided;
use servobench_fmi::{ModelDescription, Values, Variable};

/// Most values shown of an array.
const MOST_VALUES: usize = 3;
/// Most characters of a text as start value.
const TEXT: usize = 16;

/// `value` in the fewest digits that are read back as the same number; with an exponent where that is shorter and the number is not of
/// everyday size.
pub(super) fn number(value: f64) -> String {
    let (plain, exponential) = (value.to_string(), format!("{value:e}"));
    let is_everyday = value == 0.0 || (1e-4..1e7).contains(&value.abs());
    if is_everyday || plain.len() <= exponential.len() { plain } else { exponential }
}

/// Start value of a variable; for an array the first values, or the one that all share.
pub(super) fn start(description: &ModelDescription, variable: &Variable) -> String {
    let item = |value: i128| {
        let enumeration = description.enumeration(variable)?;
        enumeration.items.iter().find(|item| i128::from(item.value) == value).map(|item| plain(&item.name))
    };
    match &variable.start {
        None => String::new(),
        Some(Values::Float(all)) => list(all, |value| number(*value)),
        Some(Values::Integer(all)) => list(all, |value| item(*value).unwrap_or_else(|| value.to_string())),
        Some(Values::Boolean(all)) => list(all, ToString::to_string),
        Some(Values::String(all)) => list(all, |text| format!("\"{}\"", elided(&plain(text), TEXT))),
        Some(Values::Binary(all)) => list(all, |bytes| format!("{} bytes", bytes.len())),
    }
}

fn list<T: PartialEq>(all: &[T], shown: impl Fn(&T) -> String) -> String {
    if let [first, rest @ ..] = all
        && rest.iter().all(|other| other == first)
    {
        return shown(first);
    }
    let mut texts: Vec<String> = all.iter().take(MOST_VALUES).map(shown).collect();
    if all.len() > MOST_VALUES {
        texts.push("…".into());
    }
    texts.join(", ")
}

/// Smallest and largest value; empty if there are none. The largest representable number is not a bound.
pub(super) fn range(variable: &Variable) -> String {
    let bound = |value: Option<f64>| value.filter(|value| value.abs() < f64::MAX).map(number);
    match (bound(variable.min), bound(variable.max)) {
        (None, None) => String::new(),
        (Some(min), None) => format!("≥ {min}"),
        (None, Some(max)) => format!("≤ {max}"),
        (Some(min), Some(max)) => format!("{min} to {max}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short_and_exact() {
        for (value, text) in [
            (0.0, "0"),
            (0.1, "0.1"),
            (-2.5e-5, "-2.5e-5"),
            (2_147_483_647.0, "2147483647"),
            (1e7, "1e7"),
            (1000.0, "1000"),
            (1e300, "1e300"),
            (100.0, "100"),
            (f64::INFINITY, "inf"),
        ] {
            assert_eq!(number(value), text);
            assert_eq!(text.parse::<f64>().unwrap().to_bits(), value.to_bits());
        }
    }

    #[test]
    fn arrays_are_told_by_their_first_values() {
        assert_eq!(list(&[1, 2, 3, 4], ToString::to_string), "1, 2, 3, …");
        assert_eq!(list(&[1, 2, 3], ToString::to_string), "1, 2, 3");
        assert_eq!(list(&[7, 7, 7, 7], ToString::to_string), "7");
    }
}
