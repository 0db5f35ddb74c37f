//! What came of each run, kept where nothing that has ended is lost: in the journal while the suite runs, in `results.json` and
//! JUnit at its end, whichever end that is.
use super::files::Files;
use crate::error::CliError;
use crate::interrupt;
use crate::outputs::{Output, OutputFolder};
use servobench_report::junit;
use servobench_results::{
    Digest, Finished, Folder, Journal, Kept, Outcome, Planned, RESULTS, ResultsError, Runs, Suite, Unfinished,
    write_results,
};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// The results of a suite as they come. One thread after the other notes its runs; the last word is that of whoever closes it.
pub(crate) struct Ledger {
    folder: Folder,
    files: Files,
    suite: Digest,
    /// Stems of the files that the runs leave.
    stems: Vec<String>,
    state: Mutex<State>,
}

struct State {
    /// `None` once the ledger is closed.
    kept: Option<Kept>,
    troubles: Vec<CliError>,
}

/// What a closed ledger holds.
pub(crate) struct Closed {
    /// The results, as they are in `results.json`.
    pub(crate) kept: Kept,
    /// What could not be written.
    pub(crate) troubles: Vec<CliError>,
}

impl Ledger {
    /// Begins the journal of `suite`, and says in `results.json` that it is under way.
    pub(crate) fn begin(
        folder: Folder,
        files: Files,
        planned: impl Into<Planned>,
        suite: &Suite,
    ) -> Result<Self, CliError> {
        let kept = Kept::new(Some(Journal::create(folder.journal(), suite)?), planned);
        let output = files.out.file(RESULTS)?;
        output.stream(|out| Ok(write_results(&suite.suite, &kept, out)?)).map_err(|error| told(&output, error))?;
        Ok(Self::new(folder, files, kept, suite))
    }

    /// Goes on with what was kept of a suite.
    pub(crate) fn resume(folder: Folder, files: Files, kept: Kept, suite: &Suite) -> Self {
        Self::new(folder, files, kept, suite)
    }

    fn new(folder: Folder, files: Files, kept: Kept, suite: &Suite) -> Self {
        let state = Mutex::new(State { kept: Some(kept), troubles: Vec::new() });
        Self { folder, files, suite: suite.suite, stems: suite.stems.clone(), state }
    }

    /// The folder of the results.
    pub(crate) const fn folder(&self) -> &Folder {
        &self.folder
    }

    /// The same for what runs leave there.
    pub(crate) const fn out(&self) -> &OutputFolder {
        &self.files.out
    }

    /// Whether the run at `index` has ended.
    pub(crate) fn has(&self, index: usize) -> bool {
        self.state().kept.as_ref().is_some_and(|kept| kept.has(index))
    }

    /// What the run at `index` is called.
    pub(crate) fn planned(&self, index: usize) -> Option<Unfinished> {
        self.state().kept.as_ref().and_then(|kept| kept.planned().get(index).cloned())
    }

    /// A run has ended. What ends because the program is being ended is not noted.
    pub(crate) fn note(&self, finished: Finished) {
        let mut state = self.state();
        let State { kept: Some(kept), troubles } = &mut *state else { return };
        if interrupt::is_ending() {
            return;
        }
        if let Err(error) = kept.note(finished) {
            // Said once: what follows may find room again.
            let is_known = troubles.iter().any(|trouble| matches!(trouble, CliError::Journal(_)));
            if !is_known {
                troubles.push(CliError::Journal(error));
            }
        }
    }

    /// Writes results and JUnit; the journal goes when every run has a verdict, since nothing is then left for
    /// `--resume`. Whoever comes second finds it closed.
    pub(crate) fn close(&self) -> Option<Closed> {
        let mut state = self.state();
        let mut kept = state.kept.take()?;
        let mut troubles = std::mem::take(&mut state.troubles);
        troubles.extend(kept.sync().err().map(CliError::from));
        let written = self.write_results(&kept);
        let is_safe = written.is_ok();
        troubles.extend(written.err());
        if let Some(output) = &self.files.junit {
            troubles.extend(write_junit(&kept, output).err());
        }
        if is_safe && kept.unfinished().next().is_none() && kept.heads().all(|head| head.verdict != Outcome::Error) {
            // One that stays is of a suite that is complete, which it says.
            std::fs::remove_file(self.folder.journal()).ok();
        } else {
            troubles.extend(self.folder.remove_unnamed(&self.stems, &kept).err().map(CliError::from));
        }
        Some(Closed { kept, troubles })
    }

    fn write_results(&self, kept: &Kept) -> Result<(), CliError> {
        let output = self.files.out.file(RESULTS)?;
        let written = output.stream_durably(|out| Ok(write_results(&self.suite, kept, out)?));
        written.map_err(|error| told(&output, error))
    }

    fn state(&self) -> MutexGuard<'_, State> {
        // Nothing is left half done with it.
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Writes the JUnit report of `runs`.
pub(crate) fn write_junit(runs: &dyn Runs, output: &Output) -> Result<(), CliError> {
    output.stream(|out| {
        for part in junit(runs) {
            out.write_all(part?.as_bytes()).map_err(|error| output.failed(error))?;
        }
        Ok(())
    })
}

/// What the system says of a file of results, with its name.
fn told(output: &Output, error: CliError) -> CliError {
    match error {
        CliError::Results(ResultsError::Write(error)) => output.failed(error),
        error => error,
    }
}
