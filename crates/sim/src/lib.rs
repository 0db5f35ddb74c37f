//! The closed loop: builds it from a scenario and an engine, and runs it.
//!
//! [`Bench::run`] is the whole loop in one function, in execution order.

mod bench;
mod closed_loop;
mod coupled;
mod disturbance;
mod error;
mod joint_watch;
mod limit_watch;
mod network;
mod power;
mod program;
mod recorded;
mod run;
mod stability;
mod stepper;
mod thinning;

pub use bench::Bench;
pub use coupled::{ConnectionDelay, NoPartners, Partners};
pub use error::{BuildError, UnusableFmu};
pub use network::Unsendable;
pub use program::Program;
pub use run::{Failure, Outcome, Reason};
pub use stability::{Analysis, NotAnalysed, analyse_stability};
pub use stepper::{Binding, Controller, External, Snapshot, States, Stepper};
pub use thinning::{selected, thinned};
