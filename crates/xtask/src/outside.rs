//! Outside clients: programs in `tests/outside/` that check the project against foreign software, published for Python.
//!
//! Requirements files beside them list their packages. Where an environment cannot be set up, its programs are left out and reported.
use crate::environment::Environment;
use crate::failure::Failure;
use crate::workspace::Workspace;
use std::path::PathBuf;
use std::process::Command;

/// Programs that share an environment.
#[derive(Debug)]
struct Group {
    /// Folder of the environment, under the target folder.
    environment: &'static str,
    /// Requirements files of its packages.
    requirements: &'static [&'static str],
    /// Packages whose source is fetched, into its folder `sources`, and not installed.
    sources: Option<&'static str>,
    /// The programs.
    clients: &'static [&'static str],
}

/// All programs. CoFMPy requires another FMPy than the other programs do. Of pyplcopen only the C++ is used, which is in its source alone;
/// the packages installed beside it are those with which pip reads name and version of a source package.
const GROUPS: [Group; 4] = [
    Group {
        environment: "python",
        requirements: &["requirements.txt", "files.txt"],
        sources: None,
        clients: &[
            "exported_fmus_by_fmpy.py",
            "fmus_by_fmpy.py",
            "object_dictionary_by_canopen.py",
            "online4_by_linear_program.py",
            "optimal_by_linear_program.py",
            "order3_by_ruckig.py",
            "verdicts.py",
        ],
    },
    Group {
        environment: "python-cofmupy",
        requirements: &["cofmupy.txt"],
        sources: None,
        clients: &["exported_fmus_by_cofmupy.py"],
    },
    Group {
        environment: "python-pyplcopen",
        requirements: &["pyplcopen.txt"],
        sources: Some("pyplcopen-source.txt"),
        clients: &["blocks_by_pyplcopen.py", "profile_4th_by_pyplcopen.py"],
    },
    Group {
        environment: "python-readers",
        requirements: &["readers.txt"],
        sources: None,
        clients: &["sweep_tables_by_polars_and_duckdb.py"],
    },
];

/// The programs that can be run here, and the failures of the others.
#[derive(Debug)]
pub(crate) struct Outside {
    /// By group: the Python that runs it, or the reason for its absence.
    pythons: [Result<PathBuf, Failure>; GROUPS.len()],
}

impl Outside {
    /// Installs the packages of the programs, unless they are installed.
    pub(crate) fn prepare(workspace: &Workspace) -> Self {
        let python = |group| {
            let environment = environment(group, workspace);
            environment.ensure().map(|()| environment.python())
        };
        Self { pythons: GROUPS.each_ref().map(python) }
    }

    /// One command for each program that can be run.
    pub(crate) fn commands(&self, workspace: &Workspace) -> Vec<Command> {
        let installed =
            GROUPS.iter().zip(&self.pythons).filter_map(|(group, python)| Some((group, python.as_ref().ok()?)));
        let commands = |(group, python): (&Group, &PathBuf)| {
            // No byte code between the sources; what a program prints is seen at once.
            let command = |client| workspace.command(python, ["-B", "-u", &format!("{FOLDER}/{client}")]);
            group.clients.iter().map(command).collect::<Vec<_>>()
        };
        installed.flat_map(commands).collect()
    }

    /// The Python that most of them share, if it could be set up.
    pub(crate) fn common(&self) -> Option<PathBuf> {
        self.pythons[0].as_ref().ok().cloned()
    }

    /// Reports programs that are left out.
    pub(crate) fn report(&self) {
        for (group, python) in GROUPS.iter().zip(&self.pythons) {
            if let Err(why) = python {
                println!("LEFT OUT, outside clients: {}\n  {why}", group.clients.join(", "));
            }
        }
    }

    /// Failure of the first group that is left out.
    pub(crate) fn failure(self) -> Option<Failure> {
        self.pythons.into_iter().find_map(Result::err)
    }
}

/// The environment that most of them share, for other programs that need its packages.
pub(crate) fn common(workspace: &Workspace) -> Environment {
    environment(&GROUPS[0], workspace)
}

/// Folder of the programs.
const FOLDER: &str = "tests/outside";

fn environment(group: &Group, workspace: &Workspace) -> Environment {
    let file = |name| workspace.root.join(FOLDER).join(name);
    Environment {
        owner: "the outside clients",
        command: "cargo xtask test",
        folder: workspace.target.join(group.environment),
        requirements: group.requirements.iter().copied().map(file).collect(),
        sources: group.sources.map(file),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;
    use std::path::Path;

    #[test]
    fn every_program_of_the_folder_is_run() {
        let folder = Path::new("../..").join(FOLDER);
        let files = fs::read_dir(folder).unwrap().map(|file| file.unwrap().path());
        let is_program = |path: &PathBuf| {
            path.extension().is_some_and(|e| e == "py") && fs::read_to_string(path).unwrap().contains("__main__")
        };
        let mut programs: Vec<_> = files.filter(is_program).collect();
        programs.sort();
        let names: Vec<_> = programs.iter().map(|path| path.file_name().unwrap().to_str().unwrap()).collect();
        let mut run: Vec<_> = GROUPS.iter().flat_map(|group| group.clients).copied().collect();
        run.sort_unstable();
        assert_eq!(names, run);
    }
}
