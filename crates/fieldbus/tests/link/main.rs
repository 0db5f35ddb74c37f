//! The link with a motion task and a drive around it.
mod ahead;
mod delayed;
mod modes;
mod position_loop;
mod power;
mod random;
mod rig;
mod settings;
mod taking_over;
mod troubles;
mod wide_counters;
