//! `cargo xtask demo`: from nothing to a compared pair of moves.
use crate::failure::Failure;
use crate::program;
use crate::workspace::{Workspace, run as run_command};

/// Sets up what can be had, builds, runs the demo and compares its two moves.
///
/// # Errors
/// [`Failure`] of the build or of a run; a missing library is only said.
pub(crate) fn run(workspace: &Workspace) -> Result<(), Failure> {
    program::build(workspace, "the demo goes on with the embedded engines")?;
    let compare = ["compare", "scenarios/demo/jerk.toml", "scenarios/demo/snap.toml"];
    for arguments in [&["run"][..], &compare] {
        let mut servobench = workspace.servobench(arguments);
        servobench.arg("--out").arg(workspace.target.join("demo"));
        run_command(&mut servobench, 0)?;
    }
    Ok(())
}
