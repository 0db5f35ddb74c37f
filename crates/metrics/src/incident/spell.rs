//! Time spans in which a condition holds.

/// Ranges of rows in which `holds`, end exclusive; those apart by at most `gap` rows are one.
pub(super) fn spells(values: &[f64], gap: usize, holds: impl Fn(f64) -> bool) -> Vec<std::ops::Range<usize>> {
    let mut spells: Vec<std::ops::Range<usize>> = Vec::new();
    for (row, _) in values.iter().enumerate().filter(|(_, value)| holds(**value)) {
        match spells.last_mut() {
            Some(last) if row <= last.end + gap => last.end = row + 1,
            _ => spells.push(row..row + 1),
        }
    }
    spells
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_short_gap_parts_nothing() {
        let values = [0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0, 1.0];
        assert_eq!(spells(&values, 0, |value| value > 0.0), [1..2, 4..6, 9..10]);
        assert_eq!(spells(&values, 2, |value| value > 0.0), [1..6, 9..10]);
        assert_eq!(spells(&values, 3, |value| value > 0.0).len(), 1);
        assert_eq!(spells(&[], 3, |value| value > 0.0), []);
    }
}
