//! Files by somebody else: opened without waiting, read up to a bound, quoted up to a few characters, named by their digest; the name that
//! one of them probably means; and what else a program needs of files that `std` has no name for: which file it is, folders that one
//! process uses at a time, files without a name.
//!
//! What a scenario names, a recording, results and an archive are written by whoever sent them. Under their names may be a FIFO that
//! nobody writes to, a device without end, a file larger than the memory, or one that is none of their reader's business.
//!
//! The module `sys` is the door to the operating system: no crate above calls it for files by other names than those of `std` and of
//! this crate.

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
