//! A servo drive's firmware: position, velocity and current loops, feedforward, limits.
//!
//! Accesses the plant only through [`Sensors`] and its own estimated parameters. `no_std`, no heap: the same code would run on the drive.
#![cfg_attr(not(test), no_std)]

mod blocks;
pub mod current;
pub mod delay;
mod demand;
pub mod device;
mod estimate;
pub mod feedforward;
mod firmware;
mod linearised;
pub mod modes;
mod params;
pub mod unwrap;
pub mod velocity;

pub use blocks::*;
pub use demand::{Demand, EffortLimits, Offsets};
pub use estimate::{EffortFeedforward, Estimate};
pub use firmware::{Feedback, Held, Sensors, State, step};
pub use params::{Parameter, Params, Stage};
pub use servobench_config::ParameterError;
