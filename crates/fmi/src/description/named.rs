//! Lists of names in messages.

/// "a", "b" or "c".
pub(crate) fn one_of<'a>(names: impl IntoIterator<Item = &'a str>) -> String {
    let mut names: Vec<String> = names.into_iter().map(|name| format!("`{name}`")).collect();
    let Some(last) = names.pop() else { return "none".into() };
    if names.is_empty() { last } else { format!("{} or {last}", names.join(", ")) }
}
