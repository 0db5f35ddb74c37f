//! Folders for unpacked FMUs: they are removed with their users, also when a signal ends the program first. Folders left by a killed
//! program are removed when the next one looks.
//!
//! A folder is locked while the process that uses it lives, however that ends.
use servobench_files::FolderLock;
use std::fs::{self, TryLockError};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError, RwLock, RwLockReadGuard};
use tempfile::TempDir;

/// Prefix of the folders' names, followed by the process number.
const PREFIX: &str = "servobench-fmu-";

/// Existing folders of this process.
static THERE: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());
/// Locked for reading while something is written to a folder, and for writing when nothing may be written any more.
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
            // Another program may take it for abandoned before it is locked. On a file system without locks that program cannot lock it
            // either.
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
        // Removed first, forgotten afterwards: a signal may come in between.
        drop(self.folder.take());
        there().retain(|folder| *folder != self.path);
    }
}

fn there() -> MutexGuard<'static, Vec<PathBuf>> {
    // Its data are never left inconsistent.
    THERE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Guard to hold while something is written to a folder.
pub(super) fn writing() -> RwLockReadGuard<'static, ()> {
    WRITING.read().unwrap_or_else(PoisonError::into_inner)
}

/// Removes folders of programs that were killed before they could remove them.
pub fn remove_abandoned() {
    for entry in fs::read_dir(std::env::temp_dir()).into_iter().flatten().flatten() {
        let is_one = entry.file_name().to_string_lossy().starts_with(PREFIX);
        // Links are not ours.
        if is_one
            && entry.file_type().is_ok_and(|kind| kind.is_dir())
            && let Ok(_lock) = FolderLock::of(&entry.path())
        {
            // Those of other users stay.
            fs::remove_dir_all(entry.path()).ok();
        }
    }
}

/// Removes all folders of this process, and those that the processes `ended` left behind. For a program that ends: nothing is unpacked
/// after that, and any attempt waits for ever.
pub fn remove_unpacked(ended: &[u32]) {
    let stopped = WRITING.write().unwrap_or_else(PoisonError::into_inner);
    std::mem::forget(stopped);
    for folder in there().iter() {
        // A folder that cannot be removed only takes room.
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

    /// A folder in use is locked; that of a program that has ended is not, whatever its number.
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
