//! Files taken from a Python wheel: the package index is the one place that carries the same native files for every machine with pip.
//! Python unpacks them too, so there is no archive code here.
//!
//! A file is pinned by its own SHA-256, not by that of the wheel: wheels for other Python versions hold the same file.
//! It is checked on every call; only a missing or changed file needs the network.
use crate::failure::Failure;
use crate::python;
use crate::workspace::Workspace;
use sha2::{Digest, Sha256};
use std::fs::{self, File};
use std::io;
use std::os::unix::fs::{PermissionsExt as _, symlink};
use std::path::{Path, PathBuf};
use std::process::Command;

/// A wheel and the files taken from it.
#[derive(Debug)]
pub(crate) struct Wheel {
    /// Name and version, for messages.
    name: &'static str,
    /// Requirement as pip wants it.
    requirement: &'static str,
    /// Command that fetches it.
    command: &'static str,
    /// Advice for continuing without it.
    otherwise: &'static str,
    /// Folder under the target folder.
    folder: &'static str,
    /// Platforms for which the content is known.
    platforms: &'static [Platform],
    /// Licence texts: member of the wheel and its place in the folder.
    licences: &'static [(&'static str, &'static str)],
    /// Required member of the wheel.
    member: &'static str,
    /// Its place in the folder.
    place: &'static str,
    /// A second name for it in the same folder.
    link: Option<&'static str>,
}

/// The wheel of one platform.
#[derive(Debug)]
struct Platform {
    /// Architecture as [`std::env::consts::ARCH`] names it.
    arch: &'static str,
    /// SHA-256 of the member.
    sha256: &'static str,
    /// Platform tags of the wheel.
    tags: &'static [&'static str],
}

/// The MuJoCo library.
pub(crate) const MUJOCO: Wheel = Wheel {
    name: "MuJoCo 3.17.0",
    requirement: "mujoco==3.17.0",
    command: "cargo xtask setup",
    otherwise: "`cargo xtask test --without-mujoco` goes without",
    folder: "native",
    platforms: &[
        Platform {
            arch: "x86_64",
            sha256: "23496b023ee80fb61ab71167e94bc649f9941710fde96b18bb8204fb332523ad",
            tags: &["manylinux_2_28_x86_64", "manylinux_2_27_x86_64"],
        },
        Platform {
            arch: "aarch64",
            sha256: "e2edd0204fb9229f75f332a4fcd1a32345bb9f90651dc0fddfa20ec0670db789",
            tags: &["manylinux_2_28_aarch64", "manylinux_2_27_aarch64"],
        },
    ],
    licences: &[
        ("mujoco-3.17.0.dist-info/licenses/LICENSE", "licenses/LICENSE"),
        ("mujoco-3.17.0.dist-info/licenses/LICENSES_THIRD_PARTY.md", "licenses/LICENSES_THIRD_PARTY.md"),
    ],
    member: "mujoco/libmujoco.so.3.17.0",
    place: "lib/libmujoco.so.3.17.0",
    // The name that the linker looks for; programs load the versioned name.
    link: Some("lib/libmujoco.so"),
};

/// The Rerun viewer of the version that `view` writes for.
pub(crate) const RERUN: Wheel = Wheel {
    name: "the Rerun viewer 0.36.3",
    requirement: "rerun-sdk==0.36.3",
    command: "cargo xtask viewer",
    otherwise: "any installed Rerun 0.36 opens the recordings too",
    folder: "viewer",
    platforms: &[
        Platform {
            arch: "x86_64",
            sha256: "40f6525132820f85c4f6fd69efb8ca30266449f3e78a046fb99f7286179446c3",
            tags: &["manylinux_2_28_x86_64"],
        },
        Platform {
            arch: "aarch64",
            sha256: "706978e77a488df7db778cfa088a1ecb2b7afcdaebb9fd60e270f7dda4bcc42a",
            tags: &["manylinux_2_28_aarch64"],
        },
    ],
    licences: &[],
    member: "rerun_sdk/rerun_cli/rerun",
    place: "bin/rerun",
    link: None,
};

impl Wheel {
    /// Makes sure that the file exists and is the right one; returns its path.
    ///
    /// # Errors
    /// [`Failure::Fetch`] with the cause and the remedy in one sentence.
    pub(crate) fn ensure(&self, workspace: &Workspace) -> Result<PathBuf, Failure> {
        let platform = self.platform(std::env::consts::OS, std::env::consts::ARCH)?;
        let folder = workspace.target.join(self.folder);
        let place = folder.join(self.place);
        if !self.is_complete(&folder, platform) {
            eprintln!("fetching {} (once)", self.name);
            self.install(&folder, platform)?;
        }
        Ok(place)
    }

    /// Licence texts of the wheel.
    pub(crate) fn licences(&self, workspace: &Workspace) -> impl Iterator<Item = PathBuf> {
        let folder = workspace.target.join(self.folder);
        self.licences.iter().map(move |&(_, place)| folder.join(place))
    }

    fn platform(&self, os: &str, arch: &str) -> Result<&Platform, Failure> {
        let known = self.platforms.iter().find(|p| os == "linux" && p.arch == arch);
        known.ok_or_else(|| self.failure(format!("no file is pinned for {arch} {os}")))
    }

    fn is_complete(&self, folder: &Path, platform: &Platform) -> bool {
        let right = sha256(&folder.join(self.place)).is_ok_and(|found| found == platform.sha256);
        let beside = self.licences.iter().map(|&(_, place)| place).chain(self.link);
        right && beside.into_iter().all(|place| folder.join(place).is_file())
    }

    /// Unpacks everything into a separate folder and renames it when it is right: an interrupted set-up leaves nothing half done.
    fn install(&self, folder: &Path, platform: &Platform) -> Result<(), Failure> {
        fs::create_dir_all(folder).map_err(Failure::file("create", folder))?;
        let room = tempfile::tempdir_in(folder).map_err(Failure::file("write into", folder))?;
        let wheel = self.download(room.path(), platform)?;
        let file = self.unpack(&wheel, self.member)?;
        let found = sha256(&file).map_err(Failure::file("read", &file))?;
        if found != platform.sha256 {
            let (member, pinned) = (self.member, platform.sha256);
            return Err(self.failure(format!("its SHA-256 is {found}, pinned is {pinned}: {member}")));
        }
        let executable = fs::Permissions::from_mode(0o755);
        fs::set_permissions(&file, executable).map_err(Failure::file("change", &file))?;
        move_into_place(&file, &folder.join(self.place))?;
        for &(member, place) in self.licences {
            move_into_place(&self.unpack(&wheel, member)?, &folder.join(place))?;
        }
        if let Some(link) = self.link {
            let fresh = room.path().join("link");
            let name = Path::new(self.place).file_name().unwrap_or(self.place.as_ref());
            symlink(name, &fresh).map_err(Failure::file("write", &fresh))?;
            move_into_place(&fresh, &folder.join(link))?;
        }
        Ok(())
    }

    /// The wheel for `platform`, in `room`.
    fn download(&self, room: &Path, platform: &Platform) -> Result<PathBuf, Failure> {
        let mut pip = Command::new("python3");
        pip.args(["-m", "pip", "download", "--quiet", "--disable-pip-version-check"]);
        pip.args(["--retries", "1", "--no-deps", "--only-binary=:all:"]);
        // A fixed Python version, so that every Python, old or new, gets the same wheel.
        pip.args(["--implementation", "cp", "--python-version", "3.11"]);
        for tag in platform.tags {
            pip.args(["--platform", tag]);
        }
        self.python("pip", pip.arg("--dest").arg(room).arg(self.requirement))?;
        let mut files = fs::read_dir(room).map_err(Failure::file("read", room))?.flatten();
        let wheel = files.find(|file| file.path().extension().is_some_and(|e| e == "whl"));
        wheel.map(|file| file.path()).ok_or_else(|| self.failure("pip brought no wheel".into()))
    }

    /// One member of `wheel`, as a file beside it.
    fn unpack(&self, wheel: &Path, member: &str) -> Result<PathBuf, Failure> {
        let file = wheel.with_file_name("member");
        let mut unzip = Command::new("python3");
        unzip.args(["-c", UNZIP]).arg(wheel).arg(member).arg(&file);
        self.python("zipfile", &mut unzip)?;
        Ok(file)
    }

    fn python(&self, tool: &str, command: &mut Command) -> Result<(), Failure> {
        python::run(tool, command).map_err(|why| self.failure(why))
    }

    fn failure(&self, why: String) -> Failure {
        let help = format!(
            "`{}` fetches it with Python 3, pip and a package index in reach, and {}",
            self.command, self.otherwise
        );
        Failure::Fetch { name: self.name.into(), why, help }
    }
}

/// Copies one member (second argument) of a zip file (first) to a file (third).
const UNZIP: &str = "import shutil, sys, zipfile
with zipfile.ZipFile(sys.argv[1]).open(sys.argv[2]) as member, open(sys.argv[3], 'wb') as file:
    shutil.copyfileobj(member, file)";

/// SHA-256 of a file, in hexadecimal digits.
pub(crate) fn sha256(path: &Path) -> io::Result<String> {
    let mut hash = Sha256::new();
    io::copy(&mut File::open(path)?, &mut hash)?;
    Ok(format!("{:x}", hash.finalize()))
}

fn move_into_place(from: &Path, to: &Path) -> Result<(), Failure> {
    if let Some(parent) = to.parent() {
        fs::create_dir_all(parent).map_err(Failure::file("create", parent))?;
    }
    fs::rename(from, to).map_err(Failure::file("write", to))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A wheel that no index has, with a file that is there already.
    fn installed(sha256: &'static str) -> (tempfile::TempDir, Workspace, Wheel) {
        let target = tempfile::tempdir().unwrap();
        let place = target.path().join("native/lib/libmujoco.so.3.17.0");
        fs::create_dir_all(place.parent().unwrap()).unwrap();
        fs::write(&place, "abc").unwrap();
        let workspace = Workspace { root: ".".into(), target: target.path().into() };
        let platforms = ["x86_64", "aarch64"].map(|arch| Platform { arch, sha256, tags: &[] });
        let requirement = "no wheel has this name @ file:///nowhere.whl";
        let platforms = Box::leak(Box::new(platforms));
        (target, workspace, Wheel { requirement, platforms, licences: &[], link: None, ..MUJOCO })
    }

    /// FIPS 180-4, example B.1.
    const ABC: &str = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";

    #[test]
    fn a_file_with_the_pinned_hash_needs_no_network() {
        let (_target, workspace, wheel) = installed(ABC);
        let library = wheel.ensure(&workspace).unwrap();
        assert_eq!(fs::read(library).unwrap(), b"abc");
    }

    #[test]
    fn a_changed_file_is_fetched_again_and_the_failure_is_one_sentence() {
        let (_target, workspace, wheel) = installed("00");
        let message = wheel.ensure(&workspace).unwrap_err().to_string();
        assert!(message.starts_with("MuJoCo 3.17.0 cannot be fetched ("), "{message}");
        assert!(message.contains("`cargo xtask setup`") && !message.contains('\n'), "{message}");
        let left = fs::read_dir(workspace.target.join("native")).unwrap().count();
        assert_eq!(left, 1, "the folder of the failed set-up is gone");
    }

    #[test]
    fn a_platform_without_a_pinned_file_is_refused() {
        let message = MUJOCO.platform("linux", "riscv64").unwrap_err().to_string();
        assert!(message.contains("no file is pinned for riscv64 linux"), "{message}");
        assert!(MUJOCO.platform("macos", "aarch64").is_err());
        assert!(MUJOCO.platform("linux", "aarch64").is_ok());
    }
}
