//! Mistakes in a request.
use std::fmt::{self, Display, Formatter};

/// A part of a request that does not fit the file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FmuMistake {
    /// The part of the request.
    pub at: FmuEntry,
    /// The mistake, in words.
    pub message: String,
    /// Remedy; may be empty.
    pub help: String,
}

/// A part of a request.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum FmuEntry {
    /// The file itself.
    File,
    /// Its conduct: it crashed or did not return, which is not a mistake in any data.
    Conduct,
    /// The length of its steps.
    Step,
    /// The use of its event mode.
    EventMode,
    /// The process that it runs in.
    Isolation,
    /// The start value of this variable.
    Start(String),
    /// This input.
    Input(String),
    /// This output.
    Output(String),
}

impl FmuMistake {
    /// A mistake in the file itself.
    #[must_use]
    pub fn of_file(error: &impl Display) -> Self {
        Self { at: FmuEntry::File, message: error.to_string(), help: String::new() }
    }
}

impl Display for FmuMistake {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)?;
        if self.help.is_empty() { Ok(()) } else { write!(f, "; {}", self.help) }
    }
}
