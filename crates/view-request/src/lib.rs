//! Request of the program `servobench` to the program `servobench-view`, which alone links Rerun.
//!
//! ```text
//! servobench-view RECORDING.parquet …  < request (JSON)  > drawn.rrd
//! ```
//! The recordings are the arguments. Standard input has everything to be shown that is not in them: labels, verdicts, limits, the motor.
//! Empty input stands for a request without any of these. `docs/viewer.md` describes the JSON.

mod label;
mod motor;
mod options;
mod request;

pub use label::{LabelError, RESERVED, check_labels};
pub use motor::MotorLimits;
pub use options::{Outcome, Verdict, ViewOptions};
pub use request::{Request, RequestError};

/// Name of the program that draws.
pub const PROGRAM: &str = "servobench-view";

/// First argument when `servobench` starts it: then it is contained, and all other arguments are recordings.
pub const CONTAINED: &str = "--contained";

/// Its answer to `--version`, which names the build that it belongs to.
pub const VERSION: &str = concat!("servobench-view ", env!("CARGO_PKG_VERSION"));
