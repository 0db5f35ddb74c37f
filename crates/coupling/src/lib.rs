//! A co-simulation master: blocks that are stepped each for itself and exchange signals at fixed times.

mod block;

pub use block::{Block, Input, Step};
