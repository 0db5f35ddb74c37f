//! What a simulation asks of an FMU: which file, how it is started, where it runs, which numbers are exchanged, and what does not fit.
use crate::description::{DataType, Exponents};
use crate::setup::Value;
use servobench_config::choices;
use std::fmt::{self, Display, Formatter};
use std::path::PathBuf;
use std::time::Duration;

/// A file and how it is started.
#[derive(Debug, Clone, PartialEq)]
pub struct FmuFile {
    /// The file.
    pub path: PathBuf,
    /// Start values by variable; what has a unit is converted to that of its variable.
    pub start: Vec<(String, Value)>,
    /// Where it runs.
    pub isolation: Isolation,
    /// Whether its event mode is used, if it has one (FMI 3.0); otherwise it deals with events by itself.
    pub event_mode: bool,
}

choices! {
    /// Where an FMU runs.
    pub enum Isolation named IsolationKind default Process {
        /// it runs in a process of its own: what it does to itself costs this run only
        Process {
            /// What it may take.
            bounds: Bounds,
        } = "process",
        /// it is trusted and runs in the bench's own process, which is faster
        None = "none",
    }
}

/// What an FMU in a process of its own may take.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Bounds {
    /// Real time for any one call, loading and initialisation being one.
    pub call_timeout: Duration,
    /// Memory that it may have for itself, the program's included (B). Files that it maps do not count.
    pub memory: u64,
}

impl Default for Bounds {
    /// A minute, and 2 GiB.
    fn default() -> Self {
        Self { call_timeout: Duration::from_mins(1), memory: 2 << 30 }
    }
}

/// An FMU as a simulation wants it: initialised and wired, its numbers in SI units.
#[derive(Debug, Clone, PartialEq)]
pub struct FmuRequest<'a> {
    /// The FMU.
    pub file: &'a FmuFile,
    /// Name of the instance; `None`: that of the model.
    pub name: Option<&'a str>,
    /// Inputs that are exchanged.
    pub inputs: Vec<SiPort>,
    /// Outputs that are exchanged.
    pub outputs: Vec<SiPort>,
    /// How long its steps are (s).
    pub step: f64,
    /// When its last step ends (s), if that is known: at the end of the run or after it, since steps are whole.
    pub end: Option<f64>,
    /// Whether it waits in its initialisation for its inputs ([`Slave::start`](crate::Slave::start)).
    pub waits: bool,
}

/// A number that is exchanged with an FMU, in SI units. The FMU has it in the unit of its model description; what has none there
/// counts in SI units.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SiPort {
    /// Name of the variable, or `name[2]`, `name[2,1]` of an element of an array, counted from 1.
    pub variable: String,
    /// What the number is on our side; `None` if it may be anything.
    pub unit: Option<SiUnit>,
}

/// An SI unit.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SiUnit {
    /// As people write it.
    pub name: String,
    /// Exponents of kilogram, metre, second and ampere. The radian, which some count and some do not, is one.
    pub exponents: [i32; 4],
}

/// A number that an FMU exchanges, as its model description declares it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct DeclaredNumber {
    /// Its type.
    pub data_type: DataType,
    /// Its unit, if it has one.
    pub unit: Option<DeclaredUnit>,
}

/// A unit of an FMU.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct DeclaredUnit {
    /// Its name in the description.
    pub name: String,
    /// What it is made of.
    pub exponents: Exponents,
}

impl DeclaredUnit {
    /// True where both measure the same. The radian, which some count and some do not, is one.
    #[must_use]
    pub fn measures_the_same_as(&self, other: &Self) -> bool {
        let without_radian = |exponents| Exponents { rad: 0, ..exponents };
        without_radian(self.exponents) == without_radian(other.exponents)
    }
}

/// What of a request does not fit the file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FmuMistake {
    /// Which part of the request.
    pub at: FmuEntry,
    /// What is wrong.
    pub message: String,
    /// What to do; may be empty.
    pub help: String,
}

/// A part of what is asked of an FMU.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum FmuEntry {
    /// The file itself.
    File,
    /// What it does: it crashed or did not come back, which is nobody's data.
    Conduct,
    /// The length of its steps.
    Step,
    /// Whether its event mode is used.
    EventMode,
    /// Where it runs.
    Isolation,
    /// The start value of this variable.
    Start(String),
    /// This input.
    Input(String),
    /// This output.
    Output(String),
}

impl FmuMistake {
    /// Something that is wrong with the file itself.
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
