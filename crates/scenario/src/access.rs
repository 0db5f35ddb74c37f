//! Files that a scenario may read: regular files of bounded size within its root, each recorded with its digest.
//!
//! A scenario that arrives by a pull request is foreign text. The files it names are read on a machine with keys and tokens, so
//! it must not reach outside its own project: symbolic links are resolved before a path is checked. The rule for the root: see
//! [`root_of`]. Every file of a scenario is read through this module.
use servobench_files::{FileRole, MadeOf, is_shortage, metadata, open, read, sha256};
use std::collections::{HashMap, HashSet};
use std::io;
use std::path::{Component, Path, PathBuf};
use std::sync::Arc;

/// Folder, or file of a worktree, that marks the root of a project.
const PROJECT: &str = ".git";

/// Largest size of a scenario (bytes): the longest in practice have some hundred thousand, and may contain long texts.
pub const MOST_OF_A_SCENARIO: u64 = 16 << 20;
/// Largest size of a model (bytes): data sheets have some kilobytes.
const MOST_OF_A_MODEL: u64 = 1 << 20;
/// Largest size of a table (bytes): two million points. It is held in memory as a whole, in addition to the values read from it.
const MOST_OF_A_TABLE: u64 = 64 << 20;
/// Largest size of an MJCF file (bytes): a model of a humanoid has 100 kB.
const MOST_OF_AN_MJCF: u64 = 16 << 20;
/// Largest size of a mesh or a texture (bytes), which is only hashed here.
const MOST_OF_AN_ASSET: u64 = 256 << 20;
/// Largest size of an FMU (bytes): some carry a whole interpreter.
const MOST_OF_AN_FMU: u64 = 1 << 30;
/// Largest size of all files of a scenario together (bytes), so that a thousand names do not add up to hours.
const MOST_OF_ALL: u64 = 2 << 30;

/// Files that a scenario may read, and the record of those that it has read.
#[derive(Debug, Clone, Default)]
pub(crate) struct FileAccess {
    /// Folder of all files, links resolved; `None`: only embedded files can be read.
    root: Option<PathBuf>,
    made_of: Vec<MadeOf>,
    /// Files read or hashed so far, by resolved path.
    known: HashSet<(PathBuf, FileRole)>,
    texts: HashMap<PathBuf, Arc<str>>,
    total: u64,
    /// File that could not be read for a shortage of a system resource, with the system's error number.
    shortage: Option<(PathBuf, i32)>,
}

/// Reason why a file is not read, with advice.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Refused {
    pub(crate) message: String,
    pub(crate) help: &'static str,
}

/// Reason why a file is not read, without a message.
#[derive(Debug)]
enum Refusal {
    Unreadable(io::Error),
    Outside,
    /// A scenario without a folder has no files.
    NoFolder,
}

/// Help for a path that does not exist.
pub(crate) const RELATIVE: &str = "the path is relative to this file";

const WAY_OUT: &str = "files of a scenario stay within its project, the nearest folder above it with a `.git`, or else within its own folder; \
                       a folder that holds both is allowed by `--root DIR`";

/// Folder above all files of a scenario in `folder`, links resolved: `given`, else the nearest folder from `folder` upwards that has a
/// `.git`, else `folder` itself.
///
/// # Errors
/// Errors of the operating system, if the folder does not exist.
pub fn root_of(folder: &Path, given: Option<&Path>) -> io::Result<PathBuf> {
    let resolved = |folder: &Path| if folder.as_os_str().is_empty() { Path::new(".") } else { folder }.canonicalize();
    let root = if let Some(given) = given {
        resolved(given)?
    } else {
        let own = resolved(folder)?;
        let project = own.ancestors().find(|above| above.join(PROJECT).symlink_metadata().is_ok());
        project.map_or_else(|| own.clone(), Path::to_owned)
    };
    if root.is_dir() { Ok(root) } else { Err(io::Error::new(io::ErrorKind::NotADirectory, "it is not a folder")) }
}

impl FileAccess {
    /// Access for a scenario in `folder`: to everything below its root.
    ///
    /// # Errors
    /// Errors of the operating system, if the folder does not exist.
    pub(crate) fn of_folder(folder: &Path, given: Option<&Path>) -> io::Result<Self> {
        Ok(Self { root: Some(root_of(folder, given)?), ..Self::default() })
    }

    /// The root, links resolved.
    pub(crate) fn root(&self) -> Option<&Path> {
        self.root.as_deref()
    }

    /// Files read, in the order of reading.
    pub(crate) fn into_made_of(self) -> Vec<MadeOf> {
        self.made_of
    }

    /// File that could not be read for a shortage of a system resource, with the error.
    pub(crate) fn shortage(&self) -> Option<(PathBuf, io::Error)> {
        self.shortage.as_ref().map(|(path, code)| (path.clone(), io::Error::from_raw_os_error(*code)))
    }

    /// Refusal of the file at `path` for an error of the system; notes a shortage.
    fn unreadable(&mut self, path: &Path, error: io::Error) -> Refusal {
        if is_shortage(&error) {
            self.shortage = error.raw_os_error().map(|code| (path.to_owned(), code));
        }
        Refusal::Unreadable(error)
    }

    /// Reason why the file at `path` is not read, for a message about the key that names it.
    fn told(&self, path: &Path, refusal: &Refusal) -> Refused {
        let name = path.display();
        match refusal {
            Refusal::Unreadable(error) => Refused { message: format!("cannot read `{name}`: {error}"), help: RELATIVE },
            Refusal::Outside => Refused { message: format!("`{name}` is {}", self.outside()), help: WAY_OUT },
            Refusal::NoFolder => {
                let message = format!("`{name}` is not read: a scenario without a folder cannot name files");
                Refused { message, help: "" }
            }
        }
    }

    fn outside(&self) -> String {
        format!("outside of the root of this scenario, `{}`", self.root().unwrap_or(Path::new("")).display())
    }

    /// True if a folder is within the root.
    pub(crate) fn has_folder(&self, folder: &Path) -> bool {
        let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
        self.root.as_ref().zip(folder.canonicalize().ok()).is_some_and(|(root, real)| real.starts_with(root))
    }

    /// The text of the file at `path`. A file named again is not read again.
    pub(crate) fn text(&mut self, path: &Path, role: FileRole) -> Result<Arc<str>, Refused> {
        self.read(path, role).map_err(|refusal| self.told(path, &refusal))
    }

    /// The text of the scenario at `path` itself.
    ///
    /// # Errors
    /// Errors of the operating system, or the reason why it is not read, without its name.
    pub(crate) fn scenario(&mut self, path: &Path) -> io::Result<Arc<str>> {
        self.read(path, FileRole::Scenario).map_err(|refusal| match refusal {
            Refusal::Unreadable(error) => error,
            Refusal::Outside | Refusal::NoFolder => io::Error::other(format!("it is {}; {WAY_OUT}", self.outside())),
        })
    }

    fn read(&mut self, path: &Path, role: FileRole) -> Result<Arc<str>, Refusal> {
        let real = self.within(path)?;
        let text = if let Some(text) = self.texts.get(&real) {
            Arc::clone(text)
        } else {
            let bytes = read(&real, self.left(role)).map_err(|error| self.unreadable(path, error))?;
            let text =
                String::from_utf8(bytes).map_err(|_| Refusal::Unreadable(io::Error::other("it is not UTF-8 text")))?;
            self.total += text.len() as u64;
            let text: Arc<str> = text.into();
            self.texts.insert(real.clone(), Arc::clone(&text));
            text
        };
        if self.known.insert((real.clone(), role)) {
            self.made_of.push(MadeOf::of_bytes(self.path_from_root(&real), role, text.as_bytes()));
        }
        Ok(text)
    }

    /// Hashes and records the file at `path`, which a library reads.
    pub(crate) fn look_through(&mut self, path: &Path, role: FileRole) -> Result<(), Refused> {
        let real = self.within(path).map_err(|refusal| self.told(path, &refusal))?;
        if self.known.contains(&(real.clone(), role)) {
            return Ok(());
        }
        let most = self.left(role);
        let digest = open(&real, most).and_then(sha256);
        let (sha256, size) = digest.map_err(|error| {
            let refusal = self.unreadable(path, error);
            self.told(path, &refusal)
        })?;
        self.total += size;
        self.made_of.push(MadeOf { path: self.path_from_root(&real), role, size, sha256 });
        self.known.insert((real, role));
        Ok(())
    }

    /// True if there is a regular file at `path`; a file outside the root is an error.
    pub(crate) fn has_file(&self, path: &Path, role: FileRole) -> Result<bool, Refused> {
        if path.symlink_metadata().is_err() {
            return Ok(false);
        }
        let found = self.within(path).and_then(|real| metadata(&real, most_of(role)).map_err(Refusal::Unreadable));
        found.map(|_| true).map_err(|refusal| self.told(path, &refusal))
    }

    /// Records an embedded file.
    pub(crate) fn embedded(&mut self, path: String, role: FileRole, text: &str) -> Arc<str> {
        let place = PathBuf::from(&path);
        if self.known.insert((place.clone(), role)) {
            self.made_of.push(MadeOf::of_bytes(path, role, text.as_bytes()));
        }
        Arc::clone(self.texts.entry(place).or_insert_with(|| text.into()))
    }

    /// Records the scenario itself, whose text was not read from a file here.
    pub(crate) fn note_scenario(&mut self, name: &str, text: &str) {
        self.made_of.insert(0, MadeOf::of_bytes(name.to_owned(), FileRole::Scenario, text.as_bytes()));
    }

    /// The path with links resolved, if it is within the root. A path outside is refused alike whether it exists or not: the scenario
    /// must not learn which.
    fn within(&self, path: &Path) -> Result<PathBuf, Refusal> {
        let root = self.root.as_ref().ok_or(Refusal::NoFolder)?;
        match path.canonicalize() {
            Ok(real) if real.starts_with(root) => Ok(real),
            Err(error) if lexical(path).is_some_and(|path| path.starts_with(root)) => Err(Refusal::Unreadable(error)),
            Ok(_) | Err(_) => Err(Refusal::Outside),
        }
    }

    /// Bytes that may still be read from a file.
    fn left(&self, role: FileRole) -> u64 {
        most_of(role).min(MOST_OF_ALL.saturating_sub(self.total))
    }

    fn path_from_root(&self, real: &Path) -> String {
        let path = self.root.as_ref().and_then(|root| real.strip_prefix(root).ok()).unwrap_or(real);
        path.components().map(|part| part.as_os_str().to_string_lossy()).collect::<Vec<_>>().join("/")
    }
}

const fn most_of(role: FileRole) -> u64 {
    match role {
        FileRole::Scenario => MOST_OF_A_SCENARIO,
        FileRole::AxisModel | FileRole::MotorModel | FileRole::DriveModel => MOST_OF_A_MODEL,
        FileRole::Table => MOST_OF_A_TABLE,
        FileRole::Mjcf => MOST_OF_AN_MJCF,
        FileRole::MjcfAsset => MOST_OF_AN_ASSET,
        FileRole::Fmu => MOST_OF_AN_FMU,
    }
}

/// Target of a path that does not exist: links resolved as far as they exist, the rest as written.
fn lexical(path: &Path) -> Option<PathBuf> {
    let mut real = std::env::current_dir().ok()?.canonicalize().ok()?;
    for part in path.components() {
        match part {
            Component::ParentDir => drop(real.pop()),
            Component::CurDir => {}
            Component::RootDir | Component::Prefix(_) => real = PathBuf::from(part.as_os_str()),
            Component::Normal(name) => {
                real.push(name);
                real = real.canonicalize().unwrap_or(real);
            }
        }
    }
    Some(real)
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;
    use std::fs;
    use std::os::unix::fs::symlink;

    /// A project with a scenario in a folder, and a file beside the project.
    fn room() -> tempfile::TempDir {
        let room = tempfile::tempdir().unwrap();
        fs::create_dir_all(room.path().join("project/.git")).unwrap();
        fs::create_dir_all(room.path().join("project/scenarios/data")).unwrap();
        fs::write(room.path().join("project/table.csv"), "t").unwrap();
        fs::write(room.path().join("secret"), "s").unwrap();
        room
    }

    #[test]
    fn the_root_is_what_is_given_the_project_or_the_own_folder() {
        let room = room();
        let real = room.path().canonicalize().unwrap();
        let (project, own) = (real.join("project"), real.join("project/scenarios"));
        let root = |folder: &Path, given| FileAccess::of_folder(folder, given).unwrap().root().unwrap().to_owned();
        assert_eq!(root(&own.join("data"), None), project);
        assert_eq!(root(&own, Some(&real)), real);
        fs::remove_dir(project.join(".git")).unwrap();
        assert_eq!(root(&own, None), own);
        // A worktree has a file.
        fs::write(project.join(".git"), "gitdir: elsewhere").unwrap();
        assert_eq!(root(&own, None), project);
        assert!(FileAccess::of_folder(&own, Some(&real.join("secret"))).is_err());
    }

    #[test]
    fn nothing_leads_out_of_the_root() {
        let room = room();
        let own = room.path().join("project/scenarios");
        let mut access = FileAccess::of_folder(&own, None).unwrap();
        assert_eq!(&*access.text(&own.join("../table.csv"), FileRole::Table).unwrap(), "t");
        symlink("../../secret", own.join("link")).unwrap();
        symlink("../../", own.join("above")).unwrap();
        symlink("data", own.join("inner")).unwrap();
        fs::write(own.join("data/x"), "x").unwrap();
        for path in
            ["../../secret", "link", "above/secret", "/etc/passwd", "../../nothing", "/nothing", "above/nothing"]
        {
            let refused = access.text(&own.join(path), FileRole::Table).unwrap_err();
            assert!(
                refused.message.contains("is outside of the root") && refused.help.contains("--root"),
                "{path}: {refused:?}"
            );
            assert_eq!(access.look_through(&own.join(path), FileRole::Fmu).unwrap_err(), refused);
        }
        assert_eq!(&*access.text(&own.join("inner/x"), FileRole::Table).unwrap(), "x");
        let missing = access.text(&own.join("nothing"), FileRole::Table).unwrap_err();
        assert!(missing.message.contains("No such file"), "{missing:?}");
        let read: Vec<_> = access.into_made_of().into_iter().map(|file| (file.path, file.size)).collect();
        assert_eq!(read, [("table.csv".to_owned(), 1), ("scenarios/data/x".to_owned(), 1)]);
    }

    #[test]
    fn a_file_that_is_named_again_is_read_once() {
        let room = room();
        let path = room.path().join("project/table.csv");
        let mut access = FileAccess::of_folder(room.path(), Some(room.path())).unwrap();
        let first = access.text(&path, FileRole::Table).unwrap();
        fs::write(&path, "another").unwrap();
        assert!(Arc::ptr_eq(&first, &access.text(&path, FileRole::Table).unwrap()));
        assert_eq!(access.total, 1);
        access.look_through(&path, FileRole::Fmu).unwrap();
        access.look_through(&path, FileRole::Fmu).unwrap();
        assert_eq!((access.total, access.into_made_of().len()), (8, 2));
    }
}
