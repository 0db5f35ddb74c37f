//! A user's own MJCF file: what of MJCF is simulated, and what a file says.
mod contact;
mod depth;
mod grammar;
mod mass;
mod mechanism;
mod refusal;
mod scan;

pub(crate) use mechanism::{Axis, Freedom, Joint, Mechanism, Tendon};
pub(crate) use refusal::MjcfRefusal;
