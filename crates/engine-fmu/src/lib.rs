//! FMUs in a process of their own, and FMUs as the mechanics of an axis ([`FmuMechanics`]).
//!
//! [`load`] starts one at its place; [`Fmu`] is the engine for an axis, and opens FMUs beside one. The program that hosts FMUs calls [`host`].
//!
//! An FMU is somebody else's native code: it may crash, hang, ask for memory without end or print a gigabyte. In a process of
//! its own that costs its run only, and is reported as what it is.
//!
//! ```text
//! simulation: Isolated ── memory that both see, a doorbell for each direction ── serve: the FMU      (same program, another process)
//!             Contained    ── standard output and error, its end ─────────────┘
//! ```
//! | what the FMU does | what is said |
//! |---|---|
//! | crashes, aborts, calls `exit` | signal or exit code, and the last that it wrote on standard error |
//! | does not come back | which call, after how long; it is ended |
//! | asks for memory without end, private or shared | how much it may have |
//! | prints without end | how much was dropped; the end is kept |
//! | writes over the memory that is shared | that it did; numbers are only numbers there and lengths are cut |
//! | leaves processes behind | which; they are ended |
//!
//! It ends with the simulation, however that ends, and what it has started ends with it; what contains it, and what does not, is the
//! crate `servobench-isolation`. Nothing is left in the file system: the memory is an anonymous file.
//!
//! A process of its own needs Linux. Elsewhere an FMU runs in this process ([`Place::Here`]), or not at all.

mod described;
mod engine;
mod error;
mod host;
mod in_si;
mod isolated;
mod like;
mod load;
mod mechanics;
mod motion;
mod open;
mod order;
mod page;
mod ports;
mod protocol;

pub use engine::{Code, Fmu};
pub use error::{HostError, IsolationError};
pub use host::serve;
pub use in_si::InSi;
pub use isolated::{Isolated, Wires};
pub use load::{LoadError, Place, host, load};
pub use mechanics::FmuMechanics;
pub use ports::Ports;
/// The program that an FMU runs in: one that calls [`serve`], most simply the same one again.
pub use servobench_isolation::Program as HostCommand;
