//! The outputs of the blocks over time.
#[path = "../shared/bench.rs"]
mod bench;

mod aborts;
mod blending;
mod execute;
mod figures;
mod motions;
