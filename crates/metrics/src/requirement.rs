//! What every run is held to beside its limits, unless its scenario lifts it by name.
use std::fmt;
use std::str::FromStr;

/// Declares [`Requirement`] once: variant, name in files, meaning in a few words.
macro_rules! requirements {
    ($($variant:ident $text:literal $meaning:literal,)*) => {
        /// What every run is held to unless its scenario lifts it; the order is the order of tables.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum Requirement {
            $(#[doc = $meaning] $variant,)*
        }

        impl Requirement {
            /// Every requirement, in the order of tables.
            pub const ALL: &'static [Self] = &[$(Self::$variant,)*];

            /// Name in scenario files and results.
            #[must_use]
            pub const fn as_str(self) -> &'static str {
                match self { $(Self::$variant => $text,)* }
            }

            /// Meaning in a few words.
            #[must_use]
            pub const fn meaning(self) -> &'static str {
                match self { $(Self::$variant => $meaning,)* }
            }
        }
    };
}

requirements! {
    Arrives "arrives" "the last target of each sequence of moves is reached",
    Executed "executed" "every call of a function block is executed and ends without an error",
    NoFault "no_fault" "axis, drive and link have no fault but those that are expected",
    Stable "stable" "the loop is stable, and no oscillation grows or goes from limit to limit",
    Bounded "bounded" "positions stay finite and within a multiple of the range of the program",
}

impl fmt::Display for Requirement {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.as_str())
    }
}

impl FromStr for Requirement {
    type Err = ();

    fn from_str(text: &str) -> Result<Self, ()> {
        Self::ALL.iter().copied().find(|one| one.as_str() == text).ok_or(())
    }
}

/// How a run stands to a requirement.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Standing {
    /// It is met.
    Met,
    /// It is not: why, at least one reason, each in a sentence.
    Broken(Vec<String>),
    /// The scenario lifts it; what would have broken it, if anything.
    Lifted(Vec<String>),
    /// It has no meaning in this run: a program without calls, an axis without a drive.
    NotAsked,
}

/// A fault that the scenario expects.
#[derive(Debug, Clone, PartialEq)]
pub struct Expectation {
    /// State or error code: `ErrorStop`, `8611h`, the `ErrorID` of a block.
    pub fault: String,
    /// Whose: `axis`, `drive`, `link`, or the name of a call.
    pub who: String,
    /// From when on it may come (s).
    pub from: f64,
    /// Until when it must have come (s); infinite: by the end of the run.
    pub to: f64,
}

/// An expectation, and whether it was met.
#[derive(Debug, Clone, PartialEq)]
pub struct Expected {
    /// What was expected.
    pub expectation: Expectation,
    /// When it came (s); `None`: it did not.
    pub met: Option<f64>,
}

/// `8611h of the drive`, with the window of time where there is one
impl fmt::Display for Expectation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { fault, who, from, to } = self;
        write!(f, "{fault} of `{who}`")?;
        match (*from > 0.0, to.is_finite()) {
            (false, false) => Ok(()),
            (true, false) => write!(f, " from {from} s on"),
            (false, true) => write!(f, " until {to} s"),
            (true, true) => write!(f, " from {from} s to {to} s"),
        }
    }
}
