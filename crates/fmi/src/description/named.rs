//! Values of attributes that the standard names.

/// An enumeration of the standard's XML schema.
pub trait Named: Copy + 'static {
    /// All with their names.
    const ALL: &'static [(Self, &'static str)];

    /// The one of this name.
    #[must_use]
    fn from_name(name: &str) -> Option<Self> {
        Self::ALL.iter().find(|(_, known)| *known == name).map(|(value, _)| *value)
    }

    /// Its name in the XML schema.
    #[must_use]
    fn name(self) -> &'static str
    where
        Self: PartialEq,
    {
        Self::ALL.iter().find(|(value, _)| *value == self).map_or("", |(_, name)| name)
    }
}

/// "a", "b" or "c".
pub(crate) fn one_of<'a>(names: impl IntoIterator<Item = &'a str>) -> String {
    let mut names: Vec<String> = names.into_iter().map(|name| format!("`{name}`")).collect();
    let Some(last) = names.pop() else { return "none".into() };
    if names.is_empty() { last } else { format!("{} or {last}", names.join(", ")) }
}
