//! Judgement of a recording by every requirement.
use super::task::Task;
use super::{
    Expected, Requirement, RequirementResult, Rules, Standing, arrival, bounds, effort, execution, fault, following,
    harm, rings, stable, standing, stopping, velocity,
};
use crate::coupling;
use crate::verdict::Verdict;
use servobench_trace::Recording;

/// Maximum number of reasons that are given for one requirement; one more gives the number of the others.
const MOST_REASONS: usize = 5;

/// Judges `recording`, in which every tick is needed and the incidents are [noted](crate::note_incidents), by every requirement.
#[must_use]
pub fn judge_requirements(recording: &Recording, rules: &Rules<'_>) -> Verdict {
    let faults = fault::occurrences(recording);
    let expected: Vec<Expected> = rules
        .expected
        .iter()
        .map(|expectation| Expected {
            expectation: expectation.clone(),
            met: harm::met(expectation, recording).or_else(|| fault::met(expectation, &faults, recording)),
        })
        .collect();
    let task = Task::of(recording, rules, &expected);
    let standing = |requirement| {
        let (broken, may_be_lifted) = match requirement {
            Requirement::Follows => (following::broken(&task), true),
            Requirement::Arrives => (arrival::broken(&task), true),
            Requirement::Stands => (standing::broken(&task), true),
            Requirement::Velocity => (velocity::broken(&task), true),
            Requirement::Effort => (effort::broken(&task), true),
            Requirement::Stopped => (stopping::broken(&task), true),
            Requirement::Executed => (execution::broken(&task), true),
            Requirement::NoFault => (fault::broken(recording, rules, &faults), true),
            Requirement::Stable => (stable::broken(recording, rules), true),
            Requirement::Rings => (rings::broken(recording, rules), true),
            Requirement::NoHarm => (harm::broken(recording, rules), true),
            // A run that diverged has no end that could be judged.
            Requirement::Bounded => (Some(bounds::broken(recording, rules)), !rules.has_diverged()),
        };
        let is_lifted = may_be_lifted && rules.lifted.contains(&requirement);
        let is_asked = broken.is_some();
        let reasons = listed(broken.unwrap_or_default());
        let standing = match (is_asked, reasons.is_empty()) {
            (false, _) => Standing::NotAsked,
            (true, _) if is_lifted => Standing::Lifted,
            (true, true) => Standing::Met,
            (true, false) => Standing::Broken,
        };
        RequirementResult { standing, reasons }
    };
    let requirements: Vec<(Requirement, RequirementResult)> =
        Requirement::ALL.iter().map(|requirement| (*requirement, standing(*requirement))).collect();
    drop(task);
    let is_met =
        requirements.iter().any(|(name, result)| *name == Requirement::Stable && result.standing == Standing::Met);
    let not_analysed = rules.not_analysed.iter().filter(|_| is_met);
    let not_analysed = not_analysed.map(|why| format!("{}: {why}", Requirement::Stable));
    let warnings = not_analysed.chain(coupling::warning(recording)).collect();
    Verdict { requirements, expected, warnings, ..Verdict::default() }
}

/// The first reasons, and the number of the others.
fn listed(mut reasons: Vec<String>) -> Vec<String> {
    if reasons.len() > MOST_REASONS {
        let others = reasons.len() - MOST_REASONS;
        reasons.truncate(MOST_REASONS);
        reasons.push(format!("and {others} more"));
    }
    reasons
}
