//! Virtual environments of Python for programs that check the project against foreign software.
//!
//! Their packages are pinned by version and hash in requirements files, with all dependencies except those that are never called. They
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
    /// Owner of the packages, for messages.
    pub(crate) owner: &'static str,
    /// Command that fetches them.
    pub(crate) command: &'static str,
    /// Folder of the environment.
    pub(crate) folder: PathBuf,
    /// Requirements files of its packages.
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

    /// Makes sure that the environment exists and has the required packages.
    ///
    /// # Errors
    /// [`Failure::Fetch`] with the cause and the remedy in one sentence.
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

    /// Required content of the stamp.
    fn wanted(&self) -> Result<String, Failure> {
        let sum = |path: &PathBuf| sha256(path).map_err(Failure::file("read", path));
        Ok(self.requirements.iter().chain(&self.sources).map(sum).collect::<Result<Vec<_>, _>>()?.join("\n"))
    }

    /// # Errors
    /// The cause in one line.
    fn install(&self) -> Result<(), String> {
        // Without pip, which not every Python offers for its environments: that of `python3` installs from outside.
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
        // pip runs the package's build to get its name, with the packages installed here.
        fetch.args(["--no-binary=:all:", "--no-build-isolation", "--dest"]).arg(self.folder.join("sources"));
        python::run("pip", fetch.arg("--requirement").arg(sources))
    }

    /// A command of pip for this environment, without dependencies beyond the listed ones.
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

    /// True if its Python still starts: it is a link to the one that made it.
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
