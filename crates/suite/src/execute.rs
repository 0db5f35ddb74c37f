//! Runs one job: here, or in a worker process when its engine can end the process.
use crate::engines::Engines;
use crate::error::RunError;
use crate::job::Job;
use crate::requirements::rules;
use crate::worker::{self, WorkerCommand};
use servobench_metrics::{EarlyEnd, Limit, Metrics, Verdict, judge_requirements, measure};
use servobench_plant::{Engine, MechanicsError};
use servobench_scenario::{Scenario, Step};
use servobench_sim::{Bench, Failure, FmuOpener, Reason, selected, thinned};
use servobench_trace::Recording;

/// A run that came to its end.
#[derive(Debug)]
pub struct Run {
    /// What is kept of the recording, at `record.rate`.
    pub recording: Recording,
    /// What was measured, judged.
    pub metrics: Metrics,
    /// The verdict.
    pub verdict: Verdict,
}

/// A run without a verdict.
#[derive(Debug)]
pub struct Broken {
    /// Why there is none.
    pub error: RunError,
    /// What was recorded and measured until then.
    pub until_then: Option<(Recording, Metrics)>,
}

/// A recording, and why it ended early if it did.
pub(crate) type Recorded = (Recording, Option<Interruption>);

/// Why a run ended early.
#[derive(Debug)]
pub(crate) enum Interruption {
    /// By itself: it is judged as far as it came, and has failed.
    Early(EarlyEnd),
    /// By something that keeps it from being judged.
    Broken(RunError),
}

impl From<Failure> for Interruption {
    fn from(failure: Failure) -> Self {
        match failure.reason {
            Reason::Mechanics(MechanicsError::Diverged { message, .. }) => {
                Self::Early(EarlyEnd::Diverged { time: failure.time, reason: message })
            }
            Reason::Program(reason) => Self::Early(EarlyEnd::GaveUp(reason)),
            Reason::Mechanics(_) | Reason::Coupling(_) => Self::Broken(failure.into()),
        }
    }
}

/// Runs `job` and judges it; `progress` is told the share that is done, from 0 to 1.
///
/// A panic of the engine or of the measures goes through: [`map_in_parallel`](crate::map_in_parallel) keeps it from
/// the other jobs.
///
/// # Errors
/// [`Broken`], with the recording as far as it came.
pub fn execute(
    job: &Job,
    engines: &Engines,
    worker: &WorkerCommand,
    progress: &mut dyn FnMut(f64),
) -> Result<Run, Box<Broken>> {
    let broken = |error, until_then| Box::new(Broken { error, until_then });
    let (recording, interruption) = recorded(job, engines, worker, progress).map_err(|error| broken(error, None))?;
    let (ended, failure) = match interruption {
        None => (None, None),
        Some(Interruption::Early(ended)) => (Some(ended), None),
        Some(Interruption::Broken(error)) => (None, Some(error)),
    };
    let requirements = judge_requirements(&recording, &rules(&job.scenario, ended));
    let record = &job.scenario.record;
    let recording = selected(recording, &record.channels);
    let mut metrics = measure(&recording, &job.scenario.measure);
    // What is measured does not depend on how much of it is kept.
    let recording = thinned(recording, record.rate);
    if let Some(failure) = failure {
        return Err(broken(failure, Some((recording, metrics))));
    }
    let of_moves: Vec<&[Limit]> = job.scenario.program.iter().filter_map(limits_of_move).collect();
    let limits = metrics.judge(&job.scenario.limits).and(metrics.judge_moves(&of_moves));
    Ok(Run { verdict: limits.and(requirements), recording, metrics })
}

fn recorded(
    job: &Job,
    engines: &Engines,
    worker: &WorkerCommand,
    progress: &mut dyn FnMut(f64),
) -> Result<Recorded, RunError> {
    let engine = engines.get(job.engine)?;
    if job.engine.capabilities().may_end_process {
        Ok(worker::call(worker, job, progress)?)
    } else {
        run_here(&job.scenario, (engine, engines.fmu_opener), progress)
    }
}

/// Runs in this process.
pub(crate) fn run_here(
    scenario: &Scenario,
    (engine, fmu_opener): (&dyn Engine, &dyn FmuOpener),
    progress: &mut dyn FnMut(f64),
) -> Result<Recorded, RunError> {
    let outcome = Bench::with_fmus(scenario, engine, fmu_opener)?.run(progress);
    Ok((outcome.recording, outcome.failure.map(Interruption::from)))
}

fn limits_of_move(step: &Step) -> Option<&[Limit]> {
    match step {
        Step::Move(step) => Some(&step.metric_limits),
        Step::Wait(_) => None,
    }
}
