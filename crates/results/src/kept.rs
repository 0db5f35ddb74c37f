//! The results of a suite as its runs end.
use crate::digest::Digest;
use crate::journal::{Finished, Journal, JournalError, Place, Suite};
use crate::planned::Planned;
use crate::results::{Outcome, Unfinished};
use crate::run::RunResult;
use crate::runs::{RunHead, Runs};
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::time::Duration;

/// The results of a suite as its runs end: in the journal, or in memory if they could not be written there.
#[derive(Debug)]
pub struct Kept {
    journal: Option<Journal>,
    planned: Planned,
    /// Finished runs by their place in the suite.
    ended: BTreeMap<usize, Ended>,
    /// Overrides common to all runs so far; `None` before the first.
    overrides: Option<Vec<String>>,
}

/// Summary of a finished run.
#[derive(Debug)]
struct Ended {
    verdict: Outcome,
    took: Duration,
    has_recording: bool,
    lifts: bool,
    warns: Option<bool>,
    inputs: Digest,
    result: Where,
}

#[derive(Debug)]
enum Where {
    Journal(Place),
    Memory(Box<RunResult>),
}

impl Ended {
    /// Summary with the result at `place` of the journal, or in memory without one.
    fn new(finished: Finished, place: Option<Place>) -> Self {
        let Finished { seconds, result, .. } = finished;
        Self {
            verdict: result.verdict,
            took: Duration::try_from_secs_f64(seconds).unwrap_or_default(),
            has_recording: result.recording.is_some(),
            lifts: result.lifts(),
            warns: result.warns(),
            inputs: result.inputs,
            result: place.map_or_else(|| Where::Memory(Box::new(result)), Where::Journal),
        }
    }
}

impl Kept {
    /// Results of the `planned` runs, none of which has ended. Without a journal they are in memory.
    #[must_use]
    pub fn new(journal: Option<Journal>, planned: impl Into<Planned>) -> Self {
        let planned = planned.into();
        Self { journal, planned, ended: BTreeMap::new(), overrides: None }
    }

    /// Results in the journal at `path`, and its suite. Only runs for which `counts` is true count as ended; [`Kept::plan`] must set
    /// the runs afterwards.
    ///
    /// # Errors
    /// [`JournalError`]
    pub fn resume(path: PathBuf, counts: impl Fn(&Finished) -> bool) -> Result<(Self, Suite), JournalError> {
        let (mut ended, mut overrides) = (BTreeMap::new(), None);
        let (journal, suite) = Journal::resume(path, |finished, place| {
            if counts(&finished) {
                keep_common(&mut overrides, &finished.result);
                ended.insert(finished.index, Ended::new(finished, Some(place)));
            } else {
                ended.remove(&finished.index);
            }
        })?;
        Ok((Self { journal: Some(journal), planned: Planned::default(), ended, overrides }, suite))
    }

    /// Sets the planned runs.
    pub fn plan(&mut self, planned: impl Into<Planned>) {
        let planned = planned.into();
        self.ended.retain(|index, _| *index < planned.len());
        self.planned = planned;
    }

    /// The planned runs, ended or not.
    #[must_use]
    pub const fn planned(&self) -> &Planned {
        &self.planned
    }

    /// Drops the finished runs whose inputs differ from those that `inputs` gives for their place; returns their
    /// places, to be run again.
    pub fn hold_inputs(&mut self, inputs: impl Fn(usize) -> Digest) -> Vec<usize> {
        let others = self.ended.extract_if(.., |index, ended| ended.inputs != inputs(*index));
        others.map(|(index, _)| index).collect()
    }

    /// Number of finished runs.
    #[must_use]
    pub fn ended(&self) -> usize {
        self.ended.len()
    }

    /// True if the run at `index` has ended.
    #[must_use]
    pub fn has(&self, index: usize) -> bool {
        self.ended.contains_key(&index)
    }

    /// Records a finished run.
    ///
    /// # Errors
    /// [`JournalError`] if the journal cannot record it: it is then kept in memory.
    pub fn note(&mut self, finished: Finished) -> Result<(), JournalError> {
        let noted = self.journal.as_mut().map(|journal| journal.append(&finished)).transpose();
        keep_common(&mut self.overrides, &finished.result);
        let (place, refusal) = noted.map_or_else(|error| (None, Some(error)), |place| (place, None));
        self.ended.insert(finished.index, Ended::new(finished, place));
        refusal.map_or(Ok(()), Err)
    }

    /// Syncs the journal to disk.
    ///
    /// # Errors
    /// [`JournalError::Io`]
    pub fn sync(&mut self) -> Result<(), JournalError> {
        self.journal.as_mut().map_or(Ok(()), Journal::sync)
    }
}

/// Retains only overrides that `run` has too.
fn keep_common(overrides: &mut Option<Vec<String>>, run: &RunResult) {
    match overrides {
        None => *overrides = Some(run.overrides.clone()),
        Some(all) => all.retain(|one| run.overrides.contains(one)),
    }
}

impl Runs for Kept {
    fn heads(&self) -> Box<dyn Iterator<Item = RunHead<'_>> + '_> {
        let heads = self.ended.iter().filter_map(|(index, ended)| {
            let Unfinished { name, file, engine, axis } = self.planned.get(*index)?;
            let &Ended { verdict, took, has_recording, lifts, warns, .. } = ended;
            let (file, took) = (file.as_deref(), Some(took));
            let axis = *axis;
            Some(RunHead { index: *index, name, file, engine, axis, verdict, took, has_recording, lifts, warns })
        });
        Box::new(heads)
    }

    fn result(&self, index: usize) -> Result<Cow<'_, RunResult>, JournalError> {
        match (self.ended.get(&index).map(|ended| &ended.result), &self.journal) {
            (Some(Where::Memory(result)), _) => Ok(Cow::Borrowed(result)),
            (Some(Where::Journal(place)), Some(journal)) => Ok(Cow::Owned(journal.at(*place)?.result)),
            (Some(Where::Journal(_)) | None, _) => Err(JournalError::NoSuchRun(index)),
        }
    }

    fn unfinished(&self) -> Box<dyn Iterator<Item = &Unfinished> + '_> {
        let missing = (0..self.planned.len()).filter(|index| !self.has(*index));
        Box::new(missing.filter_map(|index| self.planned.get(index)))
    }

    fn overrides(&self) -> Vec<&str> {
        self.overrides.iter().flatten().map(String::as_str).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples;

    fn planned() -> Vec<Unfinished> {
        let all = [samples::jerk(), samples::missed(), samples::broken(), samples::snap()];
        let all = all.map(|RunResult { name, file, engine, axis, .. }| Unfinished { name, file, engine, axis });
        all.to_vec()
    }

    fn suite() -> Suite {
        Suite::new(Digest::default(), vec![], "/".into(), None, vec![])
    }

    fn finished(index: usize, result: RunResult) -> Finished {
        Finished { index, seconds: 0.25, result }
    }

    /// A result is the same in memory and in the journal.
    #[test]
    fn results_come_back_from_wherever_they_are_kept() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("results.journal");
        let journal = Journal::create(path.clone(), &suite()).unwrap();
        for mut kept in [Kept::new(None, planned()), Kept::new(Some(journal), planned())] {
            for (index, run) in [(2, samples::broken()), (0, samples::jerk()), (1, samples::missed())] {
                kept.note(finished(index, run)).unwrap();
            }
            let runs: &dyn Runs = &kept;
            let each: Vec<RunResult> = runs.each().map(|one| one.unwrap().into_owned()).collect();
            assert_eq!(each, [samples::jerk(), samples::missed(), samples::broken()]);
            assert_eq!(runs.unfinished().collect::<Vec<_>>(), [&planned()[3]]);
            let heads: Vec<_> = runs.heads().collect();
            assert!(heads.iter().all(|head| head.took == Some(Duration::from_millis(250))));
            assert_eq!(
                heads.iter().map(|head| head.verdict).collect::<Vec<_>>(),
                each.iter().map(|run| run.verdict).collect::<Vec<_>>()
            );
            assert!(matches!(runs.result(3), Err(JournalError::NoSuchRun(3))));
        }
        // A run recorded again counts with its last record; one that does not count any more has not ended.
        let (mut kept, _) = Kept::resume(path, |one| one.index != 1).unwrap();
        kept.plan(planned());
        assert_eq!((kept.ended(), kept.has(1), kept.planned().len()), (2, false, 4));
        kept.note(finished(0, samples::snap())).unwrap();
        assert_eq!(kept.result(0).unwrap().into_owned(), samples::snap());
    }

    /// A journal may name places outside of the suite.
    #[test]
    fn places_beyond_the_suite_are_none() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("results.journal");
        let mut journal = Journal::create(path.clone(), &suite()).unwrap();
        journal.append(&finished(usize::MAX, samples::jerk())).unwrap();
        journal.append(&finished(3, samples::snap())).unwrap();
        let (mut kept, _) = Kept::resume(path, |_| true).unwrap();
        kept.plan(planned());
        assert_eq!((kept.ended(), kept.heads().count()), (1, 1));
    }

    /// With a full disk the results of a suite are still there when it ends.
    #[cfg(target_os = "linux")]
    #[test]
    fn what_the_journal_does_not_hold_is_in_memory() {
        let folder = tempfile::tempdir().unwrap();
        let journal = Journal::create(folder.path().join("results.journal"), &suite()).unwrap();
        let mut kept = Kept::new(Some(journal.on("/dev/full")), planned());
        assert!(matches!(kept.note(finished(1, samples::missed())), Err(JournalError::Io { .. })));
        assert_eq!(kept.result(1).unwrap().into_owned(), samples::missed());
        assert_eq!(kept.heads().count(), 1);
    }
}
