//! Location of the library that is packed into FMUs.
use crate::error::FmuError;
use std::fs;
use std::path::{Path, PathBuf};

/// File name of the library, as cargo builds it from this crate.
pub const LIBRARY: &str = "libservobench_fmu.so";

/// The library for [`export`](crate::export) at [`library_path`].
///
/// # Errors
/// As for [`library_path`], and [`FmuError::Read`] if it cannot be read.
pub fn library(program: &Path) -> Result<Vec<u8>, FmuError> {
    let path = library_path(program)?;
    fs::read(&path).map_err(|error| FmuError::Read { path, error })
}

/// Path of the library for [`export`](crate::export) that belongs to the program at `program`: in `../lib` of its folder, as
/// distributed; in `deps`, where cargo leaves it with the program; or beside it, if built by itself.
///
/// # Errors
/// [`FmuError::NoLibrary`] lists the places searched, and how to build it.
pub fn library_path(program: &Path) -> Result<PathBuf, FmuError> {
    let folder = program.parent().unwrap_or_else(|| Path::new(""));
    let places = ["../lib", "deps", ""].map(|within| folder.join(within).join(LIBRARY));
    let looked = listed(&places);
    places.into_iter().find(|place| place.is_file()).ok_or(FmuError::NoLibrary { looked })
}

fn listed(places: &[PathBuf]) -> String {
    places.iter().map(|place| format!("`{}`", place.display())).collect::<Vec<_>>().join(" nor at ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_distributed_library_comes_first_then_the_one_beside_the_program() {
        let room = tempfile::tempdir().unwrap();
        let [bin, lib] = ["bin", "lib"].map(|name| room.path().join(name));
        for folder in [&bin, &lib] {
            fs::create_dir(folder).unwrap();
        }
        let program = bin.join("servobench");
        let message = library(&program).unwrap_err().to_string();
        assert!(message.contains("bin/../lib/libservobench_fmu.so` nor at `"), "{message}");
        assert!(message.contains("bin/deps/libservobench_fmu.so` nor at `"), "{message}");
        assert!(message.contains("cargo build --release -p servobench-fmu"), "{message}");
        fs::write(bin.join(LIBRARY), "built").unwrap();
        assert_eq!(library(&program).unwrap(), b"built");
        fs::write(lib.join(LIBRARY), "distributed").unwrap();
        assert_eq!(library(&program).unwrap(), b"distributed");
    }
}
