//! `cargo xtask demo`: from a fresh clone to two compared moves.
use crate::failure::Failure;
use crate::program;
use crate::workspace::{Workspace, run as run_command};

/// Builds the program alone and runs the demo: its verdicts are available before Rerun is compiled. Then sets up and builds the rest, runs
/// the demo again if that adds an engine, and compares its two moves.
///
/// # Errors
/// [`Failure`] of the build or of a run; a missing library is only reported.
pub(crate) fn run(workspace: &Workspace) -> Result<(), Failure> {
    let mut without_viewer = workspace.cargo(["build", "--release", "--package", "servobench-cli"]);
    run_command(&mut without_viewer, 0)?;
    demo(workspace, &["run"])?;

    println!("\nbuilding the engine mujoco and the program for the Rerun viewer, which takes some minutes");
    let has_mujoco = program::build(workspace, "the demo goes on with the embedded engines")?;
    let mut viewer = workspace.cargo(["build", "--release", "--package", "servobench-view"]);
    run_command(&mut viewer, 0)?;
    if has_mujoco {
        demo(workspace, &["run"])?;
    }
    demo(workspace, &["compare", "scenarios/demo/jerk.toml", "scenarios/demo/snap.toml"])
}

/// Runs the program with the folder of the demo as its output.
fn demo(workspace: &Workspace, arguments: &[&str]) -> Result<(), Failure> {
    let mut servobench = workspace.servobench(arguments);
    servobench.arg("--out").arg(workspace.target.join("demo"));
    run_command(&mut servobench, 0)
}
