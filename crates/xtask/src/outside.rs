//! Outside clients: programs in `tests/outside/` that hold the project against what others wrote, published for Python.
//!
//! Their packages are pinned by version and hash in `tests/outside/requirements.txt`, with all that these require, and in
//! `files.txt`, of which only files are used. They are installed once, into a virtual environment under the target folder. Where
//! that cannot be had, the programs are left out, and it is said.
use crate::failure::Failure;
use crate::python;
use crate::wheel::sha256;
use crate::workspace::Workspace;
use std::fs;
use std::path::PathBuf;
use std::process::Command;

/// The programs, in `tests/outside/`.
const CLIENTS: [&str; 6] = [
    "exported_fmus_by_fmpy.py",
    "fmus_by_fmpy.py",
    "object_dictionary_by_canopen.py",
    "online4_by_linear_program.py",
    "optimal_by_linear_program.py",
    "order3_by_ruckig.py",
];

/// The programs that can be run here, and why none can.
#[derive(Debug)]
pub(crate) enum Outside {
    /// All, by this Python.
    Installed(PathBuf),
    /// None, for this reason.
    Missing(Failure),
}

impl Outside {
    /// Installs what the programs need, unless it is there.
    pub(crate) fn prepare(workspace: &Workspace) -> Self {
        let environment = Environment::of(workspace);
        match environment.ensure() {
            Ok(()) => Self::Installed(environment.python()),
            Err(why) => Self::Missing(why),
        }
    }

    /// One command for each program that can be run.
    pub(crate) fn commands(&self, workspace: &Workspace) -> Vec<Command> {
        let Self::Installed(python) = self else { return Vec::new() };
        let command = |client| {
            // No byte code between the sources; what a program prints is seen at once.
            workspace.command(python, ["-B", "-u", &format!("{FOLDER}/{client}")])
        };
        CLIENTS.into_iter().map(command).collect()
    }

    /// Says what is left out, if anything is.
    pub(crate) fn report(&self) {
        if let Self::Missing(why) = self {
            println!("LEFT OUT, outside clients: {}\n  {why}", CLIENTS.join(", "));
        }
    }
}

/// Where the programs are.
const FOLDER: &str = "tests/outside";

/// A virtual environment with exactly the packages of some requirements files.
#[derive(Debug)]
struct Environment {
    folder: PathBuf,
    requirements: Vec<PathBuf>,
}

impl Environment {
    fn of(workspace: &Workspace) -> Self {
        Self {
            folder: workspace.target.join("python"),
            requirements: ["requirements.txt", "files.txt"].map(|name| workspace.root.join(FOLDER).join(name)).into(),
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
            way_out: "`cargo xtask test` fetches it with Python 3.11 or later, pip and a package index in reach".into(),
        })?;
        fs::write(self.stamp(), wanted).map_err(Failure::file("write", self.stamp()))
    }

    /// What the stamp has to be.
    fn wanted(&self) -> Result<String, Failure> {
        let sum = |path: &PathBuf| sha256(path).map_err(Failure::file("read", path));
        Ok(self.requirements.iter().map(sum).collect::<Result<Vec<_>, _>>()?.join("\n"))
    }

    /// # Errors
    /// The cause in one line.
    fn install(&self) -> Result<(), String> {
        // Without pip, which not every Python has for its environments: that of `python3` installs from outside.
        let mut create = Command::new("python3");
        create.args(["-m", "venv", "--clear", "--without-pip"]).arg(&self.folder);
        python::run("venv", &mut create)?;
        let mut install = Command::new("python3");
        install.args(["-m", "pip", "--python"]).arg(self.python());
        install.args(["install", "--quiet", "--disable-pip-version-check", "--retries", "1"]);
        // All that is required is listed.
        install.args(["--only-binary=:all:", "--require-hashes", "--no-deps"]);
        for requirements in &self.requirements {
            install.arg("--requirement").arg(requirements);
        }
        python::run("pip", &mut install)
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
        Environment { folder: room.join("python"), requirements: vec![requirements] }
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
        assert_eq!(names, CLIENTS);
    }
}
