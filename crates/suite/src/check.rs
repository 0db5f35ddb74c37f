//! Objections to a job, which a worker process is asked for where its engine is isolated.
use crate::error::RunError;
use crate::job::Job;
use crate::worker::{WorkerError, Workers};
use servobench::Engines;
use servobench::check::{Exchange, Objection, model_key, objections, unmeasurable};
use servobench::panicked::caught;
use servobench_plant::EngineName;
use servobench_scenario::AxisMechanics;

/// Everything that keeps `job` from being built, as far as it can be told at once; nothing when it can be. An isolated
/// engine is asked in a worker process.
///
/// # Errors
/// [`RunError`] when nobody can tell: the build lacks the engine, a library does not load, the worker cannot be
/// spoken to.
pub fn check(job: &Job, engines: &Engines, workers: &Workers) -> Result<Vec<Objection>, RunError> {
    let engine = engines.get(job.engine)?;
    if !job.runs_in_worker() {
        let found = caught(|| objections(&job.scenario, engine, engines.fmu_opener))??;
        return Ok(if found.is_empty() { unmeasurable(&job.scenario) } else { found });
    }
    match workers.ask(job) {
        // What a library cannot bear in a user's own file is the file's fault, as far as anybody can tell.
        Err(error @ (WorkerError::Ended { .. } | WorkerError::Stalled { .. }))
            if matches!(job.scenario.axis.mechanics, AxisMechanics::Mjcf(_)) =>
        {
            Ok(vec![Objection::new(model_key(&job.scenario), error.to_string())])
        }
        answer => {
            let mut found = answer?;
            if found.is_empty() {
                found = beside(job, engines)?;
            }
            Ok(if found.is_empty() { unmeasurable(&job.scenario) } else { found })
        }
    }
}

/// What keeps the FMUs beside the axis of `job` from being used. A worker that checks reads their descriptions only; whether they are
/// loaded is for this process to say, and `exact` is the engine that is asked about nothing else. A file of the user's it cannot simulate.
fn beside(job: &Job, engines: &Engines) -> Result<Vec<Objection>, RunError> {
    let has_bodies = matches!(job.scenario.axis.mechanics, AxisMechanics::Bodies(_));
    let Ok(exact) = engines.get(EngineName::Exact) else { return Ok(Vec::new()) };
    if job.scenario.fmus.is_empty() || !has_bodies {
        return Ok(Vec::new());
    }
    let mut found = caught(|| objections(&job.scenario, exact, engines.fmu_opener))??;
    found.retain(|objection| objection.key.starts_with("fmu."));
    Ok(found)
}

/// The exchange of axis and FMUs of a job without objections; nothing where no FMU is beside the axis.
///
/// # Errors
/// [`RunError`] when it cannot be built after all.
pub fn exchange(job: &Job, engines: &Engines) -> Result<Exchange, RunError> {
    // What is exchanged when does not depend on the engine: one that needs a process of its own is not asked.
    if job.runs_in_worker() {
        return Ok(Exchange::default());
    }
    Ok(servobench::check::exchange(&job.scenario, job.engine, engines)?)
}
