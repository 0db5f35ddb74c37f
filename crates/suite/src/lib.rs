//! Many scenarios: expansion into jobs, parallel workers, isolation, comparison.

mod check;
mod compare;
mod engines;
mod error;
mod execute;
mod job;
mod judged;
mod limits;
mod panicked;
mod pool;
mod preview;
mod question;
mod requirements;
mod time_limit;
mod usage;
pub mod worker;

pub use check::{Exchange, Objection, check, exchange};
pub use compare::{
    CompareError, EqualError, EqualQuantity, Equalized, Measuring, NotReached, Slowed, comparable, equal_length,
    equal_metric, limits_agree, only_setpoints_differ, reseeded, setpoints_have_closed_form, to_duration, to_equal,
    to_equal_duration,
};
pub use engines::{EngineMissing, Engines};
pub use error::RunError;
pub use execute::{Broken, Run, execute};
pub use job::{Job, JobIds, Source, file_name, jobs};
pub use judged::judge;
pub use limits::channel_limits;
pub use panicked::Panicked;
pub use pool::{AtATime, map_in_parallel};
pub use preview::{
    Cost, Delay, Demand, Doubt, EffortDemand, EngineSteps, Inertias, LoopBandwidth, LoopStability, Modes,
    PlannedProgram, Preview, VoltageDemand, check_warnings, preview,
};
pub use requirements::instability;
pub use usage::{LoadMode, Usage, limits_of_set_point, load_mode, longest_move};
pub use worker::{RunLimits, WorkerCommand, WorkerError, Workers};
