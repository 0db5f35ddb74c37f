//! The door to the operating system for files: functions for which `std` has no portable name.
//!
//! Other modules and crates use files by `std` and by this crate. A system that is not a Unix has [`elsewhere`]; its functions use `std`
//! alone.

#[cfg(not(unix))]
mod elsewhere;
#[cfg(unix)]
mod unix;
mod unnamed;

#[cfg(not(unix))]
pub(crate) use elsewhere::{
    descriptor, identity, identity_of_standard_input, is_shortage, is_too_many_open, kind, lock_folder, make_private,
    path_of_bytes, standard_error, standard_output, without_waiting,
};
#[cfg(unix)]
pub(crate) use unix::{
    descriptor, identity, identity_of_standard_input, is_shortage, is_too_many_open, kind, lock_folder, make_private,
    path_of_bytes, standard_error, standard_output, without_waiting,
};
pub use unnamed::{MappedFile, UnnamedFile};

/// Kind of a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(not(unix), expect(dead_code, reason = "a Unix alone has FIFOs and sockets among its files"))]
pub(crate) enum Kind {
    /// A regular file.
    File,
    /// A folder.
    Folder,
    /// A FIFO.
    Fifo,
    /// A socket.
    Socket,
    /// Anything else.
    Device,
}
