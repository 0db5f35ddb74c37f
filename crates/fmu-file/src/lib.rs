//! An FMU as a simulation names it: its file, its start, the process it runs in, the numbers exchanged, and mistakes in any of these. Plain
//! data: the crate `fmi` opens and calls an FMU.

pub mod bits;
mod file;
mod mistake;
mod port;
mod value;

pub use file::{Bounds, FmuFile, Isolation, IsolationKind};
pub use mistake::{FmuEntry, FmuMistake};
pub use port::{SiPort, SiUnit};
pub use value::Value;
