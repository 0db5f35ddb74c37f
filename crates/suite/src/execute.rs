//! Runs one job: here, or in a worker process when its engine can end the process.
use crate::engines::{EngineMissing, Engines};
use crate::job::Job;
use crate::worker::{self, WorkerCommand};
use servobench_metrics::{Limit, Metrics, Name, Question, UnknownMetric, Verdict, measure};
use servobench_plant::Engine;
use servobench_scenario::Scenario;
use servobench_sim::{Bench, BuildError};
use servobench_trace::Recording;
use std::panic::{AssertUnwindSafe, catch_unwind};
use thiserror::Error;

/// What a run gave.
#[derive(Debug)]
pub struct Report {
    /// Everything recorded, as far as it came.
    pub recording: Option<Recording>,
    /// What was measured, judged.
    pub metrics: Metrics,
    /// The verdict, or why there is none.
    pub outcome: Result<Verdict, RunError>,
}

/// Why a run has no verdict.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum RunError {
    /// The scenario asks for what cannot be built: the input is wrong.
    #[error("{0}")]
    Input(String),
    /// The build lacks the engine.
    #[error(transparent)]
    EngineMissing(#[from] EngineMissing),
    /// The run ended early.
    #[error("{0}")]
    Failed(String),
}

impl From<BuildError> for RunError {
    fn from(error: BuildError) -> Self {
        match error {
            // A library that does not load is not the scenario's fault.
            BuildError::Mechanics(native @ servobench_plant::MechanicsError::Native { .. }) => {
                Self::Failed(native.to_string())
            }
            other => Self::Input(other.to_string()),
        }
    }
}

impl From<UnknownMetric> for RunError {
    fn from(error: UnknownMetric) -> Self {
        Self::Input(error.to_string())
    }
}

/// Runs `job` and judges it; `progress` hears the share that is done, from 0 to 1.
pub fn execute(job: &Job, engines: &Engines, worker: &WorkerCommand, progress: &mut dyn FnMut(f64)) -> Report {
    let (recording, failure) = match recorded(job, engines, worker, progress) {
        Ok((recording, failure)) => (recording, failure),
        Err(error) => return Report { recording: None, metrics: Metrics::default(), outcome: Err(error) },
    };
    let scenario = &job.scenario;
    let question =
        Question { window: scenario.measure.window, from: scenario.measure.from, mode: scenario.measure.mode };
    let mut metrics = measure(&recording, &question);
    let outcome = match (failure, limits(scenario)) {
        (Some(failure), _) => Err(RunError::Failed(failure)),
        (None, Err(unknown)) => Err(unknown.into()),
        (None, Ok(limits)) => Ok(metrics.judge(&limits)),
    };
    Report { recording: Some(recording), metrics, outcome }
}

/// The recording of `job`, and why it ended early if it did.
fn recorded(
    job: &Job,
    engines: &Engines,
    worker: &WorkerCommand,
    progress: &mut dyn FnMut(f64),
) -> Result<(Recording, Option<String>), RunError> {
    let installed = engines.get(job.engine)?;
    if installed.isolated {
        worker::call(worker, job, progress)
    } else {
        run_here(&job.scenario, installed.engine, progress)
    }
}

/// Runs in this process; a panic costs this run only.
pub(crate) fn run_here(
    scenario: &Scenario,
    engine: &dyn Engine,
    progress: &mut dyn FnMut(f64),
) -> Result<(Recording, Option<String>), RunError> {
    let run = AssertUnwindSafe(|| Bench::new(scenario, engine).map(|bench| bench.run(progress)));
    match catch_unwind(run) {
        Ok(Ok(outcome)) => Ok((outcome.recording, outcome.failure.map(|failure| failure.to_string()))),
        Ok(Err(error)) => Err(error.into()),
        Err(panic) => {
            let words = panic.downcast_ref::<&str>().map(|words| (*words).to_owned());
            let words = words.or_else(|| panic.downcast_ref::<String>().cloned());
            let words = words.unwrap_or_else(|| "no message".into());
            Err(RunError::Failed(format!("the run panicked (a defect of servobench): {words}")))
        }
    }
}

fn limits(scenario: &Scenario) -> Result<Vec<Limit>, UnknownMetric> {
    scenario
        .limits
        .iter()
        .map(|limit| Ok(Limit { metric: limit.metric.parse::<Name>()?, min: limit.min, max: limit.max }))
        .collect()
}
