//! The library of an FMU: its path and its functions.
//!
//! All `unsafe` code is in the modules below: they know the functions' types and lifetimes, and offer an interface that Rust checks.

pub(crate) mod callbacks;
pub(crate) mod calls;
pub(crate) mod open;
pub(crate) mod status;
pub(crate) mod three;
pub(crate) mod two;

use crate::archive::Unpacked;
use crate::description::Version;
use crate::error::{FmuError, LibraryProblem};
use status::Outcome;
use std::env::consts::{ARCH, DLL_SUFFIX, OS};
use std::path::PathBuf;

/// Access to all values of one type in a single call. An array has as many values as elements; otherwise there are as many values as
/// references.
pub(crate) trait Access<T> {
    fn get(&self, references: &[u32], values: &mut [T]) -> Called;
    fn set(&self, references: &[u32], values: &[T]) -> Called;
}

/// A function of the standard and its outcome.
pub(crate) type Called = (&'static str, Outcome);

/// Folders of libraries for this platform, as FMI 2.0 (§2.3) and FMI 3.0 (§2.5.1.4) name them. Tools mix them up.
fn folders() -> [String; 2] {
    let (of_two, system) = match OS {
        "windows" => ("win64", OS),
        "macos" => ("darwin64", "darwin"),
        _ => ("linux64", OS),
    };
    [of_two.into(), format!("{ARCH}-{system}")]
}

/// Path of the library for this platform.
pub(crate) fn path(unpacked: &Unpacked) -> Result<PathBuf, FmuError> {
    let description = unpacked.description();
    let name = format!("{}{DLL_SUFFIX}", description.co_simulation.model_identifier);
    let binaries = unpacked.folder().join("binaries");
    let mut folders = folders();
    if description.version == Version::Three {
        folders.reverse();
    }
    let found = folders.iter().map(|folder| binaries.join(folder).join(&name)).find(|path| path.is_file());
    found.ok_or_else(|| {
        let platforms = std::fs::read_dir(&binaries).into_iter().flatten().flatten();
        let mut platforms: Vec<_> = platforms.map(|entry| entry.file_name().to_string_lossy().into_owned()).collect();
        platforms.sort();
        let has_sources = unpacked.folder().join("sources").is_dir();
        let problem =
            LibraryProblem::NoBinary { wanted: format!("binaries/{}/{name}", folders[0]), platforms, has_sources };
        FmuError::Library { path: unpacked.path().to_owned(), problem }
    })
}
