//! The signals of an axis: what a run records at every tick, what FMUs are wired to, what metrics are made of and viewers show.
//!
//! The [list](Signal) has a line for each: name, unit, writer, when there is one, meaning, and how it follows from an [`Instant`].
mod equipment;
mod instant;
mod selection;
mod signal;
mod unit;

pub use equipment::{Amplifier, Equipment, Erring, InverterEffects, Motor, MotorEffects, Presence, Rates, Writer};
pub use instant::{Alarms, Instant, PerLimit};
pub use selection::{NotRecorded, Selection};
pub use signal::{Signal, UnknownSignal, write_row};
pub use unit::Unit;
