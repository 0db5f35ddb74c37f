//! FMUs isolated in separate processes, and FMUs as the mechanics of an axis ([`FmuMechanics`]).
//!
//! [`load`] starts an FMU at its place; [`Fmu`] is the engine for an axis, and opens FMUs beside an axis. The program that hosts FMUs
//! calls [`host`].
//!
//! An FMU is third-party native code: it may crash, hang, allocate memory without end or print a gigabyte. In a separate process
//! that costs only its own run, and is reported with its cause.
//!
//! ```text
//! simulation: Isolated ── shared memory, a doorbell for each direction ── serve: the FMU        (same program, another process)
//!             Contained    ── standard output and error, its end ─────────┘
//! ```
//! | action of the FMU | report |
//! |---|---|
//! | crashes, aborts, calls `exit` | signal or exit code, and its last output on standard error |
//! | does not return | the call and the time limit; it is killed |
//! | allocates unbounded memory, private or shared | its limit |
//! | prints unbounded text | number of bytes dropped; the end is kept |
//! | overwrites the shared memory | the fact; numbers there are only numbers and lengths are limited |
//! | leaves processes behind | their names; they are killed |
//!
//! It ends with the simulation, however that ends, and the processes that it has started end with it; the crate `servobench-isolation`
//! documents what the isolation contains and what it does not. Nothing is left in the file system: the memory is an anonymous file.
//!
//! Isolation needs Linux. Elsewhere an FMU runs in this process ([`Place::Here`]), or not at all.

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
/// Program that runs an FMU: one that calls [`serve`], most simply the same one again.
pub use servobench_isolation::Program as HostCommand;
