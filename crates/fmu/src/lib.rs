//! An axis of a scenario, its drive or its mechanics, as a co-simulation FMU of FMI 2.0 and 3.0.
mod description;
mod error;
mod export;
mod ffi;
mod history;
mod instance;
mod interface;
mod machine;
mod mover;
mod parameter;
mod part;
mod resources;
mod serialized;
mod units;

pub use error::FmuError;
pub use export::export;
pub use part::Part;
