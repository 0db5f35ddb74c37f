//! The files of both FMUs.
use crate::packed;
use std::path::PathBuf;
use tempfile::TempDir;

/// The FMUs' files, which exist as long as this value.
pub(crate) struct Files {
    _folder: TempDir,
    pub(crate) mass: PathBuf,
    pub(crate) spring: PathBuf,
}

impl Files {
    /// FMUs that take derivatives of their inputs.
    pub(crate) fn new() -> Self {
        Self::with("true")
    }

    /// FMUs that take no derivatives: they get means.
    pub(crate) fn that_hold() -> Self {
        Self::with("false")
    }

    fn with(interpolates: &str) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let pack = |name: &str, description: &str, options: &[&str]| {
            let capability = |value: &str| format!("canInterpolateInputs=\"{value}\"");
            let description = description.replace(&capability("true"), &capability(interpolates));
            packed(folder.path(), name, &description, "oscillator/oscillator.c", options)
        };
        let mass = pack("mass", include_str!("mass.xml"), &[]);
        let spring = pack("spring", include_str!("spring.xml"), &["-DSPRING"]);
        Self { _folder: folder, mass, spring }
    }
}
