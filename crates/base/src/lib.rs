//! Common types of all crates: time as integers, frames, set-points, parameter errors.
//!
//! `no_std`; depends on no runtime crate of servobench. Plain `f64` in SI, with the unit in the documentation of every item.
#![cfg_attr(not(test), no_std)]

#[cfg(feature = "std")]
extern crate std;
// The derived code can then name this crate as in every other crate.
extern crate self as servobench_base;

mod axis_name;
mod coordinate;
mod ending;
mod frames;
mod held_mode;
mod parameter;
mod power_command;
mod request;
mod setpoint;
mod severity;
mod shortest;
mod sine;
pub mod state;
mod step_end;
mod time;
mod wide_registers;

pub use axis_name::{AxisName, AxisNameError};
pub use coordinate::Coordinate;
pub use ending::Ending;
pub use frames::{AlphaBeta, Dq, ElectricalAngle, KnownRotation, Rotation};
pub use held_mode::HeldMode;
pub use parameter::{ParamError, finite, limit, non_negative, positive};
pub use power_command::PowerCommand;
pub use request::{Request, RequestKind};
pub use setpoint::Setpoint;
pub use severity::Severity;
pub use shortest::Shortest;
pub use state::Stateful;
pub use step_end::StepEnd;
pub use time::{Countdown, Divider, Rate, RateError, Tick};
