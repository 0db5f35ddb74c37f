//! How parameters are described, so that each is declared once, by the crate that owns what it sets.
//!
//! A description holds the name, what it measures, its bound, an example and its meaning. Whoever reads files, checks them, writes
//! their schema or documents them does so by these descriptions. `no_std`, no heap: firmware declares its parameters here too.
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
