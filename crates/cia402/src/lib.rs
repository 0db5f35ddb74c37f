//! The drive profile CiA 402 (IEC 61800-7-201) as both sides see it, the master and the drive.
//!
//! `no_std`, no heap. Objects are cited by their index, as in 6041h.
#![cfg_attr(not(test), no_std)]

mod controlword;
pub mod counter;
pub mod difference;
mod machine;
mod option_code;
mod state;
mod statusword;
mod transitions;
pub mod units;

pub use controlword::{Command, ControlBit, Controlword};
pub use machine::{DriveFunction, PowerInputs, PowerMemory, PowerOutputs, PowerParams, step};
pub use option_code::{
    Deceleration, DisableOperationOption, FaultReactionOption, HaltOption, OptionCodeError, QuickStopOption,
    ShutdownOption,
};
pub use state::PowerState;
pub use statusword::{StatusBit, Statusword};
pub use transitions::{Cause, TRANSITIONS, Transition};
