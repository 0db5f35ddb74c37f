//! Bare metal: set-point generators, function blocks and the link to a drive are linked for a machine that has neither `std` nor
//! an allocator.
//!
//! The core library for that machine is a part of the Rust toolchain that `rustup` fetches once. Where it cannot be had, the
//! step is left out, and it is said.
use crate::failure::Failure;
use crate::workspace::Workspace;
use std::path::Path;
use std::process::Command;

/// A Cortex-M4 or -M7 with floating point: what drives are made with.
const TARGET: &str = "thumbv7em-none-eabihf";

/// Whether it can be built here, and why not.
#[derive(Debug)]
pub(crate) enum BareMetal {
    /// The core library is there.
    Installed,
    /// It is not, for this reason.
    Missing(Failure),
}

impl BareMetal {
    /// Fetches the core library, unless it is there.
    pub(crate) fn prepare() -> Self {
        if is_installed() {
            return Self::Installed;
        }
        eprintln!("fetching the core library for {TARGET} (once)");
        match run(Command::new("rustup").args(["target", "add", TARGET])) {
            Ok(_) if is_installed() => Self::Installed,
            Ok(_) => Self::Missing(missing("the Rust in use is not the one that `rustup` serves".into())),
            Err(why) => Self::Missing(missing(why)),
        }
    }

    /// The command that links them, if it can be run.
    pub(crate) fn command(&self, workspace: &Workspace) -> Option<Command> {
        let build = ["build", "--release", "--package", "servobench-bare-metal", "--target", TARGET];
        matches!(self, Self::Installed).then(|| workspace.cargo(build))
    }

    /// Says what is left out, if it is.
    pub(crate) fn report(&self) {
        if let Self::Missing(why) = self {
            println!(
                "LEFT OUT, bare metal: that set-point generators, function blocks and link need no `std` and no heap\n  {why}"
            );
        }
    }
}

fn missing(why: String) -> Failure {
    Failure::Fetch {
        name: format!("the core library for {TARGET}"),
        why,
        help: format!("`rustup target add {TARGET}`, once, with a network"),
    }
}

/// Whether the Rust in use has the core library.
fn is_installed() -> bool {
    let rustc = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let folder = run(Command::new(rustc).args(["--print", "target-libdir", "--target", TARGET]));
    folder.is_ok_and(|folder| Path::new(folder.trim()).is_dir())
}

/// What `command` prints.
///
/// # Errors
/// The cause in one line: the last one that names an error, else the last that it wrote.
fn run(command: &mut Command) -> Result<String, String> {
    let program = command.get_program().to_string_lossy().into_owned();
    let done = command.output().map_err(|e| format!("`{program}` cannot be started: {e}"))?;
    if done.status.success() {
        return Ok(String::from_utf8_lossy(&done.stdout).into_owned());
    }
    let messages = String::from_utf8_lossy(&done.stderr);
    let mut lines = messages.lines().rev().map(str::trim).filter(|line| !line.is_empty());
    let last = lines.clone().next().unwrap_or("it gave no message");
    let cause = lines.find(|line| line.starts_with("error")).unwrap_or(last);
    Err(format!("{program}: {}", cause.trim_start_matches("error: ")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_cannot_be_built_is_no_step_and_says_how_it_could_be() {
        let nowhere = Workspace { root: ".".into(), target: "target".into() };
        assert!(BareMetal::Installed.command(&nowhere).is_some());
        let why = missing("rustup: could not reach the server".into());
        let message = "the core library for thumbv7em-none-eabihf cannot be fetched (rustup: could not reach the server); \
                       `rustup target add thumbv7em-none-eabihf`, once, with a network";
        assert_eq!(why.to_string(), message);
        assert!(BareMetal::Missing(why).command(&nowhere).is_none());
    }

    #[test]
    fn a_program_that_fails_is_named_with_the_cause() {
        let mut shell = Command::new("sh");
        shell.args(["-c", "echo info >&2; echo 'error: no network' >&2; echo 'where it happened' >&2; exit 1"]);
        assert_eq!(run(&mut shell).unwrap_err(), "sh: no network");
        assert!(run(&mut Command::new("no-such-program")).unwrap_err().contains("cannot be started"));
    }
}
