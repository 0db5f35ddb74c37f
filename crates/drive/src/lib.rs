//! A servo drive's firmware: position, velocity and current loops, feedforward, limits.
//!
//! Knows the plant only through [`Sensors`] and its own estimated parameters. `no_std`, no heap: the same code would
//! run on the drive.
#![cfg_attr(not(test), no_std)]

mod blocks;
pub mod cogging;
pub mod current;
pub mod delay;
mod demand;
pub mod derivative;
pub mod device;
mod estimate;
pub mod feedforward;
pub mod filter;
mod firmware;
mod linearised;
pub mod measurement;
pub mod modes;
pub mod overload;
mod params;
pub mod position;
pub mod schedule;
pub mod supervision;
pub mod unwrap;
pub mod velocity;

pub use blocks::{Blocks, Parameter as BlockParameter};
pub use demand::{Demand, EffortLimits, Offsets};
pub use estimate::{EffortFeedforward, Estimate};
pub use firmware::{Feedback, Held, Sensors, State, step};
pub use params::{Parameter, Params, Stage};
pub use servobench_config::ParameterError;
