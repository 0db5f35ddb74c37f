//! Libraries of the Rust toolchain for other targets than this machine, which `rustup` fetches once.
use crate::failure::Failure;
use std::path::Path;
use std::process::Command;

/// Fetches the library of `target`, unless it is there. `library` names it in messages.
///
/// # Errors
/// [`Failure::Fetch`] with the cause and the remedy.
pub(crate) fn ensure(library: &str, target: &str) -> Result<(), Failure> {
    if is_installed(target) {
        return Ok(());
    }
    eprintln!("fetching the {library} for {target} (once)");
    match run(Command::new("rustup").args(["target", "add", target])) {
        Ok(_) if is_installed(target) => Ok(()),
        Ok(_) => Err(missing(library, target, "the Rust in use is not the one that `rustup` serves".into())),
        Err(why) => Err(missing(library, target, why)),
    }
}

fn missing(library: &str, target: &str, why: String) -> Failure {
    Failure::Fetch {
        name: format!("the {library} for {target}"),
        why,
        help: format!("`rustup target add {target}`, once, with a network"),
    }
}

/// `true` when the Rust in use has the library.
fn is_installed(target: &str) -> bool {
    let rustc = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let folder = run(Command::new(rustc).args(["--print", "target-libdir", "--target", target]));
    folder.is_ok_and(|folder| Path::new(folder.trim()).is_dir())
}

/// Output of `command`.
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
    fn what_is_missing_is_named_with_the_way_out() {
        let why = missing("core library", "thumbv7em-none-eabihf", "rustup: could not reach the server".into());
        let message = "the core library for thumbv7em-none-eabihf cannot be fetched (rustup: could not reach the server); \
                       `rustup target add thumbv7em-none-eabihf`, once, with a network";
        assert_eq!(why.to_string(), message);
    }

    #[test]
    fn a_program_that_fails_is_named_with_the_cause() {
        let mut shell = Command::new("sh");
        shell.args(["-c", "echo info >&2; echo 'error: no network' >&2; echo 'where it happened' >&2; exit 1"]);
        assert_eq!(run(&mut shell).unwrap_err(), "sh: no network");
        assert!(run(&mut Command::new("no-such-program")).unwrap_err().contains("cannot be started"));
    }
}
