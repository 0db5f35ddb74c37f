//! The file, and how it is started.
use crate::value::Value;
use servobench_config::choices;
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
