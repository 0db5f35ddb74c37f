//! Descriptions of parameters: each is declared once, by the crate that owns the setting.
//!
//! A description holds the name, the quantity, its bound, an example and the meaning. Reading files, checks, schemas and
//! documentation are based on these descriptions. `no_std`, no heap: firmware also declares its parameters here.
#![cfg_attr(not(test), no_std)]

mod bound;
mod choice;
mod dimension;
mod parameter;
mod physical;
pub mod quantities;

pub use bound::{Bound, Measure, any, not_negative, positive};
pub use choice::Choice;
pub use dimension::Dimension;
pub use parameter::{Parameter, ParameterError};
pub use physical::{Counterparts, Kind, Physical};
