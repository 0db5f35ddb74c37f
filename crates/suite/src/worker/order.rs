//! Orders to a worker.
use crate::job::{Job, slow_to};
use serde::{Deserialize, Serialize};
use servobench_config::Choice as _;
use servobench_files::{bytes_of_path, path_of_bytes};
use servobench_scenario::{Document, LoadError, Override, Scenario};
use std::path::Path;
use std::time::Duration;

/// Task of a worker with a scenario.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Task {
    /// Report the reasons why it cannot be built.
    Check,
    /// Make a linear model of its MJCF file.
    Linearise,
    /// Run it and write its recording.
    Run {
        /// Limit of the wall-clock time.
        time_limit: Option<Duration>,
        /// True if all signals are recorded that the scenario requests.
        records_all: bool,
    },
}

/// A scenario, as the caller has it, and its task.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Order {
    /// Name of the scenario.
    pub name: String,
    /// File that it came from, byte by byte: models are looked up from there.
    pub path: Option<Vec<u8>>,
    /// The folder that contains the files of the scenario, byte by byte.
    pub root: Option<Vec<u8>>,
    /// Its text.
    pub text: String,
    /// Overrides of keys in the text.
    pub overrides: Vec<String>,
    /// The engine, by its name.
    pub engine: String,
    /// Durations that the moves are slowed to (s); empty: unchanged.
    pub durations: Vec<f64>,
    /// The task.
    pub task: Task,
}

impl Order {
    /// Order to do `task` with `job`.
    pub(crate) fn new(job: &Job, task: Task) -> Self {
        let Scenario { name, path, root, overrides, .. } = &job.scenario;
        Self {
            name: name.clone(),
            path: path.as_deref().map(bytes_of_path),
            root: root.as_deref().map(bytes_of_path),
            text: job.text.clone(),
            overrides: overrides.iter().map(ToString::to_string).collect(),
            engine: job.engine.name().to_owned(),
            durations: job.durations().to_vec(),
            task,
        }
    }

    /// The scenario as the caller has it.
    pub(super) fn scenario(&self) -> Result<Scenario, LoadError> {
        let (path, root) = (self.path.clone().map(path_of_bytes), self.root.clone().map(path_of_bytes));
        let file = path.as_ref().map_or_else(|| format!("{}.toml", self.name), |path| path.display().to_string());
        let folder = path.as_deref().and_then(Path::parent);
        // The caller has read them.
        let overrides: Vec<Override> = self.overrides.iter().filter_map(|one| one.parse().ok()).collect();
        let document = Document::parse(&file, &self.text, folder, root.as_deref())?;
        let mut scenario = document.scenario(&overrides)?.scenario;
        scenario.name.clone_from(&self.name);
        scenario.path = path;
        slow_to(&mut scenario, &self.durations);
        Ok(scenario)
    }
}
