//! PLCopen motion control, part 1 (version 2.0): function blocks and the axis that they command.
//!
//! A PLC cycle is [`Axis::begin`] with the feedback of the axis, the calls of the blocks in the order of the program, and [`Axis::end`],
//! which returns the command to the axis:
//!
//! ```
//! use servobench_fieldbus::AxisFeedback;
//! use servobench_motion::Limits;
//! use servobench_plcopen::{Axis, AxisParams, FunctionBlock, MoveAbsolute, MoveAbsoluteInputs, Power, PowerInputs};
//! let limits = Limits { velocity: 1.0, acceleration: 5.0, jerk: 50.0, snap: 1000.0 };
//! let mut axis = Axis::new(AxisParams { needs_homing: false, ..AxisParams::new(1e-3, limits) })?;
//! let (mut power, mut go) = (Power::default(), MoveAbsolute::default());
//! let feedback = AxisFeedback { power: servobench_fieldbus::Power::On, ..AxisFeedback::default() };
//! for _ in 0..1000 {
//!     axis.begin(&feedback);
//!     let ready = power.step(&mut axis, &PowerInputs { enable: true, ..PowerInputs::default() }).status;
//!     let inputs = MoveAbsoluteInputs { execute: ready, position: 0.25, ..MoveAbsoluteInputs::within(&limits) };
//!     let outputs = go.step(&mut axis, &inputs);
//!     axis.end();
//!     if outputs.done {
//!         break;
//!     }
//! }
//! assert_eq!(axis.commanded().x, 0.25);
//! # Ok::<(), servobench_base::ParamError>(())
//! ```
//!
//! `no_std`, no heap; the feature `program` adds programs, which keep their calls on the heap.
#![cfg_attr(not(test), no_std)]

#[cfg(feature = "program")]
extern crate alloc;

mod arrows;
mod axis;
mod blocks;
mod command;
mod error;
pub mod generator;
mod interface;
mod ledger;
mod list;
mod parameter;
mod params;
#[cfg(feature = "program")]
pub mod program;
mod state;

pub use arrows::{ARROWS, Arrow, Cause};
pub use axis::{Axis, MOST_BUFFERED};
pub use blocks::*;
pub use command::{BufferMode, Command, Direction, Dynamics, Ending, Goal, Reference};
pub use error::{AxisError, BlockError, ErrorId};
pub use interface::{Absent, BlockInput, BlockInputs, InputType, OutputType, Table, Tables, Trigger, Value, Values};
pub use ledger::{CommandId, Progress};
pub use parameter::{AxisBoolParameter, AxisParameter};
pub use params::{AxisParams, RampStart};
pub use state::AxisState;
