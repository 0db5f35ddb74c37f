//! Files of a Unix.
use super::Kind;
use rustix::fs::OFlags;
use rustix::io::Errno;
use std::ffi::OsString;
use std::fs::{File, FileType, Metadata, OpenOptions, TryLockError};
use std::io;
use std::os::fd::AsFd as _;
use std::os::unix::ffi::OsStringExt as _;
use std::os::unix::fs::{FileTypeExt as _, MetadataExt as _, OpenOptionsExt as _};
use std::path::{Path, PathBuf};

/// Largest number of links that are followed, as in Linux.
const MOST_LINKS: usize = 40;

/// Device and inode: links lead to the same.
pub(crate) fn identity(path: &Path) -> io::Result<[u64; 2]> {
    let about = std::fs::metadata(path)?;
    Ok([about.dev(), about.ino()])
}

/// Makes opening a FIFO not wait for a writer.
pub(crate) fn without_waiting(options: &mut OpenOptions) {
    options.custom_flags((OFlags::NONBLOCK | OFlags::CLOEXEC).bits().cast_signed());
}

/// Gives a new file rights for its owner only, to read, to write, and to run if it `is_program`.
pub(crate) fn make_private(options: &mut OpenOptions, is_program: bool) {
    options.mode(if is_program { 0o700 } else { 0o600 });
}

/// Kind of a file.
pub(crate) fn kind(of: FileType) -> Kind {
    match () {
        () if of.is_file() => Kind::File,
        () if of.is_dir() => Kind::Folder,
        () if of.is_fifo() => Kind::Fifo,
        () if of.is_socket() => Kind::Socket,
        () => Kind::Device,
    }
}

/// `true` when descriptors, processes, memory or space on a disk ran out.
pub(crate) fn is_shortage(error: &io::Error) -> bool {
    const SHORTAGES: [Errno; 7] =
        [Errno::MFILE, Errno::NFILE, Errno::AGAIN, Errno::NOMEM, Errno::NOSPC, Errno::DQUOT, Errno::FBIG];
    is_any(error, &SHORTAGES)
}

/// `true` when the process or the machine has too many files open.
pub(crate) fn is_too_many_open(error: &io::Error) -> bool {
    is_any(error, &[Errno::MFILE, Errno::NFILE])
}

fn is_any(error: &io::Error, numbers: &[Errno]) -> bool {
    error.raw_os_error().is_some_and(|code| numbers.iter().any(|errno| errno.raw_os_error() == code))
}

/// Locks the folder itself (flock(2)): the lock ends with its last descriptor.
pub(crate) fn lock_folder(folder: &Path) -> Result<File, TryLockError> {
    let file = File::open(folder).map_err(TryLockError::Error)?;
    file.try_lock()?;
    Ok(file)
}

/// The path with these bytes.
pub(crate) fn path_of_bytes(bytes: Vec<u8>) -> PathBuf {
    OsString::from_vec(bytes).into()
}

/// Standard output, duplicated.
pub(crate) fn standard_output() -> io::Result<File> {
    Ok(io::stdout().as_fd().try_clone_to_owned()?.into())
}

/// Standard error, duplicated.
pub(crate) fn standard_error() -> io::Result<File> {
    Ok(io::stderr().as_fd().try_clone_to_owned()?.into())
}

/// Identity of the regular file on standard input, if it is one.
pub(crate) fn identity_of_standard_input() -> Option<[u64; 2]> {
    let about = std::fs::metadata("/dev/stdin").ok().filter(Metadata::is_file)?;
    Some([about.dev(), about.ino()])
}

/// The descriptor of this process that `path` names: `/dev/stdout` and `/dev/fd/1` lead to `/proc/self/fd/1`, which is a link to the open
/// file. These links must not be replaced.
pub(crate) fn descriptor(path: &Path) -> Option<u32> {
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

/// `true` when the real path `folder` is `/proc/ID/fd` of this process.
fn is_own_descriptors(folder: &Path) -> bool {
    let names = ["/proc/self/fd", "/proc/thread-self/fd"];
    names.iter().any(|name| Path::new(name).canonicalize().is_ok_and(|real| real == folder))
}
