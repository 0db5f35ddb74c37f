//! Errors on the way to Rerun.
use servobench_view_request::LabelError;
use thiserror::Error;

/// Reasons why a recording was not shown.
#[derive(Debug, Error)]
pub enum ViewError {
    /// Nothing to compare.
    #[error("a comparison needs at least two runs, got {found}; a single run has no label")]
    TooFewRuns {
        /// Number of runs given.
        found: usize,
    },
    /// The number of labels differs from that of the runs.
    #[error("{recordings} recordings and {labels} labels: several recordings need a label each, a single one has none")]
    Labels {
        /// Number of labels.
        labels: usize,
        /// Number of recordings.
        recordings: usize,
    },
    /// A label cannot be the first part of an entity path.
    #[error(transparent)]
    Label(#[from] LabelError),
    /// Rerun reported an error.
    #[error("rerun cannot {action}: {reason}")]
    Rerun {
        /// The attempted action.
        action: &'static str,
        /// Rerun's reason.
        reason: String,
    },
}

impl ViewError {
    /// For `map_err`: the attempted action, then Rerun's error.
    pub(crate) fn rerun<E: std::fmt::Display>(action: &'static str) -> impl Fn(E) -> Self {
        move |error| Self::Rerun { action, reason: error.to_string() }
    }
}
