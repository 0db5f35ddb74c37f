//! What a suite of runs leaves on disk, and what stays of it after a crash.
//!
//! | what | type |
//! |---|---|
//! | what came of one run | [`RunResult`] |
//! | `results.json`, what came of all of them | [`Results`] |
//! | `results.journal`, which grows while they run | [`Journal`] |
//! | the results of a suite that is under way: in the journal, as long as that can be written | [`Kept`] |
//! | results one after the other, wherever they are kept | [`Runs`] |
//! | what was measured of all of them, a column for each metric | [`Columns`] |
//! | the folder that holds both, for one suite at a time | [`Folder`] |
//!
//! Nothing here knows how a run is made. No clock and no host are part of a result, so that equal suites give equal bytes;
//! the journal alone holds how long a run took.

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
