//! Results of a suite of runs on disk, and their recovery after a crash.
//!
//! | data | type |
//! |---|---|
//! | result of one run | [`RunResult`] |
//! | `results.json`, results of all runs | [`Results`] |
//! | `results.journal`, which grows while they run | [`Journal`] |
//! | results of a running suite: in the journal, as long as that can be written | [`Kept`] |
//! | results one after the other, in the journal or in memory | [`Runs`] |
//! | measurements of all runs, a column for each metric | [`Columns`] |
//! | folder of both files, for one suite at a time | [`Folder`] |
//!
//! This crate is independent of how runs are made. Neither clock nor host is part of a result, so that equal suites give equal bytes;
//! only the journal has the duration of each run.

mod columns;
mod digest;
mod entry;
mod error;
mod folder;
mod journal;
mod kept;
mod planned;
mod printable;
mod results;
mod run;
mod runs;
#[cfg(any(test, feature = "samples"))]
pub mod samples;
mod written;

pub use columns::{Columns, MetricColumn};
pub use digest::{Digest, Digester};
pub use entry::{ExpectedResult, MetricResult, MoveResult};
pub use error::ResultsError;
pub use folder::{
    COMPARISON, Folder, FolderError, Former, JOURNAL, OF_A_SWEEP, RESULTS, SWEEP_FRONT, SWEEP_MAP, TABLE_CSV,
    TABLE_PARQUET, is_table_of_a_sweep,
};
pub use journal::{Finished, Journal, JournalError, Place, Suite, read as read_journal};
pub use kept::Kept;
pub use planned::Planned;
pub use printable::{printable, printable_json, printable_lines};
pub use results::{Outcome, Results, Status, Unfinished, files_of_results, read_results};
pub use run::{LimitPlace, RunIdentity, RunResult};
pub use runs::{RunHead, Runs};
pub use written::write_results;
