//! Errors while reading or writing results.
use crate::journal::JournalError;
use servobench_files::{named, with_short_quotes};
use std::io;
use thiserror::Error;

/// Reasons why results cannot be read or written.
#[derive(Debug, Error)]
pub enum ResultsError {
    /// The text is not JSON of this schema.
    #[error("the results are not as docs/results.schema.json says: {}", with_short_quotes(&.0.to_string()))]
    Json(#[from] serde_json::Error),
    /// The results are of a later version.
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
    /// The file is something else.
    #[error("the file has schema `{}`, which is none of servobench's results", named(.found))]
    Schema {
        /// Schema of the file.
        found: String,
    },
    /// The results have no digest to show that they are unchanged.
    #[error("the results have no digest, by which an edited file is recognised: an earlier version wrote them")]
    Unsealed,
    /// The results were changed after they were written.
    #[error("the results are not those that were written: their digest is another one")]
    Edited,
    /// The record of a run in the journal cannot be read.
    #[error(transparent)]
    Journal(#[from] JournalError),
    /// Error of the operating system while writing.
    #[error("the results cannot be written: {0}")]
    Write(#[source] io::Error),
    /// Error of the operating system while reading.
    #[error("the results cannot be read: {0}")]
    Read(#[source] io::Error),
}
