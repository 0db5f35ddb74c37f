//! Many scenarios: expansion into jobs, parallel workers, isolation, comparison.

mod check;
mod compare;
mod error;
mod execute;
mod job;
mod pool;
mod time_limit;
pub mod worker;

pub use check::{check, exchange};
pub use compare::{
    CompareError, EqualError, EqualQuantity, Equalized, Measuring, NotReached, Slowed, comparable, equal_length,
    equal_metric, limits_agree, only_setpoints_differ, reseeded, setpoints_have_closed_form, to_duration, to_equal,
    to_equal_duration,
};
pub use error::RunError;
pub use execute::{Broken, execute};
pub use job::{Job, JobIds, Source, file_name, jobs};
pub use pool::{AtATime, map_in_parallel};
pub use worker::{RunLimits, WorkerCommand, WorkerError, Workers};
