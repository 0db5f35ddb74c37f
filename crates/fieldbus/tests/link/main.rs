//! The link with a motion task and a drive around it.
mod delayed;
mod rig;
mod troubles;
