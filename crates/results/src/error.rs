//! Why results cannot be read.
use crate::journal::JournalError;
use servobench_files::{named, with_short_quotes};
use std::io;
use thiserror::Error;

/// Why results cannot be read, or written.
#[derive(Debug, Error)]
pub enum ResultsError {
    /// They are no JSON of this schema.
    #[error("the results are not as docs/results.schema.json says: {}", with_short_quotes(&.0.to_string()))]
    Json(#[from] serde_json::Error),
    /// They are of a later version.
    #[error(
        "the results have schema `{found}`, newer than this build, which reads versions 1 to {known}; use the servobench that wrote \
         them, or run the scenarios again"
    )]
    Newer {
        /// Schema of the file.
        found: String,
        /// Newest version that this build reads.
        known: u32,
    },
    /// They are something else.
    #[error("the file has schema `{}`, which is none of servobench's results", named(.found))]
    Schema {
        /// Schema of the file.
        found: String,
    },
    /// Nothing says whether they are as they were written.
    #[error("the results have no digest, by which an edited file is recognised: an earlier version wrote them")]
    Unsealed,
    /// They are not as they were written.
    #[error("the results are not those that were written: their digest is another one")]
    Edited,
    /// What the journal holds of a run cannot be read.
    #[error(transparent)]
    Journal(#[from] JournalError),
    /// The operating system does not let them be written.
    #[error("the results cannot be written: {0}")]
    Write(#[source] io::Error),
    /// The operating system does not let them be read.
    #[error("the results cannot be read: {0}")]
    Read(#[source] io::Error),
}
