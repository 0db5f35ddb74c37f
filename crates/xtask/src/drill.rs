//! Drills: the real program against what it must bear.
mod faults;
mod inputs;
mod measured;
mod mutants;

pub(crate) use faults::run as faults;
pub(crate) use inputs::run as inputs;
