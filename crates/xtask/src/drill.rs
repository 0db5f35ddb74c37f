//! Drills: the real program against what it must bear.
mod faults;
mod inputs;
mod many;
mod measured;
mod mutants;

pub(crate) use faults::run as faults;
pub(crate) use inputs::run as inputs;
pub(crate) use many::run as many;

use crate::failure::Failure;
use crate::wheel;
use crate::workspace::{Workspace, run};

/// Builds the program; says whether it has the engine `mujoco`.
fn built(workspace: &Workspace) -> Result<bool, Failure> {
    let library = wheel::MUJOCO.ensure(workspace);
    let mut build = workspace.cargo(["build", "--release", "--package", "servobench-cli"]);
    match &library {
        Ok(_) => {
            build.args(["--features", "mujoco"]);
        }
        Err(failure) => println!("{failure}; the drill goes without it"),
    }
    run(&mut build, 0)?;
    Ok(library.is_ok())
}
