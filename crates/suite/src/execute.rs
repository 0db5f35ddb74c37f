//! Runs one job: here, or in a worker process when its engine can end the process.
use crate::engines::Engines;
use crate::error::RunError;
use crate::job::Job;
use crate::worker::{self, WorkerCommand};
use servobench_metrics::{Limit, Metrics, Name, Question, UnknownMetric, Verdict, measure};
use servobench_plant::Engine;
use servobench_scenario::Scenario;
use servobench_sim::Bench;
use servobench_trace::Recording;

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

/// A recording, and why it ended early if it did.
pub(crate) type Recorded = (Recording, Option<RunError>);

/// Runs `job` and judges it; `progress` hears the share that is done, from 0 to 1.
///
/// A panic of the engine or of the measures goes through: [`map_in_parallel`](crate::map_in_parallel) keeps it from
/// the other jobs.
pub fn execute(job: &Job, engines: &Engines, worker: &WorkerCommand, progress: &mut dyn FnMut(f64)) -> Report {
    let ready = limits(&job.scenario).map_err(RunError::from);
    let recorded = ready.and_then(|limits| Ok((limits, recorded(job, engines, worker, progress)?)));
    let (limits, (recording, failure)) = match recorded {
        Ok(recorded) => recorded,
        Err(error) => return Report { recording: None, metrics: Metrics::default(), outcome: Err(error) },
    };
    let asked = &job.scenario.measure;
    let mut metrics = measure(&recording, &Question { window: asked.window, from: asked.from, mode: asked.mode });
    let outcome = failure.map_or_else(|| Ok(metrics.judge(&limits)), Err);
    Report { recording: Some(recording), metrics, outcome }
}

fn recorded(
    job: &Job,
    engines: &Engines,
    worker: &WorkerCommand,
    progress: &mut dyn FnMut(f64),
) -> Result<Recorded, RunError> {
    let installed = engines.get(job.engine)?;
    if installed.isolated {
        Ok(worker::call(worker, job, progress)?)
    } else {
        run_here(&job.scenario, installed.engine, progress)
    }
}

/// Runs in this process.
pub(crate) fn run_here(
    scenario: &Scenario,
    engine: &dyn Engine,
    progress: &mut dyn FnMut(f64),
) -> Result<Recorded, RunError> {
    let outcome = Bench::new(scenario, engine)?.run(progress);
    Ok((outcome.recording, outcome.failure.map(RunError::from)))
}

fn limits(scenario: &Scenario) -> Result<Vec<Limit>, UnknownMetric> {
    scenario
        .limits
        .iter()
        .map(|limit| Ok(Limit { metric: limit.metric.parse::<Name>()?, min: limit.min, max: limit.max }))
        .collect()
}
