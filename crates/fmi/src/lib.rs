//! The Functional Mock-up Interface, versions 2.0 and 3.0, co-simulation only.
//!
//! An FMU is a zip archive: `modelDescription.xml` lists its variables, `binaries/` holds a library with the C interface of the standard,
//! `resources/` whatever the library needs. Its contents are third-party code and data, not trusted.
//!
//! Source: Functional Mock-up Interface Specification 2.0.5 and 3.0.2, Modelica Association.

pub mod abi;
mod archive;
mod bits;
mod description;
mod error;
mod feedthrough;
mod library;
mod loaded;
mod log;
mod request;
mod setup;
mod slave;

pub use archive::{Archive, Limits, Unpacked, remove_abandoned, remove_unpacked};
pub use description::{
    Alias, BaseUnit, Causality, CoSimulation, DataType, DefaultExperiment, DependencyKind, Dimension, DisplayUnit,
    Enumeration, Exponents, Initial, IntervalVariability, Item, LogCategory, ModelDescription, ModelStructure, Ticks,
    Unit, Unknown, Values, Variability, Variable, Version,
};
pub use error::{ArchiveProblem, DescriptionProblem, FmuError, LibraryProblem};
pub use feedthrough::Feedthrough;
pub use library::calls::note_calls;
pub use loaded::Loaded;
pub use log::send_log_lines_to;
pub use request::{DeclaredNumber, DeclaredUnit, FmuRequest};
pub use servobench_base::Severity;
pub use servobench_config::Choice;
pub use servobench_fmu_file::{Bounds, FmuEntry, FmuFile, FmuMistake, Isolation, IsolationKind, SiPort, SiUnit, Value};
pub use setup::Setup;
pub use slave::{Capabilities, LogLine, Port, Slave, SlaveError, StepEnd};
