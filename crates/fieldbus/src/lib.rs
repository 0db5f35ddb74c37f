//! Link between a motion task and a drive.
//!
//! - [`AxisCommand`] and [`AxisFeedback`]: exchange between motion task and axis, once per cycle of that task.
//! - [`link`]: conversion between these and the process data of a drive (CiA 402), once per cycle of the bus.
//! - [`bus`]: the bus to the drive, and its faults.
//! - [`task`]: schedule of the motion task, and its faults.
//! - `trajectory` (feature `trajectory`, with a heap): transfer of tables to the buffer of a drive.
//!
//! `no_std`, and no heap without that feature.
//!
//! ```
//! use servobench_base::{Rate, Tick};
//! use servobench_cia402::counter::Counter;
//! use servobench_cia402::Commands;
//! use servobench_fieldbus::link::{self, Control, Input, Mailbox, Params, Sequencing, Settings, Units};
//! use servobench_fieldbus::{AxisCommand, Task};
//! use servobench_motion::Limits;
//! use servobench_motion::interpolate::{Mode, Sample};
//!
//! let base_rate = Rate::from_hertz(16e3)?;
//! let params = Params::new(Settings {
//!     base_rate,
//!     bus_cycle: base_rate.divider(Rate::from_hertz(1e3)?)?,
//!     motion_cycle: base_rate.divider(Rate::from_hertz(50.0)?)?,
//!     interpolation: Mode::Quintic,
//!     margin: 16,
//!     run_ahead: 0,
//!     control: Control::Position { velocity_offset: true, torque_offset: true },
//!     sequencing: Sequencing::Strict,
//!     drive_timeout: 1600,
//!     round_trip: 2,
//!     answer_age: 0,
//!     reverse_switches: false,
//!     // A thousand counts are a millimetre.
//!     units: Units {
//!         drive_units: 1e6,
//!         axis_units: 1.0,
//!         velocity_factor: 1.0,
//!         rated_effort: 2.4,
//!         counter: Counter::signed(32)?,
//!     },
//!     velocity_from_differences: false,
//!     recovery: Limits { velocity: 0.1, acceleration: 2.0, jerk: 100.0, snap: 0.0 },
//!     velocity_limit: 1.0,
//! })?;
//! assert_eq!(params.delay(), 320 + 16);
//!
//! let (mut state, mut mailbox) = (link::State::default(), Mailbox::default());
//! mailbox.write(Tick(0), AxisCommand::of(Task::Follow(Sample::default())));
//! let input = Input { tick: Tick(0), mailbox: &mailbox, actuals: None, external_fault: false };
//! let commands: Commands = link::step(&params, &mut state, input);
//! assert_eq!(commands.mode, 8);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
#![cfg_attr(not(test), no_std)]
#[cfg(feature = "trajectory")]
extern crate alloc;

mod axis;
pub mod bus;
mod error;
mod fault;
mod interpolation;
pub mod link;
mod probe;
pub mod task;
#[cfg(feature = "trajectory")]
pub mod trajectory;

pub use axis::{
    AxisCommand, AxisFeedback, Homing, Power, ProfileCommand, ProfileFeedback, Switches, Task, TrajectoryPoint,
};
pub use error::FieldbusError;
pub use fault::{Fault, LinkFault};
pub use interpolation::Interpolation;
pub use probe::{ProbeFeedback, ProbeTrigger, TouchProbe};
