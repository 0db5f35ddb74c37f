//! What came of each run, kept where nothing that has ended is lost: in the journal while the suite runs, in `results.json` and
//! JUnit at its end, whichever end that is.
use super::{Files, Timed};
use crate::error::CliError;
use crate::interrupt;
use crate::outputs::OutputFolder;
use servobench_report::junit;
use servobench_results::{Digest, Finished, Folder, Journal, Outcome, RESULTS, Results, RunResult, Suite, Unfinished};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// The results of a suite as they come. One thread after the other notes its runs; the last word is that of whoever closes it.
pub(super) struct Ledger {
    folder: Folder,
    files: Files,
    suite: Digest,
    /// Stems of the files that the runs leave.
    stems: Vec<String>,
    /// The runs that are asked for.
    planned: Vec<Unfinished>,
    state: Mutex<State>,
}

struct State {
    /// `None` once the ledger is closed, or when the journal could not be written.
    journal: Option<Journal>,
    /// At the places of the runs.
    ended: Vec<Option<Timed>>,
    troubles: Vec<CliError>,
    is_closed: bool,
}

/// What a closed ledger holds.
pub(super) struct Closed {
    /// The results, as they are in `results.json`.
    pub(super) results: Results,
    /// What could not be written.
    pub(super) troubles: Vec<CliError>,
}

impl Ledger {
    /// Begins the journal of `suite`, and says in `results.json` that it is under way.
    pub(super) fn begin(
        folder: Folder,
        files: Files,
        planned: Vec<Unfinished>,
        suite: &Suite,
    ) -> Result<Self, CliError> {
        let journal = Journal::create(folder.journal(), suite)?;
        let ledger = Self::new(folder, files, planned, suite, journal);
        let results = Results::of_suite(ledger.suite.clone(), Vec::new(), ledger.planned.clone());
        ledger.files.out.file(RESULTS)?.write(results.to_json()?)?;
        Ok(ledger)
    }

    /// Goes on with the journal of a suite in which the runs `finished` have ended.
    pub(super) fn resume(
        folder: Folder,
        files: Files,
        planned: Vec<Unfinished>,
        (journal, suite): (Journal, &Suite),
        finished: Vec<Finished>,
    ) -> Self {
        let ledger = Self::new(folder, files, planned, suite, journal);
        let mut state = ledger.state();
        for Finished { index, seconds, result } in finished {
            if let Some(place) = state.ended.get_mut(index) {
                *place = Some((result, Duration::try_from_secs_f64(seconds).unwrap_or_default()));
            }
        }
        drop(state);
        ledger
    }

    fn new(folder: Folder, files: Files, planned: Vec<Unfinished>, suite: &Suite, journal: Journal) -> Self {
        let ended = planned.iter().map(|_| None).collect();
        let state = State { journal: Some(journal), ended, troubles: Vec::new(), is_closed: false };
        let (suite, stems) = (suite.suite.clone(), suite.stems.clone());
        Self { folder, files, suite, stems, planned, state: Mutex::new(state) }
    }

    /// The folder of the results.
    pub(super) const fn folder(&self) -> &Folder {
        &self.folder
    }

    /// The same for what runs leave there.
    pub(super) const fn out(&self) -> &OutputFolder {
        &self.files.out
    }

    /// Whether the run at `index` has ended.
    pub(super) fn has(&self, index: usize) -> bool {
        self.state().ended.get(index).is_some_and(Option::is_some)
    }

    /// The run at `index` has ended. What ends because the program is being ended is not noted.
    pub(super) fn note(&self, index: usize, result: RunResult, took: Duration) {
        let mut state = self.state();
        if state.is_closed || interrupt::is_ending() {
            return;
        }
        let finished = Finished { index, seconds: took.as_secs_f64(), result };
        if let Some(journal) = &mut state.journal
            && let Err(error) = journal.append(&finished)
        {
            // Said once: what follows may find room again.
            let is_known = state.troubles.iter().any(|trouble| matches!(trouble, CliError::Journal(_)));
            if !is_known {
                state.troubles.push(CliError::Journal(error));
            }
        }
        if let Some(place) = state.ended.get_mut(index) {
            *place = Some((finished.result, took));
        }
    }

    /// Writes results and JUnit; the journal goes when every run has a verdict, since nothing is then left for
    /// `--resume`. Whoever comes second finds it closed.
    pub(super) fn close(&self) -> Option<Closed> {
        let mut state = self.state();
        if std::mem::replace(&mut state.is_closed, true) {
            return None;
        }
        let ended = std::mem::take(&mut state.ended);
        let mut troubles = std::mem::take(&mut state.troubles);
        let (mut runs, mut times, mut unfinished) = (Vec::new(), Vec::new(), Vec::new());
        for (planned, ended) in self.planned.iter().zip(ended) {
            match ended {
                Some((result, took)) => {
                    runs.push(result);
                    times.push(took);
                }
                None => unfinished.push(planned.clone()),
            }
        }
        let results = Results::of_suite(self.suite.clone(), runs, unfinished);
        if let Some(journal) = &mut state.journal
            && let Err(error) = journal.sync()
        {
            troubles.push(error.into());
        }
        let text = results.to_json().map_err(CliError::from);
        let written = text.and_then(|text| self.files.out.file(RESULTS)?.write_durably(text));
        let is_safe = written.is_ok();
        troubles.extend(written.err());
        if let Some(output) = &self.files.junit {
            let text = junit(&results, &times).map_err(CliError::from);
            troubles.extend(text.and_then(|text| output.write(text)).err());
        }
        state.journal = None;
        if is_safe && results.unfinished.is_empty() && results.count_of(Outcome::Error) == 0 {
            // One that stays is of a suite that is complete, which it says.
            std::fs::remove_file(self.folder.journal()).ok();
        } else {
            self.folder.remove_unnamed(&self.stems, &results);
        }
        Some(Closed { results, troubles })
    }

    fn state(&self) -> MutexGuard<'_, State> {
        // Nothing is left half done with it.
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
