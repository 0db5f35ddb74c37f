//! Places to write to that need not be regular files.
use crate::sys::{self, Kind};
use std::fs::File;
use std::io;
use std::path::Path;

/// Kind of place that a path leads to, for a writer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Destination {
    /// A regular file, or nothing yet: it is replaced as a whole.
    File,
    /// A folder.
    Folder,
    /// A device: bytes are written there at once, and several writers may share it.
    Device,
    /// A pipe, a socket, or a descriptor of this process by its name below `/dev` or `/proc`.
    Pipe,
    /// Standard output by such a name.
    StandardOutput,
    /// Standard error by such a name.
    StandardError,
}

impl Destination {
    /// Kind of the place at `path`, links followed.
    #[must_use]
    pub fn of(path: &Path) -> Self {
        match sys::descriptor(path) {
            Some(1) => return Self::StandardOutput,
            Some(2) => return Self::StandardError,
            Some(_) => return Self::Pipe,
            None => {}
        }
        match std::fs::metadata(path).map(|about| sys::kind(about.file_type())) {
            Ok(Kind::File) | Err(_) => Self::File,
            Ok(Kind::Folder) => Self::Folder,
            Ok(Kind::Fifo | Kind::Socket) => Self::Pipe,
            Ok(Kind::Device) => Self::Device,
        }
    }

    /// Opens the place at `path`, which is of this kind. A descriptor of ours is used itself, so that later output to it follows; a file
    /// opened by another process is appended to.
    ///
    /// # Errors
    /// Those of the operating system.
    pub fn open(self, path: &Path) -> io::Result<File> {
        match self {
            Self::StandardOutput => sys::standard_output(),
            Self::StandardError => sys::standard_error(),
            Self::File | Self::Folder | Self::Device | Self::Pipe => File::options().append(true).open(path),
        }
    }
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    use super::*;
    use std::os::unix::fs::symlink;

    #[test]
    fn devices_and_descriptors_are_told_from_files() {
        let there = tempfile::tempdir().unwrap();
        for (path, kind) in [
            ("/dev/null", Destination::Device),
            ("/dev/stdout", Destination::StandardOutput),
            ("/proc/self/fd/1", Destination::StandardOutput),
            ("/dev/stderr", Destination::StandardError),
            ("/dev/fd/2", Destination::StandardError),
            ("/dev/stdin", Destination::Pipe),
            ("/tmp", Destination::Folder),
            ("/proc/version", Destination::File),
            ("/no/such/folder/x", Destination::File),
        ] {
            assert_eq!(Destination::of(Path::new(path)), kind, "{path}");
        }
        let link = there.path().join("out.csv");
        symlink("/dev/stdout", &link).unwrap();
        assert_eq!(Destination::of(&link), Destination::StandardOutput);
    }
}
