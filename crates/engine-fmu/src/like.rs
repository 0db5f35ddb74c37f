//! Similar names, for messages.

/// Greatest number of names.
const MOST: usize = 5;

/// Names of `all` that contain `name` or are contained in it, ignoring case; the first ones if there are none.
pub(crate) fn like<'a>(name: &str, all: impl Iterator<Item = &'a str>) -> Vec<&'a str> {
    let name = name.to_lowercase();
    let is_like = |other: &str| other.contains(&name) || name.contains(other);
    let all: Vec<&str> = all.collect();
    let close: Vec<&str> = all.iter().copied().filter(|one| is_like(&one.to_lowercase())).collect();
    let shown = if close.is_empty() { all } else { close };
    shown.into_iter().take(MOST).collect()
}
