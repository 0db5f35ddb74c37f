//! Refusals of an engine in a user's own MJCF file, and their places.
use std::fmt::{self, Display, Formatter};

/// A feature of a user's own MJCF file, or of its use, that an engine does not simulate.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Refusal {
    /// Place of the refusal.
    pub place: RefusedAt,
    /// The refusal, in words.
    pub message: String,
}

/// Place of a refused feature.
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
        /// True for the motor joint.
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
