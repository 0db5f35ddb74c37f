//! A user's MJCF file: the supported subset of MJCF, and the contents of a file.
mod contact;
mod depth;
mod grammar;
mod mass;
mod mechanism;
mod refusal;
mod scan;

pub(crate) use mechanism::{Axis, Freedom, Joint, Mechanism, Tendon};
pub(crate) use refusal::MjcfRefusal;
