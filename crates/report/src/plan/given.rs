//! Quantities in the units in which they were given.

/// A quantity as a user wrote it: `90 deg`, `3000 rpm`.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Given {
    number: f64,
    unit: String,
}

impl Given {
    /// Splits `text` into its number and its unit; `None` when it begins with no number or ends without a unit.
    pub(super) fn read(text: &str) -> Option<Self> {
        let text = text.trim();
        let ends = text.char_indices().map(|(i, c)| i + c.len_utf8());
        let (number, end) = ends.rev().find_map(|end| Some((text[..end].trim_end().parse::<f64>().ok()?, end)))?;
        let unit = text[end..].trim();
        (!unit.is_empty() && number.is_finite()).then(|| Self { number, unit: unit.to_owned() })
    }

    /// `share` of the quantity, to six digits.
    pub(super) fn times(&self, share: f64) -> String {
        format!("{} {}", six_digits(self.number * share), self.unit)
    }
}

/// The number to six significant digits, without zeros at its end.
fn six_digits(value: f64) -> String {
    let rounded: f64 = format!("{value:.5e}").parse().unwrap_or(value);
    // A minus sign before zero reads as a mistake.
    let rounded = if rounded == 0.0 { 0.0 } else { rounded };
    if rounded == 0.0 || (1e-4..1e9).contains(&rounded.abs()) { rounded.to_string() } else { format!("{rounded:e}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quantity_keeps_its_unit() {
        for (text, share, words) in [
            ("90 deg", 1.0, "90 deg"),
            ("-90deg", 1.0, "-90 deg"),
            (" 1e3 m/s4 ", 0.5, "500 m/s4"),
            ("3000 rpm", 1.0 / 3.0, "1000 rpm"),
            ("1 m/s", 2.0 / 3.0, "0.666667 m/s"),
            ("1 m/s", -0.0, "0 m/s"),
            ("4 m/s2", 1e-9, "4e-9 m/s2"),
        ] {
            assert_eq!(Given::read(text).unwrap().times(share), words, "{text}");
        }
        assert!(Given::read("5").is_none() && Given::read("fast").is_none());
    }
}
