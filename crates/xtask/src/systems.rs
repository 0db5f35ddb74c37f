//! Other operating systems: the program is checked for Windows and macOS, which needs neither a linker nor such a system.
//!
//! The standard library for each is a part of the Rust toolchain. Where that, or a crate that only this system needs, cannot be fetched,
//! the step is left out and reported.
use crate::failure::Failure;
use crate::toolchain;
use crate::workspace::{Workspace, output, run};
use std::fs;
use std::io;
use std::os::unix::fs::OpenOptionsExt as _;
use std::path::{Path, PathBuf};
use std::process::Command;

/// A system and its target.
const SYSTEMS: [(&str, &str); 2] = [("Windows", "x86_64-pc-windows-gnu"), ("macOS", "aarch64-apple-darwin")];

/// Stand-in for the C compiler and its archiver: checking Rust reads nothing of C. The last `-o` names the file that they would make.
const NO_COMPILER: &str = "#!/bin/sh\nfor word; do [ \"$before\" = -o ] && : >\"$word\"; before=$word; done\nexit 0\n";

/// Systems that the program can be checked for here, and the failures of the others.
#[derive(Debug)]
pub(crate) struct Systems(Vec<(&'static str, &'static str, Result<(), Failure>)>);

impl Systems {
    /// Fetches the standard libraries and the crates that only these systems need, unless they are there.
    pub(crate) fn prepare(workspace: &Workspace) -> Self {
        let fetched =
            |target| output(&mut workspace.cargo(["fetch", "--locked", "--quiet", "--target", target])).map(drop);
        let prepared = |target| toolchain::ensure("standard library", target).and_then(|()| fetched(target));
        Self(SYSTEMS.map(|(name, target)| (name, target, prepared(target))).into())
    }

    /// The commands that check the program, of those that can be run.
    ///
    /// # Errors
    /// [`Failure::File`]: the stand-in for a C compiler cannot be written.
    pub(crate) fn commands(&self, workspace: &Workspace) -> Result<Vec<(&'static str, Command)>, Failure> {
        let no_compiler = workspace.target.join("no-c-compiler");
        write_program(&no_compiler).map_err(Failure::file("write", &no_compiler))?;
        let there = self.0.iter().filter(|(_, _, library)| library.is_ok());
        Ok(there.map(|(name, target, _)| (*name, command(workspace, target, &no_compiler))).collect())
    }

    /// Reports systems that are left out.
    pub(crate) fn report(&self) {
        for (name, _, library) in &self.0 {
            if let Err(why) = library {
                println!("LEFT OUT, other systems: that the program compiles for {name}\n  {why}");
            }
        }
    }
}

/// Checks the program for every system.
///
/// # Errors
/// [`Failure::Fetch`] when a standard library cannot be fetched, [`Failure::Ended`] when a crate cannot, or when the program does not
/// compile for a system.
pub(crate) fn check(workspace: &Workspace) -> Result<(), Failure> {
    let systems = Systems::prepare(workspace);
    for (_, mut command) in systems.commands(workspace)? {
        run(&mut command, 0)?;
    }
    systems.0.into_iter().try_for_each(|(_, _, library)| library)
}

/// Clippy checks as the compiler does, and warnings of the project's crates count. The profile is the usual one, so that programs that run
/// during compilation are already built.
fn command(workspace: &Workspace, target: &str, no_compiler: &Path) -> Command {
    let check = ["clippy", "--release", "--package", "servobench-cli", "--target", target, "--", "-D", "warnings"];
    let mut command = workspace.cargo(check);
    let suffix = target.replace('-', "_");
    command.envs(["CC", "AR"].map(|tool| (format!("{tool}_{suffix}"), PathBuf::from(no_compiler))));
    command
}

fn write_program(path: &Path) -> io::Result<()> {
    // Written once: a new modification time would cause rebuilds.
    if path.is_file() {
        return Ok(());
    }
    fs::create_dir_all(path.parent().unwrap_or(Path::new(".")))?;
    let file = fs::OpenOptions::new().write(true).create(true).truncate(true).mode(0o755).open(path)?;
    io::Write::write_all(&mut &file, NO_COMPILER.as_bytes())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_system_whose_library_is_missing_is_no_step() {
        let room = tempfile::tempdir().unwrap();
        let workspace = Workspace { root: ".".into(), target: room.path().into() };
        let why = Failure::Usage { given: String::new(), commands: String::new() };
        let systems = Systems(vec![("Windows", "w", Ok(())), ("macOS", "m", Err(why))]);
        let names: Vec<&str> = systems.commands(&workspace).unwrap().into_iter().map(|(name, _)| name).collect();
        assert_eq!(names, ["Windows"]);
    }

    #[test]
    fn the_stand_in_for_a_compiler_makes_the_file_that_it_is_asked_for() {
        let room = tempfile::tempdir().unwrap();
        let (program, object) = (room.path().join("cc"), room.path().join("a.o"));
        write_program(&program).unwrap();
        assert!(Command::new(program).arg("-o").arg(&object).arg("a.c").status().unwrap().success());
        assert!(fs::read(object).unwrap().is_empty());
    }
}
