//! Objections to a job, found in a worker process where its engine is isolated.
use crate::error::RunError;
use crate::job::Job;
use crate::worker::{WorkerError, Workers};
use servobench::Engines;
use servobench::check::{Exchange, Objection, model_key, objections, unmeasurable};
use servobench::panicked::caught;
use servobench_plant::EngineName;
use servobench_scenario::AxisMechanics;

/// All reasons why `job` cannot be built, as far as they can be found in one pass; empty when it can be. An isolated engine checks it in a
/// worker process.
///
/// # Errors
/// [`RunError`] when no answer is possible: the build lacks the engine, a library does not load, communication with the worker fails.
pub fn check(job: &Job, engines: &Engines, workers: &Workers) -> Result<Vec<Objection>, RunError> {
    let engine = engines.get(job.engine)?;
    if !job.runs_in_worker() {
        let found = caught(|| objections(&job.scenario, engine, engines.fmu_opener))??;
        return Ok(if found.is_empty() { unmeasurable(&job.scenario) } else { found });
    }
    match workers.ask(job) {
        // A crash of the library on a user's own file is attributed to the file.
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

/// Reasons why the FMUs beside the axis of `job` cannot be used. A checking worker reads their descriptions only; this process loads them,
/// with `exact`, and keeps the objections to FMUs. `exact` cannot simulate a user's own file.
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
    // The exchange does not depend on the engine: one that needs a separate process is not started.
    if job.runs_in_worker() {
        return Ok(Exchange::default());
    }
    Ok(servobench::check::exchange(&job.scenario, job.engine, engines)?)
}
