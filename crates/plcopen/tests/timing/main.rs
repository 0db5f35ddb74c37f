//! The outputs of the blocks over time.
#[path = "../shared/bench.rs"]
mod bench;

mod aborts;
mod blending;
mod calls;
mod continuity;
mod endless;
mod execute;
mod figures;
mod homing;
mod inputs;
mod modulo;
mod motions;
mod overrides;
mod superimposed;
