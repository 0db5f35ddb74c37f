//! What is started, and what it may take.
use std::ffi::OsString;
use std::path::PathBuf;

/// A program that calls [`contain`](crate::contain): most simply the same one again.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Program {
    /// The program.
    pub program: PathBuf,
    /// What tells it that it is to be contained.
    pub args: Vec<OsString>,
    /// What its environment has besides that of this process: libraries of Python FMUs need `LD_PRELOAD`, the simulation does
    /// not.
    pub env: Vec<(OsString, OsString)>,
}

/// What a contained process may take.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Limits {
    /// Memory of it and of all that it starts (B): private and shared. Files that it maps do not count.
    pub memory: u64,
    /// Whether its code is foreign: then it gets a PID namespace of its own where the system allows that.
    pub is_foreign: bool,
}
