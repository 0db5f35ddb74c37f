//! Drills: stress tests of the real program.
mod advice;
mod faults;
mod inputs;
mod long;
mod many;
mod measured;
mod mutants;
mod several;
mod sweeps;
pub(crate) mod verdicts;

pub(crate) use advice::run as advise;
pub(crate) use faults::run as faults;
pub(crate) use inputs::run as inputs;
pub(crate) use long::run as long;
pub(crate) use many::run as many;
pub(crate) use several::run as several;
pub(crate) use sweeps::run as sweep;
pub(crate) use verdicts::{Drill as Verdicts, run as verdicts};

use crate::failure::Failure;
use crate::program;
use crate::workspace::Workspace;

/// Builds the program; true if it has the engine `mujoco`.
fn built(workspace: &Workspace) -> Result<bool, Failure> {
    program::build(workspace, "the drill goes without it")
}
