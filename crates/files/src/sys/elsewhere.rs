//! Files of a system that is not a Unix, as far as `std` knows them.
use super::Kind;
use sha2::{Digest as _, Sha256};
use std::fs::{File, FileType, OpenOptions, TryLockError};
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};
use std::string::FromUtf8Error;

/// Name of the file that represents the lock of its folder.
const LOCK: &str = ".servobench.lock";

/// Digest of the real path: symbolic links lead to the same one, hard links do not.
pub(crate) fn identity(path: &Path) -> io::Result<[u64; 2]> {
    let digest = Sha256::digest(path.canonicalize()?.as_os_str().as_encoded_bytes());
    let (first, second) = digest.split_at(digest.len() / 2);
    let word = |bytes: &[u8]| bytes.iter().take(8).fold(0, |word, byte| word << 8 | u64::from(*byte));
    Ok([word(first), word(second)])
}

/// Does nothing: there is no FIFO to wait for.
pub(crate) fn without_waiting(_: &mut OpenOptions) {}

/// A new file has the rights of its folder.
pub(crate) fn make_private(_: &mut OpenOptions, _: bool) {}

/// Kind of a file.
pub(crate) fn kind(of: FileType) -> Kind {
    match () {
        () if of.is_file() => Kind::File,
        () if of.is_dir() => Kind::Folder,
        () => Kind::Device,
    }
}

/// `true` when memory or space on a disk ran out.
pub(crate) fn is_shortage(error: &io::Error) -> bool {
    matches!(error.kind(), ErrorKind::OutOfMemory | ErrorKind::StorageFull)
}

/// Always `false`: no bound on the number of open files is known.
pub(crate) fn is_too_many_open(_: &io::Error) -> bool {
    false
}

/// Locks a file in the folder, which stays there: a folder itself cannot be locked.
pub(crate) fn lock_folder(folder: &Path) -> Result<File, TryLockError> {
    let file = File::options().create(true).truncate(false).write(true).open(folder.join(LOCK));
    let file = file.map_err(TryLockError::Error)?;
    file.try_lock()?;
    Ok(file)
}

/// The path with these bytes as UTF-8.
pub(crate) fn path_of_bytes(bytes: Vec<u8>) -> PathBuf {
    let lossy = |error: FromUtf8Error| String::from_utf8_lossy(error.as_bytes()).into_owned();
    String::from_utf8(bytes).unwrap_or_else(lossy).into()
}

/// An error: standard output has no name here, and is never requested.
pub(crate) fn standard_output() -> io::Result<File> {
    Err(ErrorKind::Unsupported.into())
}

/// As [`standard_output`].
pub(crate) fn standard_error() -> io::Result<File> {
    Err(ErrorKind::Unsupported.into())
}

/// `None`: standard input has no name, so that its file is unknown.
pub(crate) fn identity_of_standard_input() -> Option<[u64; 2]> {
    None
}

/// `None`: descriptors have no names.
pub(crate) fn descriptor(_: &Path) -> Option<u32> {
    None
}
