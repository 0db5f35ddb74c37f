//! Outside clients: programs in `tests/outside/` that hold the project against what others wrote, published for Python.
//!
//! Their packages are pinned by version and hash in requirements files beside them, with all that these require but what is
//! never called. They are installed once, into virtual environments under the target folder. Where one cannot be had, its programs
//! are left out, and it is said.
use crate::failure::Failure;
use crate::python;
use crate::wheel::sha256;
use crate::workspace::Workspace;
use std::fs;
use std::path::PathBuf;
use std::process::Command;

/// Programs that share an environment.
#[derive(Debug)]
struct Group {
    /// Folder of the environment, under the target folder.
    environment: &'static str,
    /// What is installed there.
    requirements: &'static [&'static str],
    /// Packages whose source is fetched, into its folder `sources`, and not installed.
    sources: Option<&'static str>,
    /// The programs.
    clients: &'static [&'static str],
}

/// All programs. CoFMPy asks for another FMPy than the one that the others hold the project against. Of pyplcopen the C++ is wanted,
/// which only its source has; what is installed beside it is what pip reads the name and version of a source package with.
const GROUPS: [Group; 3] = [
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
];

/// The programs that can be run here, and why others cannot.
#[derive(Debug)]
pub(crate) struct Outside {
    /// By group: the Python that runs it, or why there is none.
    pythons: [Result<PathBuf, Failure>; GROUPS.len()],
}

impl Outside {
    /// Installs what the programs need, unless it is there.
    pub(crate) fn prepare(workspace: &Workspace) -> Self {
        let python = |group| {
            let environment = Environment::of(group, workspace);
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

    /// Says what is left out, if anything is.
    pub(crate) fn report(&self) {
        for (group, python) in GROUPS.iter().zip(&self.pythons) {
            if let Err(why) = python {
                println!("LEFT OUT, outside clients: {}\n  {why}", group.clients.join(", "));
            }
        }
    }

    /// Why some are left out: of the first group that is.
    pub(crate) fn failure(self) -> Option<Failure> {
        self.pythons.into_iter().find_map(Result::err)
    }
}

/// Where the programs are.
const FOLDER: &str = "tests/outside";

/// A virtual environment with exactly the packages of some requirements files.
#[derive(Debug)]
struct Environment {
    folder: PathBuf,
    requirements: Vec<PathBuf>,
    sources: Option<PathBuf>,
}

impl Environment {
    fn of(group: &Group, workspace: &Workspace) -> Self {
        let file = |name| workspace.root.join(FOLDER).join(name);
        Self {
            folder: workspace.target.join(group.environment),
            requirements: group.requirements.iter().copied().map(file).collect(),
            sources: group.sources.map(file),
        }
    }

    fn python(&self) -> PathBuf {
        self.folder.join("bin").join("python")
    }

    /// Written last: an environment with the stamp of its requirements is complete.
    fn stamp(&self) -> PathBuf {
        self.folder.join("installed.sha256")
    }

    /// Makes sure that the environment is there and has the packages that are wanted now.
    ///
    /// # Errors
    /// [`Failure::Fetch`] says in one sentence what failed and what to do.
    fn ensure(&self) -> Result<(), Failure> {
        let wanted = self.wanted()?;
        if fs::read_to_string(self.stamp()).is_ok_and(|found| found == wanted) && self.starts() {
            return Ok(());
        }
        eprintln!("fetching the Python packages of the outside clients (once)");
        self.install().map_err(|why| Failure::Fetch {
            name: "what the outside clients need".into(),
            why,
            help: "`cargo xtask test` fetches it with Python 3.11 or later, pip and a package index in reach".into(),
        })?;
        fs::write(self.stamp(), wanted).map_err(Failure::file("write", self.stamp()))
    }

    /// What the stamp has to be.
    fn wanted(&self) -> Result<String, Failure> {
        let sum = |path: &PathBuf| sha256(path).map_err(Failure::file("read", path));
        Ok(self.requirements.iter().chain(&self.sources).map(sum).collect::<Result<Vec<_>, _>>()?.join("\n"))
    }

    /// # Errors
    /// The cause in one line.
    fn install(&self) -> Result<(), String> {
        // Without pip, which not every Python has for its environments: that of `python3` installs from outside.
        let mut create = Command::new("python3");
        create.args(["-m", "venv", "--clear", "--without-pip"]).arg(&self.folder);
        python::run("venv", &mut create)?;
        let mut install = self.pip("install");
        install.arg("--only-binary=:all:");
        for requirements in &self.requirements {
            install.arg("--requirement").arg(requirements);
        }
        python::run("pip", &mut install)?;
        let Some(sources) = &self.sources else { return Ok(()) };
        let mut fetch = self.pip("download");
        // It asks the package for its name, with what is installed here.
        fetch.args(["--no-binary=:all:", "--no-build-isolation", "--dest"]).arg(self.folder.join("sources"));
        python::run("pip", fetch.arg("--requirement").arg(sources))
    }

    /// A command of pip for this environment, in which all that is required is listed.
    fn pip(&self, command: &str) -> Command {
        let mut pip = Command::new("python3");
        pip.args(["-m", "pip", "--python"]).arg(self.python());
        pip.args([
            command,
            "--quiet",
            "--disable-pip-version-check",
            "--retries",
            "1",
            "--require-hashes",
            "--no-deps",
        ]);
        pip
    }

    /// Whether its Python is still there: it is a link to the one that made it.
    fn starts(&self) -> bool {
        Command::new(self.python()).args(["-c", ""]).status().is_ok_and(|status| status.success())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::os::unix::fs::symlink;
    use std::path::Path;

    /// Requirements that no index meets.
    fn environment(room: &Path) -> Environment {
        let requirements = room.join("requirements.txt");
        fs::write(&requirements, "nobody @ file:///nowhere.whl").unwrap();
        Environment { folder: room.join("python"), requirements: vec![requirements], sources: None }
    }

    #[test]
    fn what_is_installed_needs_no_network() {
        let room = tempfile::tempdir().unwrap();
        let environment = environment(room.path());
        fs::create_dir_all(environment.folder.join("bin")).unwrap();
        symlink("/bin/true", environment.python()).unwrap();
        fs::write(environment.stamp(), environment.wanted().unwrap()).unwrap();
        environment.ensure().unwrap();
    }

    #[test]
    fn what_cannot_be_installed_is_one_sentence_and_leaves_no_stamp() {
        let room = tempfile::tempdir().unwrap();
        let environment = environment(room.path());
        fs::create_dir_all(&environment.folder).unwrap();
        fs::write(environment.stamp(), "of other requirements").unwrap();
        let message = environment.ensure().unwrap_err().to_string();
        assert!(message.starts_with("what the outside clients need cannot be fetched (pip: "), "{message}");
        assert!(message.contains("`cargo xtask test`") && !message.contains('\n'), "{message}");
        assert!(!environment.stamp().exists());
    }

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
