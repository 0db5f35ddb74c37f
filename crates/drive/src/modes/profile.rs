//! The profile modes: the master gives a target now and then, the drive makes the way to it.
pub mod effort;
pub mod position;
mod ramp;
pub mod velocity;
