//! Regular files only.
use crate::sys::{self, Kind};
use std::fs::{File, FileType, Metadata, OpenOptions};
use std::io::{self, ErrorKind, Read};
use std::path::Path;

/// Identity of a file, whatever its name: links lead to the same one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct FileId([u64; 2]);

impl FileId {
    /// Identity of the file or folder at `path`.
    ///
    /// # Errors
    /// Those of the operating system.
    pub fn of(path: &Path) -> io::Result<Self> {
        sys::identity(path).map(Self)
    }

    /// Identity of the regular file on standard input, if it is one.
    #[must_use]
    pub fn of_standard_input() -> Option<Self> {
        sys::identity_of_standard_input().map(Self)
    }
}

/// Opens a regular file of `most` bytes at most for reading.
///
/// It never waits, as opening a FIFO would. The opened file is checked, since the name may stand for another one by then; before that the
/// name is, so that no device is opened, which may have an effect.
///
/// # Errors
/// Those of the operating system; [`ErrorKind::InvalidInput`] with the actual kind instead of a file; [`ErrorKind::FileTooLarge`].
pub fn open(path: &Path, most: u64) -> io::Result<File> {
    regular(&std::fs::metadata(path)?, most)?;
    let mut options = OpenOptions::new();
    options.read(true);
    sys::without_waiting(&mut options);
    let file = options.open(path)?;
    regular(&file.metadata()?, most)?;
    Ok(file)
}

/// Metadata of a regular file of `most` bytes at most.
///
/// # Errors
/// As [`open`].
pub fn metadata(path: &Path, most: u64) -> io::Result<Metadata> {
    let about = std::fs::metadata(path)?;
    regular(&about, most)?;
    Ok(about)
}

/// Creates the file `path`, which must not exist yet: with rights for its owner only, and executable if it `is_program`.
///
/// # Errors
/// Those of the operating system.
pub fn create_private(path: &Path, is_program: bool) -> io::Result<File> {
    let mut options = OpenOptions::new();
    options.write(true).create_new(true);
    sys::make_private(&mut options, is_program);
    options.open(path)
}

/// Reads a regular file of `most` bytes at most.
///
/// # Errors
/// As [`open`].
pub fn read(path: &Path, most: u64) -> io::Result<Vec<u8>> {
    let file = open(path, most)?;
    let expected = usize::try_from(file.metadata()?.len()).unwrap_or(0);
    let mut bytes = Vec::with_capacity(expected);
    // A file may grow, and those of `/proc` report a length of zero.
    file.take(most.saturating_add(1)).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > most { Err(too_large(most)) } else { Ok(bytes) }
}

/// Reads a text file, a regular file of `most` bytes at most.
///
/// # Errors
/// As [`open`]; [`ErrorKind::InvalidData`] when it is not in UTF-8.
pub fn read_text(path: &Path, most: u64) -> io::Result<String> {
    let not_text = |_| io::Error::new(ErrorKind::InvalidData, "it is not UTF-8 text");
    String::from_utf8(read(path, most)?).map_err(not_text)
}

fn regular(about: &Metadata, most: u64) -> io::Result<()> {
    if !about.is_file() {
        return Err(io::Error::new(ErrorKind::InvalidInput, format!("it is {}, and no file", kind(about.file_type()))));
    }
    if about.len() > most { Err(too_large(most)) } else { Ok(()) }
}

fn too_large(most: u64) -> io::Error {
    io::Error::new(ErrorKind::FileTooLarge, format!("it has more than {}, the most that is read here", size(most)))
}

/// A number of bytes in words.
fn size(bytes: u64) -> String {
    match bytes {
        0..1_024 => format!("{bytes} bytes"),
        1_024..1_048_576 => format!("{} kB", bytes >> 10),
        1_048_576..1_073_741_824 => format!("{} MB", bytes >> 20),
        _ => format!("{} GB", bytes >> 30),
    }
}

fn kind(kind: FileType) -> &'static str {
    match sys::kind(kind) {
        Kind::File => "a file",
        Kind::Folder => "a folder",
        Kind::Fifo => "a FIFO",
        Kind::Socket => "a socket",
        Kind::Device => "a device",
    }
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;
    use std::os::unix::net::UnixListener;
    use std::process::Command;

    fn refusal(path: &Path) -> String {
        let refused = open(path, 10).unwrap_err();
        assert_eq!(refused.to_string(), read(path, 10).unwrap_err().to_string());
        refused.to_string()
    }

    /// A FIFO without a writer would keep its reader waiting: the test would not end.
    #[test]
    fn what_is_no_file_is_refused_at_once() {
        let room = tempfile::tempdir().unwrap();
        let place = |name: &str| room.path().join(name);
        assert!(Command::new("mkfifo").arg(place("fifo")).status().unwrap().success());
        let _socket = UnixListener::bind(place("socket")).unwrap();
        assert_eq!(refusal(&place("fifo")), "it is a FIFO, and no file");
        assert_eq!(refusal(&place("socket")), "it is a socket, and no file");
        assert_eq!(refusal(room.path()), "it is a folder, and no file");
        assert_eq!(refusal(Path::new("/dev/zero")), "it is a device, and no file");
        assert!(refusal(&place("nothing")).starts_with("No such file"));
    }

    #[test]
    fn a_file_is_read_up_to_its_bound() {
        let room = tempfile::tempdir().unwrap();
        let path = room.path().join("file");
        std::fs::write(&path, "0123456789").unwrap();
        assert_eq!(read_text(&path, 10).unwrap(), "0123456789");
        assert_eq!(read(&path, 9).unwrap_err().to_string(), "it has more than 9 bytes, the most that is read here");
        // A file that reports a length of zero, and has content.
        let endless = read(Path::new("/proc/self/maps"), 9).unwrap_err();
        assert_eq!(endless.kind(), ErrorKind::FileTooLarge);
        std::fs::write(&path, [0xff]).unwrap();
        assert_eq!(read_text(&path, 9).unwrap_err().to_string(), "it is not UTF-8 text");
    }

    #[test]
    fn links_lead_to_the_same_file() {
        let room = tempfile::tempdir().unwrap();
        std::os::unix::fs::symlink(".", room.path().join("again")).unwrap();
        assert_eq!(FileId::of(room.path()).unwrap(), FileId::of(&room.path().join("again")).unwrap());
        assert_ne!(FileId::of(room.path()).unwrap(), FileId::of(Path::new("/")).unwrap());
    }
}
