//! An axis of a scenario, its drive or its mechanics, as a co-simulation FMU of FMI 2.0 and 3.0.
//!
//! The crate both writes FMUs ([`export`]) and, built as a shared library, is the code inside them: the functions of the
//! standard around the closed loop of `servobench run`, on the engine `exact`. One table of variables (`interface`) generates the model
//! description and serves the functions.
//!
//! ```text
//! scenario → part of its loop → table of variables → modelDescription.xml ┐
//! scenario, its models and tables ───────────────→ resources/             ├→ FMU
//! this crate as a shared library ────────────────→ binaries/              ┘
//! ```
mod description;
mod error;
mod export;
mod ffi;
mod instance;
mod interface;
mod library;
mod machine;
mod mover;
mod parameter;
mod part;
mod resources;
mod serialized;
mod units;

pub use error::FmuError;
pub use export::export;
pub use library::{LIBRARY, library, library_path};
pub use part::Part;
