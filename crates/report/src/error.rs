//! Why a report could not be written.
use thiserror::Error;

/// Why a report could not be written or read.
#[derive(Debug, Error)]
pub enum ReportError {
    /// The results are no JSON of this schema.
    #[error("the results are not as docs/results.schema.json says: {0}")]
    Json(#[from] serde_json::Error),
    /// The results have another schema.
    #[error("the results have schema `{found}`; this version reads `{expected}`")]
    Schema {
        /// Schema of the file.
        found: String,
        /// Schema that this version reads.
        expected: &'static str,
    },
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
    /// The operating system refused.
    #[error(transparent)]
    Io(#[from] std::io::Error),
    /// The JUnit report could not be written.
    #[error("the JUnit report could not be written: {0}")]
    Junit(#[from] quick_junit::SerializeError),
}
