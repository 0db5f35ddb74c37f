//! Opening a library and finding its functions.
#![expect(unsafe_code, reason = "a library is foreign code, and its functions have the types that the standard says")]
use super::calls::during;
use crate::archive::Unpacked;
use crate::error::{FmuError, LibraryProblem};
use libloading::Library;
use std::path::{Path, PathBuf};

/// An open library. The functions found in it may be called as long as it lives.
#[derive(Debug)]
pub(super) struct Open {
    library: Library,
    /// The FMU, for messages.
    fmu: PathBuf,
}

impl Open {
    pub(super) fn new(unpacked: &Unpacked) -> Result<Self, FmuError> {
        let path = super::path(unpacked)?;
        let fmu = unpacked.path().to_owned();
        // SAFETY: the library's initialisers are foreign code, for which nothing vouches; that is why FMUs run in a separate process,
        // except where the scenario trusts them.
        let library = during("dlopen", || unsafe { library(&path) });
        let library = library.map_err(|error| {
            let why = chain(&error);
            // Libraries of Python FMUs take its functions from the program that loads them.
            let hint = if why.contains("undefined symbol: Py") || why.contains("undefined symbol: _Py") {
                "; it needs Python: start with LD_PRELOAD=<path of libpython3.so> of the Python that has its packages"
            } else {
                ""
            };
            FmuError::Library { path: fmu.clone(), problem: LibraryProblem::Open { why, hint } }
        })?;
        Ok(Self { library, fmu })
    }

    /// The function of this name.
    ///
    /// # Safety
    /// `F` is the type of a pointer to that function.
    pub(super) unsafe fn function<F: Copy>(&self, symbol: &'static str) -> Result<F, FmuError> {
        // SAFETY: the caller's.
        unsafe { self.optional(symbol) }
            .ok_or_else(|| FmuError::Library { path: self.fmu.clone(), problem: LibraryProblem::NoFunction { symbol } })
    }

    /// The function of this name, if the library has it.
    ///
    /// # Safety
    /// `F` is the type of a pointer to that function.
    pub(super) unsafe fn optional<F: Copy>(&self, symbol: &str) -> Option<F> {
        // SAFETY: the caller's; a symbol whose address is NULL, which is not a function, is `None`.
        unsafe { self.library.get::<Option<F>>(symbol.as_bytes()) }.ok().and_then(|found| *found)
    }
}

/// Opens a library and resolves all its symbols, without exporting its own.
///
/// # Safety
/// Its initialisers run.
#[cfg(unix)]
unsafe fn library(path: &Path) -> Result<Library, libloading::Error> {
    use libloading::os::unix::{Library, RTLD_LOCAL, RTLD_NOW};
    // SAFETY: the caller's.
    unsafe { Library::open(Some(path), RTLD_NOW | RTLD_LOCAL) }.map(Into::into)
}

/// Opens a library.
///
/// # Safety
/// Its initialisers run.
#[cfg(not(unix))]
unsafe fn library(path: &Path) -> Result<Library, libloading::Error> {
    // SAFETY: the caller's.
    unsafe { Library::new(path) }
}

/// An error and its causes, in one line.
fn chain(error: &dyn std::error::Error) -> String {
    let causes = std::iter::successors(Some(error), |error| error.source());
    causes.map(ToString::to_string).collect::<Vec<_>>().join(": ")
}
