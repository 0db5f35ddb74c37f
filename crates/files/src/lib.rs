//! Files by somebody else: opened without waiting, read up to a bound, quoted up to a few characters, named by their digest; and the name
//! that one of them probably means.
//!
//! What a scenario names, a recording, results and an archive are written by whoever sent them. Under their names may be a FIFO that
//! nobody writes to, a device without end, a file larger than the memory, or one that is none of their reader's business.

mod made_of;
mod nearest;
mod quoted;
mod regular;
mod shortage;
mod xml_bounds;

pub use made_of::{FileRole, MadeOf, digits, sha256};
pub use nearest::{nearest, suggestion};
pub use quoted::{MOST_QUOTED, Quoted, listed, named, quoted, with_short_quotes};
pub use regular::{FileId, metadata, open, read, read_text};
pub use shortage::is_shortage;
pub use xml_bounds::{XmlBounds, XmlExcess};
