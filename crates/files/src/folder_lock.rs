//! Folders that one process uses at a time.
use crate::sys;
use std::fs::{File, TryLockError};
use std::path::Path;

/// A folder that no other process can lock until this is dropped or the process ends, however that ends.
#[derive(Debug)]
pub struct FolderLock(#[expect(dead_code, reason = "the lock ends when the file is closed")] File);

impl FolderLock {
    /// Locks `folder`.
    ///
    /// # Errors
    /// [`TryLockError::WouldBlock`] where another process has locked it; otherwise those of the operating system: there is no such folder,
    /// or its file system has no locks.
    pub fn of(folder: &Path) -> Result<Self, TryLockError> {
        sys::lock_folder(folder).map(Self)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_folder_is_locked_once() {
        let room = tempfile::tempdir().unwrap();
        let lock = FolderLock::of(room.path()).unwrap();
        assert!(matches!(FolderLock::of(room.path()), Err(TryLockError::WouldBlock)));
        drop(lock);
        assert!(FolderLock::of(room.path()).is_ok());
        assert!(matches!(FolderLock::of(&room.path().join("none")), Err(TryLockError::Error(_))));
    }
}
