//! Many scenarios: expansion into jobs, parallel workers, isolation, comparison.

mod compare;
mod engines;
mod execute;
mod job;
mod pool;
pub mod worker;

pub use compare::to_equal_duration;
pub use engines::{EngineMissing, Engines, Installed};
pub use execute::{Report, RunError, execute};
pub use job::{Job, Source, jobs};
pub use pool::for_each_in_parallel;
pub use worker::WorkerCommand;
