//! The outputs of the blocks over time.
#[path = "../shared/bench.rs"]
mod bench;

mod aborts;
mod blending;
mod calls;
mod continuity;
mod digital_cam_switch;
mod endless;
mod execute;
mod figures;
mod homing;
mod homing_steps;
mod inputs;
mod inputs_outputs;
mod modulo;
mod motions;
mod overrides;
mod parameters;
mod replans;
mod state_of_motion;
mod superimposed;
