//! `cargo xtask drill verdicts`: healthy machines and their sabotaged twins, judged by the program and by an oracle outside it.
//!
//! The example `twin` of the tests runs machines that no scenario can describe; `tests/twin/verdicts.py` draws them and judges the
//! verdicts. `docs/testing.md` defines bad and good.
use crate::failure::Failure;
use crate::outside;
use crate::wheel;
use crate::workspace::{Workspace, run as run_command};
use std::path::Path;
use std::process::Command;

/// Pairs when run by hand; `SERVOBENCH_SWEEP` overrides this and the next three.
const PAIRS: &str = "20000";
/// Healthy axes.
const HEALTHY: &str = "2000";
/// Pairs among which each rule is needed.
const PROOF: &str = "2000";

/// Wrong cables and commutations.
const CABLES: &str = "200";

/// Arguments for the tests: always the same pairs and cables, which take some ten seconds.
const TESTED: [[&str; 4]; 2] = [["--pairs", "400", "--seed", "1"], ["--cables", "100", "--seed", "1"]];

/// Kind of drill.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Drill {
    /// Pairs of twins.
    Pairs,
    /// Healthy axes alone.
    Healthy,
    /// Pairs of twins, among them some for each rule of the verdict that pass without it.
    Proof,
    /// Wrong cables and commutations of supervised axes with little friction.
    Cables,
}

/// Runs the drill.
///
/// # Errors
/// [`Failure::Fetch`] when Python's packages cannot be fetched, else [`Failure`] of the build or of the drill.
pub(crate) fn run(workspace: &Workspace, drill: Drill) -> Result<(), Failure> {
    let environment = outside::common(workspace);
    environment.ensure()?;
    let has_mujoco = wheel::MUJOCO.ensure(workspace).is_ok();
    run_command(&mut build(workspace, has_mujoco), 0)?;
    let (flag, usual) = match drill {
        Drill::Pairs => ("--pairs", PAIRS),
        Drill::Healthy => ("--healthy", HEALTHY),
        Drill::Proof => ("--proof", PROOF),
        Drill::Cables => ("--cables", CABLES),
    };
    let size = std::env::var("SERVOBENCH_SWEEP").unwrap_or_else(|_| usual.to_owned());
    let mut command = judge(workspace, &environment.python(), has_mujoco);
    command.args([flag, &size]);
    if let Ok(seed) = std::env::var("SERVOBENCH_SEED") {
        command.args(["--seed", &seed]);
    }
    run_command(&mut command, 0)
}

fn build(workspace: &Workspace, has_mujoco: bool) -> Command {
    let mut build = workspace.cargo(["build", "--release", "--package", "servobench-tests", "--example", "twin"]);
    if has_mujoco {
        build.args(["--features", "servobench-tests/mujoco"]);
    }
    build
}

/// The pairs and the wrong cables of the tests, by this Python; the example has been built.
pub(crate) fn tested(workspace: &Workspace, python: &Path, has_mujoco: bool) -> [Command; 2] {
    TESTED.map(|size| {
        let mut command = judge(workspace, python, has_mujoco);
        command.args(size);
        command
    })
}

fn judge(workspace: &Workspace, python: &Path, has_mujoco: bool) -> Command {
    let mut command = workspace.command(python, ["-B", "-u", "tests/twin/verdicts.py", "--program"]);
    command.arg(workspace.target.join("release").join("examples").join("twin"));
    command.env("LD_LIBRARY_PATH", workspace.native_lib());
    if has_mujoco {
        command.arg("--mujoco");
    }
    command
}
