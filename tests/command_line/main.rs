//! The program as its users see it: output, files, exit codes. It belongs to the crate `cli`, whose binary it runs.
mod advise;
mod attached;
mod check;
mod compare;
mod completions;
mod deny;
mod fmu;
mod fmu_standard;
mod fmu_suite;
mod fmu_trust;
#[cfg(target_os = "linux")]
mod foreign_text;
mod getting_started;
mod hardware;
#[cfg(unix)]
mod hostile;
#[cfg(unix)]
mod interrupted;
#[cfg(target_os = "linux")]
mod isolation;
mod man;
mod objects;
mod output;
#[cfg(unix)]
mod outputs;
mod overrides;
mod plan;
mod plan_families;
mod plan_mistakes;
mod plan_points;
mod plc;
mod run;
mod standard_input;
mod start;
mod sweep;
mod sweep_closed_forms;
mod timing;
#[cfg(unix)]
mod view;
#[cfg(unix)]
mod view_program;
mod workflows;

use serde_json::Value;
use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::LazyLock;

fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// `servobench`, to be run in the repository's root.
fn command(arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_servobench"));
    let folders = std::env::var_os("PATH").unwrap_or_default();
    command.args(arguments).current_dir(repository()).env("PATH", search_path(std::env::split_paths(&folders)));
    command
}

/// These folders, and behind them a stand-in for `servobench-view`. That program lies beside `servobench` in a build of the whole workspace,
/// and is found there first; in a build without Rerun what starts it can be tested all the same.
fn search_path(folders: impl IntoIterator<Item = PathBuf>) -> OsString {
    static STAND_IN: LazyLock<tempfile::TempDir> = LazyLock::new(|| {
        let folder = tempfile::tempdir().unwrap();
        let version = env!("CARGO_PKG_VERSION");
        #[cfg(unix)]
        script(
            &folder.path().join("servobench-view"),
            &format!("[ \"$1\" = --version ] && exec echo servobench-view {version}\nshift\nexec cat - \"$@\"\n"),
        );
        folder
    });
    std::env::join_paths(folders.into_iter().chain([STAND_IN.path().to_owned()])).unwrap()
}

/// Writes a shell script that can be started.
#[cfg(unix)]
fn script(path: &Path, text: &str) {
    use std::os::unix::fs::PermissionsExt;
    fs::write(path, format!("#!/bin/sh\n{text}")).unwrap();
    fs::set_permissions(path, fs::Permissions::from_mode(0o755)).unwrap();
}

/// Runs `servobench` in the repository's root.
fn servobench(arguments: &[&str]) -> Output {
    command(arguments).output().unwrap()
}

fn code(output: &Output) -> i32 {
    output.status.code().unwrap()
}

fn said(output: &Output) -> String {
    format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr))
}

fn json(text: &[u8]) -> Value {
    serde_json::from_slice(text).unwrap()
}

/// A folder that goes away, with scenario files in it.
fn folder(files: &[(&str, &str)]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in files {
        fs::write(folder.path().join(name), text).unwrap();
    }
    folder
}

/// A rigid axis that is held by nothing: with a negative damping it would diverge, with a plain one it moves.
const SLIDE: &str = r#"
[run]
base_rate = "4 kHz"
duration = "0.4 s"
[axis]
motion = "linear"
[axis.motor_side]
mass = "20 kg"
[motor]
kind = "ideal-source"
[drive.velocity]
rate = "4 kHz"
bandwidth = "80 Hz"
kind = "p"
[drive.position]
rate = "4 kHz"
gain = "60 1/s"
[drive.feedforward]
velocity = true
effort = "rigid"
[setpoint]
order = 3
velocity = "0.5 m/s"
acceleration = "5 m/s2"
jerk = "200 m/s3"
[[program]]
move_to = "50 mm"
[measure]
window = "10 um"
"#;

/// [`SLIDE`] behind a fieldbus, with these lines of `[drive.objects]`.
fn on_a_bus(objects: &str) -> String {
    // The master or the drive feeds forward, not both.
    let feedforward = "[drive.feedforward]\nvelocity = true\neffort = \"rigid\"\n";
    assert!(SLIDE.contains(feedforward));
    let bus = "[bus]\ncycle = \"1 ms\"\nvelocity_offset = true\nunits = { drive = 1, axis = \"1 um\" }\n";
    SLIDE.replace(feedforward, &format!("[drive.objects]\n{objects}\n{bus}"))
}
