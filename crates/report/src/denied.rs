//! Properties of runs that may be denied although no run failed, and the runs that have them.
use crate::failures::lifted;
use crate::text::elided;
use servobench_config::Choice as _;
use servobench_results::{JournalError, Outcome, RunHead, RunResult, Runs, printable};
use servobench_trace::of_axis;

servobench_config::choices! {
    /// Properties that may be denied of runs that did not fail.
    pub enum Denied default Unjudged {
        /// runs without limits
        Unjudged = "unjudged",
        /// lifted requirements, calls with `optional`, expected faults without an end of their time
        Lifted = "lifted",
        /// warnings of check or of the verdict
        Warnings = "warnings",
    }
}

/// Most runs named of each kind; the others are counted.
const MOST: usize = 5;
/// Most characters of detail for each run.
const LONGEST: usize = 160;

impl Denied {
    /// True for a run with this property. A run without an end has another exit code anyway.
    const fn concerns(self, head: &RunHead<'_>) -> bool {
        head.verdict.is_whole()
            && match self {
                Self::Unjudged => matches!(head.verdict, Outcome::Unjudged),
                Self::Lifted => head.lifts,
                // Without a check, warnings cannot be ruled out.
                Self::Warnings => !matches!(head.warns, Some(false)),
            }
    }

    /// Words for the property, behind the number of runs.
    const fn words(self, is_one: bool) -> &'static str {
        match (self, is_one) {
            (Self::Unjudged, true) => "has no limits",
            (Self::Unjudged, false) => "have no limits",
            (Self::Lifted, true) => "lifts something that every run is held to",
            (Self::Lifted, false) => "lift something that every run is held to",
            (Self::Warnings, true) => "has warnings",
            (Self::Warnings, false) => "have warnings",
        }
    }

    /// Details of this run; empty where its name is enough.
    fn of_run(self, run: &RunResult) -> String {
        let all: Vec<String> = match self {
            Self::Unjudged => return String::new(),
            Self::Lifted => lifted(run).iter().map(|words| words.replacen("lifted: ", "", 1)).collect(),
            Self::Warnings => run.check_warnings.iter().flatten().chain(&run.warnings).cloned().collect(),
        };
        let Some(first) = all.first() else { return " (not checked: run it again)".into() };
        let more = if all.len() > 1 { format!(" and {} more", all.len() - 1) } else { String::new() };
        format!(" ({}{more})", elided(&printable(first), LONGEST))
    }
}

/// A line for each kind of `denied` that a run has: `unjudged: 2 of 7 runs have no limits: jerk on exact, snap on exact`. None where
/// nothing is denied.
///
/// # Errors
/// [`JournalError`] of a run that cannot be read.
pub fn denials(runs: &dyn Runs, denied: &[Denied]) -> Result<Vec<String>, JournalError> {
    let count = runs.heads().count();
    let mut lines = Vec::new();
    for (name, kind, _) in Denied::ALL.iter().filter(|(_, kind, _)| denied.contains(kind)) {
        let concerned: Vec<RunHead<'_>> = runs.heads().filter(|head| kind.concerns(head)).collect();
        if concerned.is_empty() {
            continue;
        }
        let mut named = Vec::new();
        for head in concerned.iter().take(MOST) {
            let what = kind.of_run(&*runs.result(head.index)?);
            named.push(format!("{}{} on {}{what}", printable(head.name), of_axis(head.axis), printable(head.engine)));
        }
        let more = concerned.len().saturating_sub(MOST);
        let more = if more > 0 { format!(" and {more} more") } else { String::new() };
        let (of, words) = (concerned.len(), kind.words(concerned.len() == 1));
        let plural = if count == 1 { "" } else { "s" };
        lines.push(format!("{name}: {of} of {count} run{plural} {words}: {}{more}", named.join(", ")));
    }
    Ok(lines)
}

#[cfg(test)]
mod tests {
    use super::*;
    use servobench_results::{Results, samples};

    fn all() -> Vec<Denied> {
        Denied::ALL.iter().map(|(_, kind, _)| *kind).collect()
    }

    #[test]
    fn what_is_denied_is_named_with_the_runs() {
        let mut results = samples::results();
        results.scenarios[1].check_warnings = Some(vec!["a.toml:3:1: the move has no length".into(), "more".into()]);
        insta::assert_snapshot!(denials(&results, &all()).unwrap().join("\n"), @r"
        unjudged: 2 of 7 runs have no limits: lambrechts-jerk on exact, lambrechts-snap on exact
        lifted: 2 of 7 runs lift something that every run is held to: kept on exact (bounded), pick on exact (stable: the velocity loop has a pole outside the unit circle and 1 more)
        warnings: 2 of 7 runs have warnings: feed-axis-reversal-at-low-speed-with-stick-slip on mujoco (a.toml:3:1: the move has no length and 1 more), pick on exact (two frames were lost)
        ");
        assert_eq!(denials(&results, &[]).unwrap(), [""; 0]);
    }

    /// Each kind alone, in a run with no other.
    #[test]
    fn each_kind_is_denied_by_itself() {
        let plain = || {
            let mut run = samples::kept();
            run.requirements.clear();
            (run.warnings, run.check_warnings) = (vec![], Some(vec![]));
            run
        };
        let of = |run: RunResult| denials(&Results::new(vec![run]), &all()).unwrap();
        assert_eq!(of(plain()), [""; 0]);
        let mut optional = plain();
        optional.optional_calls = vec!["go".into()];
        assert_eq!(of(optional).len(), 1);
        let mut at_any_time = samples::short().expected;
        for expected in &mut at_any_time {
            expected.to = None;
        }
        let open = RunResult { expected: at_any_time, ..plain() };
        assert!(of(open)[0].starts_with("lifted: 1 of 1 run lifts"), "an expected fault without an end of its time");
        let unchecked = RunResult { check_warnings: None, ..plain() };
        assert!(of(unchecked)[0].ends_with("(not checked: run it again)"));
        let unjudged = RunResult { verdict: Outcome::Unjudged, ..plain() };
        assert!(of(unjudged)[0].starts_with("unjudged: 1 of 1 run has no limits"));
        // Runs without an end have another exit code anyway.
        for verdict in [Outcome::Error, Outcome::Invalid] {
            assert_eq!(of(RunResult { verdict, check_warnings: None, ..plain() }), [""; 0]);
        }
    }
}
