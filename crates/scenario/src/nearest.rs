//! The name that was probably meant.

/// The candidate nearest to `name`, when one is near: differing in case only, or in at most a third of its letters.
pub(crate) fn nearest<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let lower = name.to_lowercase();
    let letters = name.chars().count();
    candidates
        .into_iter()
        .map(|candidate| {
            let other = candidate.to_lowercase();
            let changes = strsim::damerau_levenshtein(&lower, &other);
            // A name cut short or drawn out is near whatever its length.
            let contained = letters >= 3 && (other.starts_with(&lower) || lower.starts_with(&other));
            let near = changes <= letters.max(candidate.chars().count()) / 3 || contained;
            (changes, near, candidate)
        })
        .filter(|(_, near, _)| *near)
        .min_by_key(|(changes, ..)| *changes)
        .map(|(.., candidate)| candidate)
}

/// "did you mean `x`?", or a list of all candidates when none is near.
pub(crate) fn suggestion<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str> + Clone) -> String {
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
    fn without_a_near_name_all_are_listed() {
        assert_eq!(suggestion("mas", KEYS), "did you mean `mass`?");
        assert_eq!(suggestion("colour", KEYS), "known here: `stiffness`, `damping`, `mass`, `viscous`");
    }
}
