//! Programs to start, and their limits.
use std::ffi::OsString;
use std::path::PathBuf;

/// A program that calls [`contain`](crate::contain): most simply the same one again.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Program {
    /// The program.
    pub program: PathBuf,
    /// Arguments that make it call `contain`.
    pub args: Vec<OsString>,
    /// Additions to the environment of this process: libraries of Python FMUs need `LD_PRELOAD`, the simulation does not.
    pub env: Vec<(OsString, OsString)>,
}

/// Limits of a contained process.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Limits {
    /// Memory of the process and of all that it starts (B): private and shared. Files that it maps do not count.
    pub memory: u64,
    /// True if its code is foreign: then it gets a separate PID namespace where the system allows that.
    pub is_foreign: bool,
}
