//! The file of an FMU, and its start.
use crate::value::Value;
use servobench_config::choices;
use std::path::PathBuf;
use std::time::Duration;

/// A file and its start.
#[derive(Debug, Clone, PartialEq)]
pub struct FmuFile {
    /// The file.
    pub path: PathBuf,
    /// Start values by variable; a value with a unit is converted to that of its variable.
    pub start: Vec<(String, Value)>,
    /// Process that it runs in.
    pub isolation: Isolation,
    /// True if its event mode is used, if it has one (FMI 3.0); otherwise it handles events internally.
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

/// Limits of an FMU in a separate process.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Bounds {
    /// Real time for any one call, loading and initialisation being one.
    pub call_timeout: Duration,
    /// Limit of its private memory, the program's included (B). Files that it maps do not count.
    pub memory: u64,
}

impl Default for Bounds {
    /// A minute, and 2 GiB.
    fn default() -> Self {
        Self { call_timeout: Duration::from_mins(1), memory: 2 << 30 }
    }
}
