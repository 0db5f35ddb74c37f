//! Faults: the long form of the drill in `tests/drill`, whose short form is among the tests.
use crate::failure::Failure;
use crate::wheel;
use crate::workspace::{Workspace, run as run_command};

/// Number of suites with a fault, and of pairs of suites in one folder.
const SUITES: &str = "200";

/// Runs suites with faults, and pairs of suites in one folder.
///
/// # Errors
/// [`Failure::Fetch`] when the library of an engine cannot be fetched, [`Failure::Ended`] when something was lost.
pub(crate) fn run(workspace: &Workspace) -> Result<(), Failure> {
    wheel::MUJOCO.ensure(workspace)?;
    let mut drill = workspace.cargo(["test", "--release", "--workspace", "--test", "drill"]);
    drill.args([
        "--features",
        "servobench-cli/mujoco,servobench-tests/mujoco",
        "--",
        "--nocapture",
        "--test-threads=1",
    ]);
    if std::env::var_os("SERVOBENCH_SWEEP").is_none() {
        drill.env("SERVOBENCH_SWEEP", SUITES);
    }
    run_command(&mut drill, 0)
}
