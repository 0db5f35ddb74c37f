//! A run against the requirements of a scenario that need not be its own.
use crate::error::RunError;
use crate::execute::Interruption;
use crate::requirements::rules;
use servobench_metrics::{Verdict, judge_requirements, note_incidents};
use servobench_scenario::Scenario;
use servobench_sim::Failure;
use servobench_trace::Recording;

/// Judges `recording`, a run that ended early if `failure` says so, by the requirements of `scenario`, and notes its incidents as events.
///
/// That is the scenario by which an axis was designed and its tolerances follow. The machine that ran may be another one, as in the
/// drill of healthy and sabotaged twins. Limits are not judged, and the loop of an MJCF file is
/// not analysed.
///
/// # Errors
/// [`RunError`] of a failure that leaves nothing to judge.
pub fn judge(recording: &mut Recording, failure: Option<Failure>, scenario: &Scenario) -> Result<Verdict, RunError> {
    let ended = match failure.map(Interruption::from) {
        None => None,
        Some(Interruption::Early(ended)) => Some(ended),
        Some(Interruption::Broken(error)) => return Err(error),
    };
    let rules = rules(scenario, recording, ended, None);
    note_incidents(recording, &rules);
    Ok(judge_requirements(recording, &rules))
}
