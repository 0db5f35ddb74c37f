//! What can go wrong on the way to Rerun.
use std::path::PathBuf;
use thiserror::Error;

/// Why a recording was not shown.
#[derive(Debug, Error)]
pub enum ViewError {
    /// Nothing to compare.
    #[error("a comparison needs at least two runs, got {found}; a single run is written by `write_rrd`")]
    TooFewRuns {
        /// Number of runs given.
        found: usize,
    },
    /// A label cannot be the first part of an entity path.
    #[error(
        "run {number} of the comparison has the label `{label}`, which {reason}; give every run its own short label"
    )]
    Label {
        /// Which run, from 1.
        number: usize,
        /// Rejected label.
        label: String,
        /// Why it was rejected.
        reason: &'static str,
    },
    /// Rerun refused.
    #[error("rerun cannot {action}: {reason}")]
    Rerun {
        /// What was tried.
        action: &'static str,
        /// Rerun's reason.
        reason: String,
    },
    /// The operating system refused.
    #[error("cannot write `{}`: {source}", .path.display())]
    Io {
        /// File that was to be written.
        path: PathBuf,
        /// The system's reason.
        source: std::io::Error,
    },
}

impl ViewError {
    /// For `map_err`: what was tried, then Rerun's error.
    pub(crate) fn rerun<E: std::fmt::Display>(action: &'static str) -> impl Fn(E) -> Self {
        move |error| Self::Rerun { action, reason: error.to_string() }
    }
}
