//! Standings of runs in a comparison: may win, missed a limit, did not do what was requested.
//!
//! The numbers of a run that broke a requirement are not those of the task: an axis that never moves does not vibrate. It takes no part.
//! A run that missed a limit did the task: its numbers are listed beside the others, and it does not win.
use super::{Compared, Noise};
use servobench_metrics::Standing as Met;
use servobench_results::{Outcome, RunResult};

/// Standing of a run in a comparison, the best first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Standing {
    /// May win.
    In,
    /// Missed a limit, or an expected fault did not come.
    Missed,
    /// Broke a requirement, was not executed, or ended in an error.
    Broken,
}

impl Standing {
    /// Standing of a single run.
    fn of(run: &RunResult) -> Self {
        match run.verdict {
            _ if run.not_met().next().is_some() => Self::Broken,
            Outcome::Passed | Outcome::Unjudged => Self::In,
            Outcome::Failed => Self::Missed,
            Outcome::Invalid | Outcome::Error => Self::Broken,
        }
    }
}

impl Compared<'_> {
    /// The worst standing over all its seeds.
    pub(super) fn standing(&self) -> Standing {
        self.seeds().map(Standing::of).max().unwrap_or(Standing::Broken)
    }

    /// The run and those with other seeds.
    pub(super) fn seeds(&self) -> impl Iterator<Item = &RunResult> {
        let others = match self.noise {
            Noise::None => &[],
            Noise::Seeds(others) => others,
        };
        std::iter::once(self.result).chain(others)
    }

    /// Reasons why the run does not win; empty if it may.
    pub(super) fn why_out(&self) -> Vec<String> {
        let own = reasons(self.result);
        if !own.is_empty() {
            return own;
        }
        let failed: Vec<Vec<String>> =
            self.seeds().skip(1).map(reasons).filter(|reasons| !reasons.is_empty()).collect();
        let of = self.seeds().count();
        let first = failed.first().and_then(|reasons| reasons.first());
        first.map(|reason| format!("with {} of {of} seeds: {reason}", failed.len())).into_iter().collect()
    }
}

/// Reasons why a run does not win, a sentence each.
fn reasons(run: &RunResult) -> Vec<String> {
    let mut all = run.reasons.clone();
    let lifted = run.not_met().filter(|(_, requirement)| requirement.standing == Met::Lifted);
    all.extend(lifted.flat_map(|(name, one)| one.reasons.iter().map(move |why| format!("{name}: {why} (lifted)"))));
    if all.is_empty() && Standing::of(run) != Standing::In {
        all.push(run.verdict.word().to_owned());
    }
    all
}
