//! The drive profile CiA 402 (IEC 61800-7-201), for both sides: the master and the drive.
//!
//! `no_std`, no heap. Objects are cited by their index, as in 6041h. A master brings the drive to Operation enabled:
//!
//! ```
//! use servobench_cia402::{
//!     Command, Controlword, DriveFunction, PowerInputs, PowerMemory, PowerParams, PowerState, Statusword, step,
//! };
//!
//! let (params, mut memory) = (PowerParams::default(), PowerMemory::default());
//! let inputs = PowerInputs { initialised: true, remote: true, main_voltage: true, ..PowerInputs::default() };
//! for command in [Command::DisableVoltage, Command::Shutdown, Command::SwitchOn, Command::EnableOperation] {
//!     step(&params, &mut memory, Controlword::of(command), inputs);
//! }
//! assert_eq!(memory.state(), PowerState::OperationEnabled);
//!
//! let outputs = step(&params, &mut memory, Controlword::of(Command::QuickStop), inputs);
//! assert_ne!(outputs.drive, DriveFunction::Follow);
//! // The word for the master.
//! let word = Statusword::from_bits(outputs.statusword.bits());
//! assert_eq!(word.state(), Some(PowerState::QuickStopActive));
//! ```
#![cfg_attr(not(test), no_std)]

mod controlword;
pub mod counter;
mod error_code;
pub mod interpolated;
mod machine;
mod mode;
pub mod modulo;
pub mod objects;
mod option_code;
mod process_data;
mod sdo;
mod sequence;
mod state;
mod statusword;
pub mod touch_probe;
mod transitions;
pub mod units;

pub use controlword::{Command, ControlBit, Controlword};
pub use error_code::{ErrorCode, Source};
pub use machine::{DriveFunction, PowerInputs, PowerMemory, PowerOutputs, PowerParams, step};
pub use mode::Mode;
pub use option_code::{
    Deceleration, DisableOperationOption, FaultReactionOption, HaltOption, OptionCodeError, QuickStopOption,
    ShutdownOption,
};
pub use process_data::{Actuals, Commands, InterpolationData};
pub use sdo::{AbortCode, SdoError, Side};
pub use sequence::{Next, keeping, towards};
pub use state::PowerState;
pub use statusword::{StatusBit, Statusword};
pub use transitions::{Cause, TRANSITIONS, Transition};
