//! `cargo xtask bench peers`: the same closed loop in servobench and in simulators of electric drives that are published for Python,
//! side by side in the same run.
//!
//! The loop and the program that simulates it with all of them are in `tests/peers/`. It fails where one does not simulate the same thing
//! as servobench.
use crate::environment::Environment;
use crate::failure::Failure;
use crate::program;
use crate::workspace::{Workspace, run as run_command};

/// Folder of the loop and the program.
const FOLDER: &str = "tests/peers";
/// The program.
const PROGRAM: &str = "compare.py";

/// Installs the simulators, unless they are there, builds `servobench` and compares.
///
/// # Errors
/// [`Failure::Fetch`] when the simulators cannot be fetched, else [`Failure`] of the build or of the comparison.
pub(crate) fn run(workspace: &Workspace, json: bool) -> Result<(), Failure> {
    let environment = environment(workspace);
    environment.ensure()?;
    program::build(workspace, "the comparison needs the engine `exact` only")?;
    let mut compare = workspace.command(environment.python(), ["-B", "-u", &format!("{FOLDER}/{PROGRAM}")]);
    compare.env("SERVOBENCH", workspace.binary()).env("LD_LIBRARY_PATH", workspace.native_lib());
    if json {
        compare.arg("--json");
    }
    run_command(&mut compare, 0)
}

fn environment(workspace: &Workspace) -> Environment {
    Environment {
        owner: "the simulators for Python",
        command: "cargo xtask bench peers",
        folder: workspace.target.join("python-peers"),
        requirements: vec![workspace.root.join(FOLDER).join("requirements.txt")],
        sources: None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;
    use std::path::Path;

    #[test]
    fn the_program_of_the_folder_is_run_and_what_it_needs_is_there() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
        let workspace = Workspace { target: root.join("target"), root };
        let mut programs = Vec::new();
        for file in fs::read_dir(workspace.root.join(FOLDER)).unwrap() {
            let path = file.unwrap().path();
            let is_python = path.extension().is_some_and(|extension| extension == "py");
            if is_python && fs::read_to_string(&path).unwrap().contains("__main__") {
                programs.push(path.file_name().unwrap().to_owned());
            }
        }
        assert_eq!(programs, [PROGRAM]);
        for requirements in environment(&workspace).requirements {
            let text = fs::read_to_string(requirements).unwrap();
            for simulator in ["motulator==", "gym-electric-motor=="] {
                assert!(text.contains(simulator), "{simulator}");
            }
        }
    }
}
