//! `Recording`: what a run leaves behind. Channels with unit, rate and writer, all sampled at one rate; the moves that
//! were made; the events that happened.
//!
//! A row is written at tick k **before** the integration to k+1, so all its values belong to the same instant.

mod channel;
mod recorder;
mod recording;

pub use channel::{Channel, ChannelSpec};
pub use recorder::Recorder;
pub use recording::{About, Event, Move, Recording};
