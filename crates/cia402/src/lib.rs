//! The drive profile CiA 402 (IEC 61800-7-201) as both sides see it, the master and the drive.
//!
//! `no_std`, no heap. Objects are cited by their index, as in 6041h.
#![cfg_attr(not(test), no_std)]

mod state;
mod statusword;

pub use state::PowerState;
pub use statusword::{StatusBit, Statusword};
