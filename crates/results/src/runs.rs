//! The runs of a suite one after the other, with results in memory or in the journal.
use crate::journal::JournalError;
use crate::results::{Outcome, Results, Unfinished};
use crate::run::RunResult;
use servobench_base::AxisName;
use std::borrow::Cow;
use std::time::Duration;

/// The results of a suite, read one at a time: memory does not depend on their number.
pub trait Runs {
    /// The finished runs, in the order of the request.
    fn heads(&self) -> Box<dyn Iterator<Item = RunHead<'_>> + '_>;

    /// The result of the run with this [`RunHead::index`].
    ///
    /// # Errors
    /// [`JournalError`] if the record has changed or cannot be read.
    fn result(&self, index: usize) -> Result<Cow<'_, RunResult>, JournalError>;

    /// The unfinished runs, in that order.
    fn unfinished(&self) -> Box<dyn Iterator<Item = &Unfinished> + '_>;

    /// Keys that are overridden in every run, with their values: `setpoint.jerk=200 m/s3`.
    fn overrides(&self) -> Vec<&str>;
}

/// Summary of a run, known before its result is read.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RunHead<'a> {
    /// Index for reading its result.
    pub index: usize,
    /// Name of the scenario.
    pub name: &'a str,
    /// File of the scenario.
    pub file: Option<&'a str>,
    /// Engine.
    pub engine: &'a str,
    /// Name of the axis, if it has one.
    pub axis: Option<AxisName>,
    /// Outcome of the run.
    pub verdict: Outcome,
    /// Wall-clock duration, if known.
    pub took: Option<Duration>,
    /// True if it left a recording.
    pub has_recording: bool,
    /// See [`RunResult::lifts`].
    pub lifts: bool,
    /// See [`RunResult::warns`].
    pub warns: Option<bool>,
}

impl dyn Runs + '_ {
    /// Number of runs with this outcome.
    pub fn count_of(&self, outcome: Outcome) -> usize {
        self.heads().filter(|head| head.verdict == outcome).count()
    }

    /// All results, one after the other.
    pub fn each(&self) -> impl Iterator<Item = Result<Cow<'_, RunResult>, JournalError>> {
        self.heads().map(|head| self.result(head.index))
    }
}

impl Runs for Results {
    fn heads(&self) -> Box<dyn Iterator<Item = RunHead<'_>> + '_> {
        let heads = self.scenarios.iter().enumerate().map(|(index, run)| RunHead {
            index,
            name: &run.name,
            file: run.file.as_deref(),
            engine: &run.engine,
            axis: run.axis,
            verdict: run.verdict,
            took: None,
            has_recording: run.recording.is_some(),
            lifts: run.lifts(),
            warns: run.warns(),
        });
        Box::new(heads)
    }

    fn result(&self, index: usize) -> Result<Cow<'_, RunResult>, JournalError> {
        self.scenarios.get(index).map(Cow::Borrowed).ok_or(JournalError::NoSuchRun(index))
    }

    fn unfinished(&self) -> Box<dyn Iterator<Item = &Unfinished> + '_> {
        Box::new(self.unfinished.iter())
    }

    fn overrides(&self) -> Vec<&str> {
        let mut runs = self.scenarios.iter();
        let first = runs.next().map(|run| run.overrides.iter().map(String::as_str)).into_iter().flatten();
        let mut all: Vec<&str> = first.collect();
        runs.for_each(|run| all.retain(|one| run.overrides.iter().any(|other| other == one)));
        all
    }
}
