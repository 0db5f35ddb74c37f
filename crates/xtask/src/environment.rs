//! Virtual environments of Python for programs that hold the project against what others wrote.
//!
//! Their packages are pinned by version and hash in requirements files, with all that these require but what is never called. They
//! are installed once, under the target folder.
use crate::failure::Failure;
use crate::python;
use crate::wheel::sha256;
use std::fs;
use std::path::PathBuf;
use std::process::Command;

/// A virtual environment with exactly the packages of some requirements files.
#[derive(Debug)]
pub(crate) struct Environment {
    /// Whose packages they are, for messages.
    pub(crate) owner: &'static str,
    /// Command that fetches them.
    pub(crate) command: &'static str,
    /// Where it is.
    pub(crate) folder: PathBuf,
    /// What is installed there.
    pub(crate) requirements: Vec<PathBuf>,
    /// Packages whose source is fetched, into its folder `sources`, and not installed.
    pub(crate) sources: Option<PathBuf>,
}

impl Environment {
    /// Its Python.
    pub(crate) fn python(&self) -> PathBuf {
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
    pub(crate) fn ensure(&self) -> Result<(), Failure> {
        let wanted = self.wanted()?;
        if fs::read_to_string(self.stamp()).is_ok_and(|found| found == wanted) && self.starts() {
            return Ok(());
        }
        eprintln!("fetching the Python packages of {} (once)", self.owner);
        self.install().map_err(|why| Failure::Fetch {
            name: format!("what {} need", self.owner),
            why,
            help: format!("`{}` fetches it with Python 3.11 or later, pip and a package index in reach", self.command),
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
        Environment {
            owner: "the outside clients",
            command: "cargo xtask test",
            folder: room.join("python"),
            requirements: vec![requirements],
            sources: None,
        }
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
}
