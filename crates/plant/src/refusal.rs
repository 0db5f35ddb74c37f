//! What an engine refuses in a user's own MJCF file, and where to look.
use std::fmt::{self, Display, Formatter};

/// One thing in a user's own MJCF file, or in what is said of it, that an engine does not simulate.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Refusal {
    /// Where to look.
    pub place: RefusedAt,
    /// What it is, in words.
    pub message: String,
}

/// Where to look for what is refused.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum RefusedAt {
    /// On this line of the file, from 1.
    Line(u32),
    /// At this name of a joint or an actuator, given beside the file.
    Name(String),
    /// At the name of the motor joint or the load joint, whatever engine reads the file.
    Joint {
        /// The name.
        name: String,
        /// Whether it is that of the motor.
        is_motor: bool,
    },
    /// In the file as a whole.
    File,
}

impl Display for Refusal {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

/// All of them in one line.
pub(crate) fn in_one_line(all: &[impl Display]) -> String {
    all.iter().map(ToString::to_string).collect::<Vec<_>>().join("; ")
}
