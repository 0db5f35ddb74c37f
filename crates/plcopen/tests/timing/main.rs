//! The outputs of the blocks over time.
#[path = "../shared/bench.rs"]
mod bench;
mod execute;
mod figures;
