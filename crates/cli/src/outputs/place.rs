//! Place that a path leads to: an existing one is identified by device and inode, so that neither links nor `./x` hide it, a missing one
//! by its folder and its name.
use servobench_files::FileId;
use std::path::{Component, Path, PathBuf};

/// A name in a folder, as found now.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub(super) struct Place {
    /// The nearest existing folder; `None` where not even the root can be examined.
    folder: Option<FileId>,
    /// Path below that folder.
    name: PathBuf,
}

impl Place {
    /// Place of `path`. A link as its last part is not followed: writing replaces it.
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

    /// The name of this file if it is directly in `folder`.
    pub(super) fn name_in(&self, folder: &Self) -> Option<&str> {
        let is_there = self.folder == folder.folder && self.name.parent() == Some(&folder.name);
        self.name.file_name().filter(|_| is_there)?.to_str()
    }
}

/// Path of the folders `missing`, innermost first, that do not exist yet.
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
        // Missing files.
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
}
