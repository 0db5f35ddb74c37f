//! The files of both FMUs: compiled and packed as a tool would.
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::Command;
use tempfile::TempDir;

/// The FMUs' files, which are there as long as this is.
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

    /// FMUs that take none: they are given means.
    pub(crate) fn that_hold() -> Self {
        Self::with("false")
    }

    fn with(interpolates: &str) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let [mass, spring] = [("mass", ""), ("spring", "-DSPRING")].map(|(name, option)| {
            let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/oscillator");
            let description = std::fs::read_to_string(source.join(name).with_extension("xml")).unwrap();
            let capability = |value: &str| format!("canInterpolateInputs=\"{value}\"");
            let description = description.replace(&capability("true"), &capability(interpolates));
            let library = folder.path().join(name).with_extension("so");
            let mut compiler = Command::new("cc");
            compiler.args(["-O2", "-shared", "-fPIC", "-o"]).arg(&library).arg(source.join("oscillator.c"));
            compiler.args([option, "-lm"].iter().filter(|option| !option.is_empty()));
            assert!(compiler.status().unwrap().success(), "the C compiler that the workspace is built with anyway");
            let path = folder.path().join(name).with_extension("fmu");
            let mut zip = zip::ZipWriter::new(std::fs::File::create(&path).unwrap());
            let binary = (format!("binaries/linux64/{name}.so"), std::fs::read(&library).unwrap());
            for (name, content) in [("modelDescription.xml".into(), description.into_bytes()), binary] {
                zip.start_file(name, zip::write::SimpleFileOptions::default()).unwrap();
                zip.write_all(&content).unwrap();
            }
            zip.finish().unwrap();
            path
        });
        Self { _folder: folder, mass, spring }
    }
}
