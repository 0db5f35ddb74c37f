//! An FMU as a simulation names it: which file, how it is started, where it runs, which numbers are exchanged, and mistakes in any of
//! these. Plain data: what opens and calls an FMU is the crate `fmi`.

pub mod bits;
mod file;
mod mistake;
mod port;
mod value;

pub use file::{Bounds, FmuFile, Isolation, IsolationKind};
pub use mistake::{FmuEntry, FmuMistake};
pub use port::{SiPort, SiUnit};
pub use value::Value;
