//! Why a report could not be written.
use servobench_results::JournalError;
use thiserror::Error;

/// Why a report could not be written.
#[derive(Debug, Error)]
pub enum ReportError {
    /// It cannot be written as JSON.
    #[error("cannot be written as JSON: {0}")]
    Json(#[from] serde_json::Error),
    /// The result of a run cannot be read.
    #[error(transparent)]
    Run(#[from] JournalError),
    /// A table of samples that nobody can read.
    #[error(
        "a table of {rows} rows at a sample time of {sample_time:?} s; at most {limit} are written: take a longer sample \
         time"
    )]
    TooManyRows {
        /// Rows that it would have.
        rows: u64,
        /// Most rows that are written.
        limit: u64,
        /// Sample time of the plan (s).
        sample_time: f64,
    },
    /// A recording without anything that a timing diagram shows.
    #[error(
        "there is nothing to draw: no signals are recorded, and none of the channels `setpoint.velocity`, \
         `load.velocity`, `setpoint.position` and `load.position`: name one in `record.channels`"
    )]
    NothingToDraw,
    /// A timing diagram of signals that are not there.
    #[error("no signals of `{name}` are recorded; there are {known}")]
    UnknownSource {
        /// Whose signals were asked for.
        name: String,
        /// Whose signals there are, in words.
        known: String,
    },
    /// A timing diagram of no time.
    #[error(
        "nothing is recorded from {from:?} s to {to:?} s: choose a stretch of at least 1 ns between {start:?} s and {end:?} s"
    )]
    NoSuchTime {
        /// Beginning that was asked for (s).
        from: f64,
        /// End that was asked for (s).
        to: f64,
        /// Beginning of the recording (s).
        start: f64,
        /// End of the recording (s).
        end: f64,
    },
    /// A drawing of no part of the move.
    #[error(
        "the move has no time from {from:?} s to {to:?} s: choose a stretch of at least 1 ns between 0 s and {end:?} s"
    )]
    NoTimeOfMove {
        /// Beginning that was asked for (s).
        from: f64,
        /// End that was asked for (s).
        to: f64,
        /// End of the move (s).
        end: f64,
    },
    /// A drawing too narrow to read or too wide to print.
    #[error("a drawing of {width} pixels; it is from {least} to {most} pixels wide")]
    Width {
        /// Width that was asked for (pixels).
        width: u32,
        /// Narrowest (pixels).
        least: u32,
        /// Widest (pixels).
        most: u32,
    },
    /// The operating system refused.
    #[error(transparent)]
    Io(#[from] std::io::Error),
    /// The JUnit report could not be written.
    #[error("the JUnit report could not be written: {0}")]
    Junit(#[from] quick_junit::SerializeError),
}
