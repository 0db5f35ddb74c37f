//! The nearest existing name to one that does not exist.

/// The candidate nearest to `name`, when one is near: differing in case only, or in at most a third of its letters.
#[must_use]
pub fn nearest<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let lower = name.to_lowercase();
    candidates
        .into_iter()
        .filter_map(|candidate| changes(&lower, &candidate.to_lowercase()).map(|changes| (changes, candidate)))
        .min_by_key(|(changes, _)| *changes)
        .map(|(_, candidate)| candidate)
}

/// Number of edits that turn one into the other, if they are similar.
fn changes(name: &str, other: &str) -> Option<usize> {
    let (letters, others) = (name.chars().count(), other.chars().count());
    let (difference, most) = (letters.abs_diff(others), letters.max(others) / 3);
    // A shortened or extended name is similar whatever its length.
    if letters >= 3 && (other.starts_with(name) || name.starts_with(other)) {
        return Some(difference);
    }
    // Each surplus letter is an edit: names of very different length need no comparison.
    let changes = (difference <= most).then(|| strsim::damerau_levenshtein(name, other));
    changes.filter(|changes| *changes <= most)
}

/// "did you mean `x`?", or a list of all candidates when none is near.
#[must_use]
pub fn suggestion<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str> + Clone) -> String {
    if let Some(near) = nearest(name, candidates.clone()) {
        return format!("did you mean `{near}`?");
    }
    let all: Vec<String> = candidates.into_iter().map(|name| format!("`{name}`")).collect();
    if all.is_empty() { String::new() } else { format!("known here: {}", all.join(", ")) }
}

#[cfg(test)]
mod tests {
    use super::*;

    const KEYS: [&str; 4] = ["stiffness", "damping", "mass", "viscous"];

    #[test]
    fn slips_of_the_finger_and_of_case_are_near() {
        for (wrong, right) in [("stifness", "stiffness"), ("Mass", "mass"), ("dampign", "damping"), ("visc", "viscous")]
        {
            assert_eq!(nearest(wrong, KEYS), Some(right));
        }
        assert_eq!(nearest("colour", KEYS), None);
    }

    #[test]
    fn a_name_cut_short_or_drawn_out_is_near() {
        assert_eq!(nearest("damp", KEYS), Some("damping"));
        assert_eq!(nearest("massoftheload", KEYS), Some("mass"));
        assert_eq!(nearest("ma", KEYS), None, "two letters say too little");
    }

    #[test]
    fn a_name_that_is_very_long_is_not_compared() {
        assert_eq!(nearest(&"q".repeat(10_000_000), KEYS), None);
    }

    #[test]
    fn without_a_near_name_all_are_listed() {
        assert_eq!(suggestion("mas", KEYS), "did you mean `mass`?");
        assert_eq!(suggestion("colour", KEYS), "known here: `stiffness`, `damping`, `mass`, `viscous`");
    }
}
