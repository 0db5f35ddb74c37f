//! The closed loop: construction from a scenario and an engine, and runs.
//!
//! `machine::Machine::tick` is the whole loop in one function, in execution order, for every caller: a run, a co-simulation, or an
//! external simulation through a [`Stepper`].

mod alarm_watch;
mod axis;
mod bench;
mod closed_loop;
mod coupled;
mod disturbance;
mod error;
mod external;
mod joint_watch;
mod limit_watch;
mod linear;
mod loose_sensors;
mod machine;
mod master_at_rest;
mod network;
mod program;
mod request_watch;
mod run;
mod same_loop;
mod speeds;
mod stability;
mod stepper;
mod thinning;

pub use bench::{Bench, RECORDING_LIMIT, most_channels, run_length};
pub use coupled::{ConnectionDelay, FmuDoubt, FmuOpener, NoFmus, replaces_the_drive};
pub use error::{BuildError, UnusableFmu};
pub use external::{Controller, External};
pub use linear::{AtRest, WiredSensors};
pub use master_at_rest::MasterOverBus;
pub use program::Program;
pub use run::{Failure, Outcome, Reason};
pub use speeds::Speeds;
pub use stability::{Analysis, MasterLoop, MechanicsAtRest, NotAnalysed, analyse_stability, mechanics_at_rest};
pub use stepper::{States, Stepper};
pub use thinning::{selected, thinned};
