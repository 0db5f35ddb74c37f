//! A servo drive's firmware: position, velocity and current loops, feedforward, limits.
//!
//! Knows the plant only through [`Sensors`] and its own estimated parameters. `no_std`, no heap: the same code would
//! run on the drive.
#![cfg_attr(not(test), no_std)]

pub mod current;
mod delay;
pub mod feedforward;
mod firmware;
pub mod velocity;

pub use delay::DelayLine;
pub use firmware::{Command, Feedback, Firmware, Params, Sensors, Stage, Telemetry};
