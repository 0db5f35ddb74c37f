//! Folders that FMUs are unpacked to: they go with who uses them, also where a signal ends the program before that. What a program
//! left that was killed goes when the next one looks.
//!
//! A folder is locked as long as the process is there that uses it, however that ends.
use servobench_files::FolderLock;
use std::fs::{self, TryLockError};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError, RwLock, RwLockReadGuard};
use tempfile::TempDir;

/// Beginning of their names, before the number of the process.
const PREFIX: &str = "servobench-fmu-";

/// Those of this process that are there.
static THERE: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());
/// Is held for reading while something is written to one, and for writing when nothing may be any more.
static WRITING: RwLock<()> = RwLock::new(());

/// A folder that is removed when it is dropped.
#[derive(Debug)]
pub(super) struct Own {
    path: PathBuf,
    /// Until it is dropped.
    folder: Option<TempDir>,
    /// `None` on a file system without locks.
    _lock: Option<FolderLock>,
}

impl Own {
    /// A new one in `parent`.
    pub(super) fn new(parent: &Path) -> io::Result<Self> {
        let _writing = writing();
        let prefix = format!("{PREFIX}{}-", std::process::id());
        loop {
            let folder = tempfile::Builder::new().prefix(&prefix).tempdir_in(parent)?;
            let path = folder.path().to_owned();
            // Another program may take it for one that nobody uses any more before it is locked. A file system without locks has
            // none for that program either.
            let lock = FolderLock::of(&path);
            if !matches!(lock, Err(TryLockError::WouldBlock)) && path.is_dir() {
                there().push(path.clone());
                return Ok(Self { path, folder: Some(folder), _lock: lock.ok() });
            }
        }
    }

    pub(super) fn path(&self) -> &Path {
        &self.path
    }
}

impl Drop for Own {
    fn drop(&mut self) {
        // First it goes, then it is forgotten: a signal may come in between.
        drop(self.folder.take());
        there().retain(|folder| *folder != self.path);
    }
}

fn there() -> MutexGuard<'static, Vec<PathBuf>> {
    // Nothing is ever left half done with it.
    THERE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// To be held while something is written to a folder.
pub(super) fn writing() -> RwLockReadGuard<'static, ()> {
    WRITING.read().unwrap_or_else(PoisonError::into_inner)
}

/// Removes what programs have unpacked that were ended before they could remove it themselves.
pub fn remove_abandoned() {
    for entry in fs::read_dir(std::env::temp_dir()).into_iter().flatten().flatten() {
        let is_one = entry.file_name().to_string_lossy().starts_with(PREFIX);
        // A link is none of ours.
        if is_one
            && entry.file_type().is_ok_and(|kind| kind.is_dir())
            && let Ok(_lock) = FolderLock::of(&entry.path())
        {
            // Those of other users stay.
            fs::remove_dir_all(entry.path()).ok();
        }
    }
}

/// Removes all that this process has unpacked, and all that these processes have, which have ended without having done so. For a program
/// that ends: nothing is unpacked after that, and who tries waits for ever.
pub fn remove_unpacked(ended: &[u32]) {
    let stopped = WRITING.write().unwrap_or_else(PoisonError::into_inner);
    std::mem::forget(stopped);
    for folder in there().iter() {
        // What cannot be removed is only in the way.
        fs::remove_dir_all(folder).ok();
    }
    let prefixes: Vec<String> = ended.iter().map(|process| format!("{PREFIX}{process}-")).collect();
    for entry in fs::read_dir(std::env::temp_dir()).into_iter().flatten().flatten() {
        let name = entry.file_name().to_string_lossy().into_owned();
        if prefixes.iter().any(|prefix| name.starts_with(prefix)) {
            fs::remove_dir_all(entry.path()).ok();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A folder in use is locked; one whose program has ended is not, whatever its number says.
    #[test]
    fn what_is_in_use_is_locked() {
        let parent = tempfile::tempdir().unwrap();
        let own = Own::new(parent.path()).unwrap();
        assert!(matches!(FolderLock::of(own.path()), Err(TryLockError::WouldBlock)));
        let path = own.path().to_owned();
        drop(own);
        assert!(!path.exists());
    }
}
