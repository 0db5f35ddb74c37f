//! The signals of an axis: recorded at every tick of a run, wired to FMUs, used by metrics and shown by viewers.
//!
//! The [list](Signal) has a line for each: name, unit, writer, presence, meaning, and its computation from an [`Instant`].
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
