//! Identity of this program: the build ID written by the linker, a digest of what it linked.
use object::read::ReadCache;
use object::{File, Object as _};
use std::fmt::Write as _;
use std::sync::OnceLock;

/// Name and version, and where the program has one the identity of its build (ELF note `NT_GNU_BUILD_ID`), in hexadecimal digits:
/// two builds of one version may compute differently.
pub(crate) fn program() -> &'static str {
    static PROGRAM: OnceLock<String> = OnceLock::new();
    PROGRAM.get_or_init(|| {
        let version = concat!("servobench ", env!("CARGO_PKG_VERSION"));
        linked().map_or_else(|| version.to_owned(), |id| format!("{version} ({id})"))
    })
}

/// Build ID written by the linker; `None` without one.
fn linked() -> Option<String> {
    // Only the required parts of a file of some hundred megabytes are read.
    let source = ReadCache::new(std::fs::File::open(std::env::current_exe().ok()?).ok()?);
    let id = File::parse(&source).ok()?.build_id().ok()??.to_owned();
    Some(id.iter().fold(String::new(), |mut text, byte| {
        // Writing to a string cannot fail.
        write!(text, "{byte:02x}").ok();
        text
    }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_linker_has_written_an_identity() {
        let (name, id) = program().split_once(" (").unwrap();
        assert!(name.starts_with("servobench ") && id.len() == 41, "{}", program());
    }
}
