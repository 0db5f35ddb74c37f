//! Release build of the program `servobench`, for the commands that run it.
use crate::failure::Failure;
use crate::wheel;
use crate::workspace::{Workspace, run};

/// Builds the program, with the engine `mujoco` if its library can be fetched; true if it has it. If not, `otherwise` states how the
/// command continues.
///
/// # Errors
/// [`Failure`] of the build.
pub(crate) fn build(workspace: &Workspace, otherwise: &str) -> Result<bool, Failure> {
    let library = wheel::MUJOCO.ensure(workspace);
    let mut build = workspace.cargo(["build", "--release", "--package", "servobench-cli"]);
    match &library {
        Ok(_) => {
            build.args(["--features", "mujoco"]);
        }
        Err(failure) => eprintln!("{failure}; {otherwise}"),
    }
    run(&mut build, 0)?;
    Ok(library.is_ok())
}
