//! The C interface of FMI, written by hand: types and function types, shared by loading and by exporting FMUs.
//!
//! Names are those of the standard without the prefix that the module stands for: `fmi2DoStepTYPE` is [`v2::DoStep`],
//! `fmi3Status` is [`v3::Status`]. A type of the standard whose name Rust has itself keeps a prefix.
//!
//! Values that the other side sets (status, kind, qualifier) are integers with constants, never a Rust `enum`: a foreign value outside
//! the constants must be an error, not undefined behaviour. A pointer that may be NULL is an `Option`.
//!
//! Source: the header files `fmi2TypesPlatform.h`, `fmi2FunctionTypes.h`, `fmi3PlatformTypes.h` and `fmi3FunctionTypes.h`
//! that belong to the specifications.

pub mod v2;
pub mod v3;
