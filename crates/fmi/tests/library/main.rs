//! Libraries written in C for these tests: the calls they receive and their order, and the effect of each answer that an FMU may give.
#![expect(clippy::float_cmp, reason = "the numbers of these FMUs are exact")]

mod clocks;
mod refused;
mod three;
mod two;

use servobench_fmi::{FmuError, Loaded, Port, Setup, Slave, Unpacked, Value};
use std::collections::HashMap;
use std::fs;
use std::io::Write;
use std::path::PathBuf;
use std::process::Command;
use std::sync::{Mutex, PoisonError};
use tempfile::TempDir;
use zip::ZipWriter;
use zip::write::SimpleFileOptions;

/// A folder with an FMU, and room for more files.
pub(crate) struct Room {
    folder: TempDir,
    pub(crate) fmu: PathBuf,
}

impl Room {
    /// An FMU with a library, and a description with some text replaced.
    pub(crate) fn new(name: &str, library: &[u8], description: &str) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let fmu = folder.path().join(format!("{name}.fmu"));
        let mut zip = ZipWriter::new(fs::File::create(&fmu).unwrap());
        let platform = if name == "two" { "linux64" } else { "x86_64-linux" };
        for (entry, content) in
            [("modelDescription.xml", description.as_bytes()), (&format!("binaries/{platform}/{name}.so"), library)]
        {
            zip.start_file(entry, SimpleFileOptions::default()).unwrap();
            zip.write_all(content).unwrap();
        }
        zip.finish().unwrap();
        Self { folder, fmu }
    }

    pub(crate) fn load(&self, setup: &Setup) -> Result<Loaded, FmuError> {
        Loaded::new(&Unpacked::new(&self.fmu)?, setup)
    }

    /// A file that the FMU may write to.
    pub(crate) fn notes(&self) -> PathBuf {
        self.folder.path().join("notes")
    }

    /// The text of an error, without the name of the folder.
    pub(crate) fn said(&self, error: &FmuError) -> String {
        error.to_string().replace(self.folder.path().to_str().unwrap(), "")
    }
}

/// The library of a C file beside this one, compiled once.
pub(crate) fn compiled(name: &'static str) -> Vec<u8> {
    static DONE: Mutex<Option<HashMap<&'static str, Vec<u8>>>> = Mutex::new(None);
    let mut done = DONE.lock().unwrap_or_else(PoisonError::into_inner);
    let done = done.get_or_insert_default();
    let compile = || {
        let folder = tempfile::tempdir().unwrap();
        let library = folder.path().join("library.so");
        let source = format!("{}/tests/library/{name}.c", env!("CARGO_MANIFEST_DIR"));
        let options =
            ["-std=gnu11", "-Wall", "-Wextra", "-Werror", "-Wno-stringop-truncation", "-O1", "-shared", "-fPIC", "-o"];
        let status = Command::new("cc").args(options).arg(&library).arg(source).status().unwrap();
        assert!(status.success());
        fs::read(library).unwrap()
    };
    done.entry(name).or_insert_with(compile).clone()
}

pub(crate) fn port(variable: &str, element: usize) -> Port {
    Port { variable: variable.into(), element }
}

pub(crate) fn setup(start: &[(&str, Value)], inputs: &[&str], outputs: &[&str]) -> Setup {
    let ports = |names: &[&str]| names.iter().map(|name| port(name, 0)).collect();
    Setup {
        instance_name: "it".into(),
        start_values: start.iter().map(|(name, value)| ((*name).to_owned(), value.clone())).collect(),
        inputs: ports(inputs),
        outputs: ports(outputs),
        ..Setup::default()
    }
}

pub(crate) fn text(text: &str) -> Value {
    Value::Text(text.into())
}

/// The messages since the last call.
pub(crate) fn messages(slave: &mut Loaded) -> Vec<String> {
    slave.take_log().into_iter().map(|line| line.message).collect()
}
