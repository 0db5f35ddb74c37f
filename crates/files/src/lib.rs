//! Foreign files: opened without waiting, read up to a bound, quoted up to a few characters, named by their digest; the nearest name to a
//! mistyped one; and other functions of files for which `std` has no name: identity of a file, folders that one process uses at a time,
//! files without a name.
//!
//! Files that a scenario names, recordings, results and archives come from any sender. Under their names may be a FIFO without a writer, an
//! endless device, a file larger than the memory, or one that their reader must not see.
//!
//! The module `sys` is the only door to the operating system: crates above use files by `std` and this crate only.

mod destination;
mod folder_lock;
mod made_of;
mod nearest;
mod path_bytes;
mod quoted;
mod regular;
mod shortage;
mod sys;
mod xml_bounds;

pub use destination::Destination;
pub use folder_lock::FolderLock;
pub use made_of::{FileRole, MadeOf, digits, sha256};
pub use nearest::{nearest, suggestion};
pub use path_bytes::{bytes_of_path, path_of_bytes};
pub use quoted::{MOST_QUOTED, Quoted, listed, named, quoted, with_short_quotes};
pub use regular::{FileId, create_private, metadata, open, read, read_text};
pub use shortage::{is_shortage, is_too_many_open};
pub use sys::{MappedFile, UnnamedFile};
pub use xml_bounds::{XmlBounds, XmlExcess};
