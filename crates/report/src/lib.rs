//! Reports of runs for people and programs: tables, comparison in words, JUnit, the drawing of a plan,
//! the timing diagram of a run, the results of a sweep, the object dictionary of a drive, the contents of an FMU.
//!
//! Reports of runs are made from [`Results`](servobench_results::Results), which contain nothing that differs between two runs of the same
//! scenario: no wall-clock time, no host. So every text here is the same to the byte, too.

mod advice;
mod bound_limits;
mod columns;
mod compare;
mod denied;
mod drawing;
mod error;
mod failures;
mod fmu_table;
mod junit;
mod metric_table;
mod object_table;
mod plan;
mod row_notes;
mod said;
mod style;
mod sweep;
mod text;
mod timing;
mod verdict_table;

pub use advice::{AdviceOptions, advice_json, advice_text};
pub use columns::two_columns;
pub use compare::{Compared, Comparison, Noise};
pub use denied::{Denied, denials};
pub use error::ReportError;
pub use fmu_table::fmu_table;
pub use junit::junit;
pub use object_table::object_table;
pub use plan::{PlannedMove, PointChoice, Unsent};
pub use style::{Style, painted, shown};
pub use sweep::{SweepOptions, sweep_front, sweep_map, sweep_table};
pub use text::{elided, wrapped};
pub use timing::{TimingOptions, timing_diagram};
pub use verdict_table::{brief, run_count, verdict_table};
