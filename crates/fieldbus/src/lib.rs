//! Between a motion task and a drive.
//!
//! `no_std`, no heap.
#![cfg_attr(not(test), no_std)]

mod axis;
mod fault;
mod interpolation;

pub use axis::{AxisCommand, AxisFeedback, Homing, Power, Switches, Task};
pub use fault::{Fault, LinkFault};
pub use interpolation::Interpolation;
