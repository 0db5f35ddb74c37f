//! Environment of a host before it instantiates an FMU: the folder of its resources, its token, a log; and the expected results.
use crate::interface::Role;
use crate::machine::Model;
use crate::part::Part;
use crate::resources::Resources;
use servobench_plant::Exact;
use servobench_scenario::{Loaded, embedded_demo, parse};
use servobench_sim::Bench;
use servobench_trace::Recording;
use std::ffi::{CString, c_void};
use std::fs;
use std::path::Path;
use std::sync::{Mutex, PoisonError};
use tempfile::TempDir;

/// An unpacked FMU.
pub(super) struct Room {
    folder: TempDir,
    pub(super) token: CString,
    pub(super) model: Model,
    pub(super) log: Messages,
}

/// Logged messages: status, category and text.
#[derive(Default)]
pub(super) struct Messages(Mutex<Vec<(i32, String, String)>>);

impl Messages {
    /// Pointer by which a callback finds the messages.
    pub(super) fn environment(&self) -> *mut c_void {
        std::ptr::from_ref(self).cast_mut().cast()
    }

    pub(super) fn add(&self, status: i32, category: String, text: String) {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).push((status, category, text));
    }

    /// All messages since the last call.
    pub(super) fn take(&self) -> Vec<(i32, String, String)> {
        std::mem::take(&mut *self.0.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

/// The first demo that a plain `servobench run` runs.
pub(super) fn demo() -> Loaded {
    let (name, text) = embedded_demo()[0];
    parse(name, text, None).unwrap_or_else(|error| panic!("{error}"))
}

/// Recording of the demo by `servobench run` over `ticks`.
pub(super) fn recording(ticks: u32) -> Recording {
    let mut scenario = demo().scenario;
    scenario.duration = Some(f64::from(ticks) / f64::from(scenario.base_rate.hertz()));
    Bench::new(&scenario, &Exact).unwrap().run(&mut |_| ()).recording
}

impl Room {
    pub(super) fn new(part: Part) -> Self {
        let loaded = demo();
        let resources = Resources::of(part, &loaded).unwrap();
        let folder = tempfile::tempdir().unwrap();
        for (path, text) in &resources.files {
            let path = folder.path().join(path);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, text).unwrap();
        }
        let model = Model::new(part, &loaded.scenario).unwrap();
        Self { folder, token: CString::new(resources.token()).unwrap(), model, log: Messages::default() }
    }

    pub(super) fn folder(&self) -> &Path {
        self.folder.path()
    }

    pub(super) fn path(&self) -> CString {
        CString::new(self.folder().as_os_str().as_encoded_bytes()).unwrap()
    }

    /// The value reference of an input or a parameter.
    pub(super) fn input(&self, name: &str) -> u32 {
        self.reference(name, |role| matches!(role, Role::Input(_) | Role::Setting(_)))
    }

    /// The value reference of an output.
    pub(super) fn output(&self, name: &str) -> u32 {
        self.reference(name, |role| matches!(role, Role::Output(_)))
    }

    fn reference(&self, name: &str, is: impl Fn(&Role) -> bool) -> u32 {
        let mut all = (0..).zip(&self.model.variables);
        let found = all.find(|(_, variable)| variable.name == name && is(&variable.role));
        found.map_or_else(|| panic!("there is a variable `{name}`"), |(at, _)| at)
    }
}
