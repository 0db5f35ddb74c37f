//! Errors of writing and reading recordings.
use servobench_files::{quoted, with_short_quotes};
use std::path::PathBuf;
use thiserror::Error;

/// Reasons why a recording was not written or read.
#[derive(Debug, Error)]
pub enum TraceError {
    /// The operating system refused.
    #[error("cannot {action} `{}`: {source}", .path.display())]
    Io {
        /// Action that failed: `create`, `write`, `put in its place`, `read`.
        action: &'static str,
        /// File it was tried on.
        path: PathBuf,
        /// The system's reason.
        source: std::io::Error,
    },
    /// The Parquet writer refused.
    #[error("cannot encode `{}`: {reason}", .path.display())]
    Encode {
        /// File that was to be written.
        path: PathBuf,
        /// The writer's reason.
        reason: String,
    },
    /// Two columns would have the same name.
    #[error("channel `{name}` cannot be written: the name is taken by {by}; every channel needs its own name")]
    NameTaken {
        /// Name of the channel.
        name: String,
        /// Owner of the name.
        by: &'static str,
    },
    /// Channels differ in length.
    #[error(
        "channel `{name}` has {found} values where the first channel has {expected}; all channels are sampled together"
    )]
    UnequalLength {
        /// Channel that differs.
        name: String,
        /// Number of its values.
        found: usize,
        /// Number of values in the first channel.
        expected: usize,
    },
    /// The file is not a Parquet file.
    #[error("`{}` is not a Parquet file: {}", .path.display(), with_short_quotes(.reason))]
    NotParquet {
        /// The file.
        path: PathBuf,
        /// Reason of the decoder.
        reason: String,
    },
    /// A Parquet file, but not one of ours, or not all of it.
    #[error("`{}` is not a recording of servobench: it lacks {missing}", .path.display())]
    Missing {
        /// The file.
        path: PathBuf,
        /// The missing part: a metadata key or a column.
        missing: String,
    },
    /// Written by another version.
    #[error(
        "`{}` has the recording format `{}`, {} than the formats {former} and {known} that this build reads; run its \
         scenario again, or use the servobench that wrote it",
        .path.display(), quoted(.found), age(found, former)
    )]
    Format {
        /// The file.
        path: PathBuf,
        /// Format found in the file.
        found: String,
        /// Former format, which this build reads.
        former: &'static str,
        /// Format that this build reads and writes.
        known: &'static str,
    },
    /// The file's content is not as it was written.
    #[error("`{}` is damaged or was edited: {reason}; write it again by running its scenario", .path.display())]
    Damaged {
        /// The file.
        path: PathBuf,
        /// The mistake, in words.
        reason: String,
    },
}

/// Age of an unknown format relative to those that are read.
fn age(found: &str, former: &str) -> &'static str {
    match (found.parse::<u32>(), former.parse::<u32>()) {
        (Ok(found), Ok(former)) if found < former => "older",
        (Ok(_), Ok(_)) => "newer",
        _ => "of another kind",
    }
}
