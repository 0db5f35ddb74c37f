//! Where a path leads: what is there is known by device and inode, so that neither links nor `./x` hide it; what is not there yet
//! by its folder and its name.
use servobench_files::FileId;
use std::fs::Metadata;
use std::path::{Component, Path, PathBuf};

/// Links that are followed at most, as Linux has it.
const MOST_LINKS: usize = 40;

/// A name in a folder, both as they are found now.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub(super) struct Place {
    /// The nearest folder that is there; `None` where not even the root can be asked.
    folder: Option<FileId>,
    /// What is below it.
    name: PathBuf,
}

/// What a path is, for who wants to write there.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    /// A regular file, or nothing yet: it is replaced as a whole.
    File,
    Folder,
    /// A device: what is written goes there at once, and several may write there.
    Device,
    /// A pipe, a socket, or a descriptor of this process by its name below `/dev` or `/proc`.
    Pipe,
    /// Standard output by such a name.
    StandardOutput,
    /// Standard error by such a name.
    StandardError,
}

/// What standard input comes from, if that is a regular file.
pub(super) fn of_stdin() -> Option<FileId> {
    let stdin = Path::new("/dev/stdin");
    std::fs::metadata(stdin).is_ok_and(|found| found.is_file()).then(|| FileId::of(stdin).ok()).flatten()
}

impl Place {
    /// Where `path` leads. A name in a folder is that name, whatever it leads to in turn: what is written there takes its place.
    pub(super) fn of(path: &Path) -> Self {
        let path = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
        let is_name = matches!(path.components().next_back(), Some(Component::Normal(_)));
        let (mut folder, mut missing) = (path.as_path(), Vec::new());
        loop {
            let is_looked_up = !(is_name && missing.is_empty());
            if let Some(found) = is_looked_up.then(|| FileId::of(folder).ok()).flatten() {
                return Self { folder: Some(found), name: below(&missing) };
            }
            let Some(above) = folder.parent() else { return Self { folder: None, name: path.clone() } };
            missing.extend(folder.components().next_back());
            folder = above;
        }
    }

    /// The folder at `path`, for the files in it.
    pub(super) fn of_folder(path: &Path) -> Self {
        FileId::of(path).map_or_else(|_| Self::of(path), |folder| Self { folder: Some(folder), name: PathBuf::new() })
    }

    /// The name of this file, when it is one in `folder` itself.
    pub(super) fn name_in(&self, folder: &Self) -> Option<&str> {
        let is_there = self.folder == folder.folder && self.name.parent() == Some(&folder.name);
        self.name.file_name().filter(|_| is_there)?.to_str()
    }
}

/// The folders `missing`, the innermost first, that somebody has still to make.
fn below(missing: &[Component<'_>]) -> PathBuf {
    let mut path = PathBuf::new();
    for part in missing.iter().rev() {
        match part {
            Component::ParentDir => {
                path.pop();
            }
            part => path.push(part),
        }
    }
    path
}

impl Kind {
    /// What is at `path`, links followed.
    pub(super) fn of(path: &Path) -> Self {
        if let Some(number) = descriptor(path) {
            return match number {
                1 => Self::StandardOutput,
                2 => Self::StandardError,
                _ => Self::Pipe,
            };
        }
        match std::fs::metadata(path) {
            Ok(found) if found.is_dir() => Self::Folder,
            Ok(found) => Self::in_metadata(&found),
            Err(_) => Self::File,
        }
    }

    #[cfg(unix)]
    fn in_metadata(found: &Metadata) -> Self {
        use std::os::unix::fs::FileTypeExt;
        let kind = found.file_type();
        if kind.is_char_device() || kind.is_block_device() {
            Self::Device
        } else if kind.is_fifo() || kind.is_socket() {
            Self::Pipe
        } else {
            Self::File
        }
    }

    #[cfg(not(unix))]
    fn in_metadata(_: &Metadata) -> Self {
        Self::File
    }
}

/// The descriptor of this process that `path` is a name of: `/dev/stdout` and `/dev/fd/1` lead to `/proc/self/fd/1`, which is a link to
/// whatever is open there. To replace one of these links would help nobody.
fn descriptor(path: &Path) -> Option<u32> {
    let mut path = std::path::absolute(path).ok()?;
    for _ in 0..MOST_LINKS {
        let (folder, name) = (path.parent()?.canonicalize().ok()?, path.file_name()?);
        if is_own_descriptors(&folder) {
            return name.to_str()?.parse().ok();
        }
        path = folder.join(std::fs::read_link(folder.join(name)).ok()?);
    }
    None
}

/// Whether the real path `folder` is `/proc/ID/fd` of this process.
fn is_own_descriptors(folder: &Path) -> bool {
    let names = ["/proc/self/fd", "/proc/thread-self/fd"];
    names.iter().any(|name| Path::new(name).canonicalize().is_ok_and(|real| real == folder))
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;
    use std::fs;
    use std::os::unix::fs::symlink;

    #[test]
    fn neither_links_nor_detours_hide_a_file() {
        let there = tempfile::tempdir().unwrap();
        let path = |name: &str| there.path().join(name);
        fs::write(path("a"), "a").unwrap();
        fs::write(path("b"), "a").unwrap();
        fs::create_dir(path("folder")).unwrap();
        symlink(path("a"), path("link")).unwrap();
        fs::hard_link(path("a"), path("hard")).unwrap();
        for name in ["link", "hard", "./a", "folder/../a"] {
            assert_eq!(FileId::of(&path(name)).unwrap(), FileId::of(&path("a")).unwrap(), "{name}");
        }
        assert_ne!(FileId::of(&path("b")).unwrap(), FileId::of(&path("a")).unwrap());
        // What is not there yet.
        assert_eq!(Place::of(&path("new")), Place::of(&path("folder/../new")));
        assert_eq!(Place::of(&path("x/y/../new")), Place::of(&path("x/new")));
        symlink(path("folder"), path("to-folder")).unwrap();
        assert_eq!(Place::of(&path("to-folder/new")), Place::of(&path("folder/new")));
        assert_ne!(Place::of(&path("folder/new")), Place::of(&path("new")));
        assert_eq!(Place::of(Path::new("/")), Place::of_folder(Path::new("/")));
        for folder in ["folder", "to-folder", "folder/..", "x/y/..", "none", "none/"] {
            let (inside, folder) = (Place::of(&path(folder).join("new")), Place::of_folder(&path(folder)));
            assert_eq!(inside.name_in(&folder), Some("new"), "{folder:?}");
            assert_eq!(Place::of(&path("other/new")).name_in(&folder), None, "{folder:?}");
        }
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn devices_and_descriptors_are_told_from_files() {
        let there = tempfile::tempdir().unwrap();
        for (path, kind) in [
            ("/dev/null", Kind::Device),
            ("/dev/stdout", Kind::StandardOutput),
            ("/proc/self/fd/1", Kind::StandardOutput),
            ("/dev/stderr", Kind::StandardError),
            ("/dev/fd/2", Kind::StandardError),
            ("/dev/stdin", Kind::Pipe),
            ("/tmp", Kind::Folder),
            ("/proc/version", Kind::File),
            ("/no/such/folder/x", Kind::File),
        ] {
            assert_eq!(Kind::of(Path::new(path)), kind, "{path}");
        }
        let link = there.path().join("out.csv");
        symlink("/dev/stdout", &link).unwrap();
        assert_eq!(Kind::of(&link), Kind::StandardOutput);
    }
}
