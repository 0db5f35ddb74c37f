//! Runs one job: here, or in a worker process when its engine can end the process.
use crate::error::RunError;
use crate::job::Job;
use crate::time_limit::TimeLimit;
use crate::worker::Workers;
use servobench::run::{Judging, early_end};
use servobench::size::memory;
use servobench::{Engines, Error, Run};
use servobench_isolation::Stopwatch;
use servobench_metrics::{EarlyEnd, Metrics};
use servobench_plant::Engine;
use servobench_scenario::Scenario;
use servobench_sim::{Bench, Failure, FmuOpener, Reason};
use servobench_trace::Recording;
use std::ops::ControlFlow;
use std::time::Duration;

/// A run without a verdict.
#[derive(Debug)]
pub struct Broken {
    /// The reason.
    pub error: RunError,
    /// Recording and metrics up to then.
    pub until_then: Option<(Recording, Metrics)>,
}

/// A recording, and the reason of its early end, if any.
pub(crate) type Recorded = (Recording, Option<Interruption>);

/// Reasons why a run ended early.
#[derive(Debug)]
pub(crate) enum Interruption {
    /// By itself: it is judged up to its end, and has failed.
    Early(EarlyEnd),
    /// By an error that prevents a verdict.
    Broken(RunError),
}

impl From<Failure> for Interruption {
    fn from(failure: Failure) -> Self {
        early_end(failure).map_or_else(|failure| Self::Broken(failure.into()), Self::Early)
    }
}

/// Runs `job` and judges it; `progress` receives the completed share, from 0 to 1, repeatedly the same one while nothing changes.
///
/// A panic of the engine or of the measurement propagates: [`map_in_parallel`](crate::map_in_parallel) confines it to this job.
///
/// # Errors
/// [`Broken`], with the recording up to then.
pub fn execute(
    job: &Job,
    engines: &Engines,
    workers: &Workers,
    progress: &mut dyn FnMut(f64),
) -> Result<Run, Box<Broken>> {
    let broken = |error, until_then| Box::new(Broken { error, until_then });
    let (recording, interruption) = recorded(job, engines, workers, progress).map_err(|error| broken(error, None))?;
    let (ended, failure) = match interruption {
        None => (None, None),
        Some(Interruption::Early(ended)) => (Some(ended), None),
        Some(Interruption::Broken(error)) => (None, Some(error)),
    };
    let (model, wanted) = (workers.linearise(job), job.metrics());
    let judging = Judging { ended, model: model.as_ref(), wanted: wanted.as_ref(), ..Judging::default() };
    let run = Run::judged(&job.scenario, recording, judging);
    let run = run.map_err(|error| broken(Error::NotKept(error).into(), None))?;
    match failure {
        None => Ok(run),
        Some(failure) => Err(broken(failure, Some((run.recording, run.metrics)))),
    }
}

fn recorded(
    job: &Job,
    engines: &Engines,
    workers: &Workers,
    progress: &mut dyn FnMut(f64),
) -> Result<Recorded, RunError> {
    let engine = engines.get(job.engine)?;
    let (need, limit) = (memory(&job.scenario), workers.limits().memory);
    if need > limit {
        return Err(RunError::Memory { need, limit });
    }
    if job.runs_in_worker() {
        return workers.run(job, progress);
    }
    let limit = TimeLimit::of(job, workers.limits().time);
    let built_by = Loop { engine, fmu_opener: engines.fmu_opener, records_all: job.records_all() };
    let (recording, failure) = run_here(&job.scenario, built_by, limit.map(|limit| limit.time), progress)?;
    let interruption = failure.map(|failure| match (limit, &failure.reason) {
        (Some(limit), Reason::Stopped) => Interruption::Broken(limit.exceeded(failure.time)),
        _ => failure.into(),
    });
    Ok((recording, interruption))
}

/// Builder of a closed loop.
#[derive(Clone, Copy)]
pub(crate) struct Loop<'a> {
    pub(crate) engine: &'a dyn Engine,
    pub(crate) fmu_opener: &'a dyn FmuOpener,
    /// True if all signals are recorded that the scenario requests.
    pub(crate) records_all: bool,
}

/// Runs in this process, for `time_limit` at most.
pub(crate) fn run_here(
    scenario: &Scenario,
    Loop { engine, fmu_opener, records_all }: Loop<'_>,
    time_limit: Option<Duration>,
    progress: &mut dyn FnMut(f64),
) -> Result<(Recording, Option<Failure>), RunError> {
    let watch = Stopwatch::start();
    let bench = Bench::with_fmus(scenario, engine, fmu_opener)?;
    let bench = if records_all { bench } else { bench.only_to_measure() };
    let outcome = bench.run_while(&mut |share| {
        progress(share);
        let is_late = time_limit.is_some_and(|limit| watch.elapsed() > limit);
        if is_late { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    Ok((outcome.recording, outcome.failure))
}
