//! The Functional Mock-up Interface, versions 2.0 and 3.0, co-simulation only.
//!
//! An FMU is a zip archive: `modelDescription.xml` says which variables there are, `binaries/` holds a library with the C
//! interface of the standard, `resources/` whatever the library needs. What is inside is somebody else's.
//!
//! Source: Functional Mock-up Interface Specification 2.0.5 and 3.0.2, Modelica Association.

pub mod abi;
mod slave;

pub use slave::{Capabilities, LogLine, Port, Progress, Severity, Slave, SlaveError};
