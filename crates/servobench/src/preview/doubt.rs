//! A doubtful setting of a scenario that runs nevertheless.

/// A doubtful setting, and its remedy.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Doubt {
    /// Key of the scenario that is to blame: `limits.move_time`, `program.0`.
    pub key: String,
    /// Line, from 1, of the MJCF file that is to blame; without one it is the key itself.
    pub line: Option<u32>,
    /// The doubt, in words.
    pub message: String,
    /// Remedy.
    pub help: String,
}

impl Doubt {
    pub(super) fn new(key: impl Into<String>, message: impl Into<String>, help: impl Into<String>) -> Self {
        Self { key: key.into(), line: None, message: message.into(), help: help.into() }
    }
}
