//! Errors while writing a report.
use servobench_results::JournalError;
use thiserror::Error;

/// Reasons why a report could not be written.
#[derive(Debug, Error)]
pub enum ReportError {
    /// The report cannot be written as JSON.
    #[error("cannot be written as JSON: {0}")]
    Json(#[from] serde_json::Error),
    /// The result of a run cannot be read.
    #[error(transparent)]
    Run(#[from] JournalError),
    /// A table of too many samples.
    #[error(
        "a table of {rows} rows at a sample time of {sample_time:?} s; at most {limit} are written: take a longer sample \
         time"
    )]
    TooManyRows {
        /// Number of rows of the table.
        rows: u64,
        /// Largest number of rows written.
        limit: u64,
        /// Sample time of the plan (s).
        sample_time: f64,
    },
    /// A recording without any signal or channel that a timing diagram shows.
    #[error(
        "there is nothing to draw: no signals are recorded, and none of the channels `setpoint.velocity`, \
         `load.velocity`, `setpoint.position` and `load.position`: name one in `record.channels`"
    )]
    NothingToDraw,
    /// A timing diagram of unknown signals.
    #[error("no signals of `{name}` are recorded; there are {known}")]
    UnknownSource {
        /// Requested source of signals.
        name: String,
        /// Sources that have signals, in words.
        known: String,
    },
    /// A timing diagram of an empty interval.
    #[error(
        "nothing is recorded from {from:?} s to {to:?} s: choose a stretch of at least 1 ns between {start:?} s and {end:?} s"
    )]
    NoSuchTime {
        /// Requested start (s).
        from: f64,
        /// Requested end (s).
        to: f64,
        /// Start of the recording (s).
        start: f64,
        /// End of the recording (s).
        end: f64,
    },
    /// A drawing of an empty part of the move.
    #[error(
        "the move has no time from {from:?} s to {to:?} s: choose a stretch of at least 1 ns between 0 s and {end:?} s"
    )]
    NoTimeOfMove {
        /// Requested start (s).
        from: f64,
        /// Requested end (s).
        to: f64,
        /// End of the move (s).
        end: f64,
    },
    /// A drawing too narrow to read or too wide to print.
    #[error("a drawing of {width} pixels; it is from {least} to {most} pixels wide")]
    Width {
        /// Requested width (pixels).
        width: u32,
        /// Smallest width (pixels).
        least: u32,
        /// Largest width (pixels).
        most: u32,
    },
    /// Error of the operating system.
    #[error(transparent)]
    Io(#[from] std::io::Error),
    /// The JUnit report could not be written.
    #[error("the JUnit report could not be written: {0}")]
    Junit(#[from] quick_junit::SerializeError),
}
