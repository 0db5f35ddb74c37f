//! `cargo xtask bench`: cost of a tick of the closed loop on every engine, beside the bare engine step, and of function blocks,
//! bus and drive in front of it; cost of each effect of real hardware; and shares of the time of a whole run.
use crate::failure::Failure;
use crate::wheel;
use crate::workspace::{Workspace, run as run_command};

/// Sets up the MuJoCo library and measures; a missing library is only reported.
///
/// # Errors
/// [`Failure`] of the build or of the run.
pub(crate) fn run(workspace: &Workspace, json: bool) -> Result<(), Failure> {
    let mut bench = workspace.cargo(["bench", "--quiet", "--package", "servobench-tests"]);
    bench.args(["--bench", "closed_loop", "--bench", "hardware", "--bench", "run", "--bench", "linear"]);
    match wheel::MUJOCO.ensure(workspace) {
        Ok(_) => {
            bench.args(["--features", "mujoco"]);
        }
        Err(failure) => eprintln!("{failure}; the embedded engines are measured"),
    }
    if json {
        bench.args(["--", "--json"]);
    }
    run_command(&mut bench, 0)
}
