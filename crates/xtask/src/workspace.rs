//! Folders of the workspace, and commands that run in it.
use crate::failure::Failure;
use serde::Deserialize;
use std::ffi::OsStr;
use std::path::PathBuf;
use std::process::{Command, Stdio};

/// Folders of the workspace; absolute.
#[derive(Debug, Clone, Deserialize)]
pub(crate) struct Workspace {
    /// Folder of the root `Cargo.toml`.
    #[serde(rename = "workspace_root")]
    pub(crate) root: PathBuf,
    /// Target folder of cargo; respects `CARGO_TARGET_DIR`.
    #[serde(rename = "target_directory")]
    pub(crate) target: PathBuf,
}

impl Workspace {
    /// Runs `cargo metadata`. Nothing is fixed when xtask is compiled: its target folder may serve several clones.
    pub(crate) fn find() -> Result<Self, Failure> {
        let mut cargo = Command::new(cargo());
        cargo.args(["metadata", "--no-deps", "--format-version", "1"]);
        let text = output(&mut cargo)?;
        parse(&cargo, &text)
    }

    /// A cargo command that finds the MuJoCo library. The variable is set even for builds without MuJoCo: a change of it would cause a
    /// rebuild.
    pub(crate) fn cargo<I: AsRef<OsStr>>(&self, arguments: impl IntoIterator<Item = I>) -> Command {
        let mut command = self.command(cargo(), arguments);
        command.env("MUJOCO_DYNAMIC_LINK_DIR", self.native_lib());
        command
    }

    /// A command that runs the `servobench` binary of the release build.
    pub(crate) fn servobench<I: AsRef<OsStr>>(&self, arguments: impl IntoIterator<Item = I>) -> Command {
        self.command(self.binary(), arguments)
    }

    /// A command in the root folder of the workspace.
    pub(crate) fn command<I: AsRef<OsStr>>(
        &self,
        program: impl AsRef<OsStr>,
        arguments: impl IntoIterator<Item = I>,
    ) -> Command {
        let mut command = Command::new(program);
        command.args(arguments).current_dir(&self.root);
        command
    }

    /// The release build of `servobench`.
    pub(crate) fn binary(&self) -> PathBuf {
        self.target.join("release").join("servobench")
    }

    /// The folder of the MuJoCo library.
    pub(crate) fn native_lib(&self) -> PathBuf {
        self.target.join("native").join("lib")
    }

    /// Files that git tracks under `paths`, relative to the root; all files if `paths` is empty.
    pub(crate) fn tracked(&self, paths: &[&str]) -> Result<Vec<PathBuf>, Failure> {
        let mut git = self.command("git", ["ls-files", "-z", "--"]);
        git.args(paths);
        let text = output(&mut git)?;
        Ok(text.split('\0').filter(|path| !path.is_empty()).map(PathBuf::from).collect())
    }
}

/// The cargo that runs xtask.
fn cargo() -> std::ffi::OsString {
    std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into())
}

/// Runs `command` with the terminal's input and output.
///
/// # Errors
/// [`Failure::Start`], or [`Failure::Ended`] when the exit code is not `expected`.
pub(crate) fn run(command: &mut Command, expected: i32) -> Result<(), Failure> {
    let status = command.status().map_err(|source| start_failure(command, source))?;
    if status.code() == Some(expected) {
        return Ok(());
    }
    Err(Failure::Ended { command: shown(command), status, expected })
}

/// Runs `command` and returns what it prints; its messages go to the terminal.
///
/// # Errors
/// [`Failure::Start`], [`Failure::Ended`], or [`Failure::Output`] when it printed other than UTF-8.
pub(crate) fn output(command: &mut Command) -> Result<String, Failure> {
    let done = command.stderr(Stdio::inherit()).output().map_err(|source| start_failure(command, source))?;
    if !done.status.success() {
        return Err(Failure::Ended { command: shown(command), status: done.status, expected: 0 });
    }
    String::from_utf8(done.stdout).map_err(|e| Failure::Output { command: shown(command), why: e.to_string() })
}

/// Reads the JSON that `command` printed.
pub(crate) fn parse<'a, T: Deserialize<'a>>(command: &Command, text: &'a str) -> Result<T, Failure> {
    serde_json::from_str(text).map_err(|e| Failure::Output { command: shown(command), why: e.to_string() })
}

/// The command line as one would type it.
pub(crate) fn shown(command: &Command) -> String {
    let program = PathBuf::from(command.get_program());
    let name = program.file_name().unwrap_or(program.as_os_str()).to_string_lossy();
    let arguments = command.get_args().map(|a| format!(" {}", a.to_string_lossy()));
    name.chars().chain(arguments.collect::<String>().chars()).collect()
}

pub(crate) fn start_failure(command: &Command, source: std::io::Error) -> Failure {
    Failure::Start { program: command.get_program().to_string_lossy().into_owned(), source }
}
