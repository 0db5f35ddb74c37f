//! Results of the runs, saved so that none is lost: in the journal while the suite runs, in `results.json` and JUnit at its end, however it
//! ends.
use super::files::Files;
use super::held::changed_files;
use crate::error::CliError;
use crate::interrupt;
use crate::outputs::{Output, OutputFolder};
use crate::workers::at_a_time;
use servobench_report::junit;
use servobench_results::{
    Digest, Finished, Folder, Journal, JournalError, Kept, Outcome, Planned, RESULTS, ResultsError, RunResult, Runs,
    Suite, Unfinished, write_results,
};
use servobench_suite::{RunLimits, map_in_parallel};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// The results of a suite as they come. Threads note their runs in turn; closing it writes the results once.
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

/// Content of a closed ledger.
pub(crate) struct Closed {
    /// The results, as they are in `results.json`.
    pub(crate) kept: Kept,
    /// Errors of writing.
    pub(crate) troubles: Vec<CliError>,
}

impl Ledger {
    /// Begins the journal of `suite`, and marks it as running in `results.json`.
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

    /// Resumes a suite with its saved results.
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

    /// The folder of the results as an output for the files of runs.
    pub(crate) const fn out(&self) -> &OutputFolder {
        &self.files.out
    }

    /// True if the run at `index` has ended.
    pub(crate) fn has(&self, index: usize) -> bool {
        self.state().kept.as_ref().is_some_and(|kept| kept.has(index))
    }

    /// Name, file and engine of the run at `index`.
    pub(crate) fn planned(&self, index: usize) -> Option<Unfinished> {
        self.state().kept.as_ref().and_then(|kept| kept.planned().get(index).cloned())
    }

    /// Notes the end of a run, unless the program is being ended.
    pub(crate) fn note(&self, finished: Finished) {
        let mut state = self.state();
        let State { kept: Some(kept), troubles } = &mut *state else { return };
        if interrupt::is_ending() {
            return;
        }
        if let Err(error) = kept.note(finished) {
            // Reported once: later runs may find room again.
            let is_known = troubles.iter().any(|trouble| matches!(trouble, CliError::Journal(_)));
            if !is_known {
                troubles.push(CliError::Journal(error));
            }
        }
    }

    /// Writes results and JUnit; removes the journal when every run has a verdict, since nothing is left for `--resume`. Returns `None` on
    /// further calls.
    pub(crate) fn close(&self) -> Option<Closed> {
        let mut state = self.state();
        let mut kept = state.kept.take()?;
        let mut troubles = std::mem::take(&mut state.troubles);
        if kept.unfinished().next().is_none() {
            troubles.extend(self.hold_files(&mut kept).err().map(CliError::from));
        }
        troubles.extend(kept.sync().err().map(CliError::from));
        let written = self.write_results(&kept);
        let is_safe = written.is_ok();
        troubles.extend(written.err());
        if let Some(output) = &self.files.junit {
            troubles.extend(write_junit(&kept, output).err());
        }
        if is_safe && kept.unfinished().next().is_none() && kept.heads().all(|head| head.verdict != Outcome::Error) {
            // A journal that cannot be removed belongs to a complete suite and states that.
            std::fs::remove_file(self.folder.journal()).ok();
        } else {
            troubles.extend(self.folder.remove_unnamed(&self.stems, &kept).err().map(CliError::from));
        }
        Some(Closed { kept, troubles })
    }

    /// Turns the verdict of each run whose files have changed into an error: something changed or removed them while the suite ran, and
    /// results that name them would be of another run.
    fn hold_files(&self, kept: &mut Kept) -> Result<(), JournalError> {
        let mut left: Vec<(usize, Duration, RunResult)> = Vec::new();
        for head in kept.heads().filter(|head| head.has_recording) {
            // The names alone: all results at once are larger than memory.
            let RunResult { recording, recording_seal, files, .. } = kept.result(head.index)?.into_owned();
            let names = RunResult { recording, recording_seal, files, ..RunResult::default() };
            left.push((head.index, head.took.unwrap_or_default(), names));
        }
        let limit = at_a_time(None, RunLimits { time: None, memory: u64::MAX });
        let folder = self.folder.path();
        let changed = map_in_parallel(&left, limit, |_| ((), 0), |(.., run), ()| changed_files(folder, run));
        for ((index, took, _), changed) in left.iter().zip(changed) {
            let Some(what) = changed.unwrap_or_else(|panic| Some(panic.to_string())) else { continue };
            let mut result = kept.result(*index)?.into_owned();
            result.verdict = Outcome::Error;
            result.reasons = vec![format!("what the run left was changed while the suite ran: {what}")];
            (result.recording, result.recording_seal, result.files) = (None, None, Vec::new());
            kept.note(Finished { index: *index, seconds: took.as_secs_f64(), result })?;
        }
        Ok(())
    }

    fn write_results(&self, kept: &Kept) -> Result<(), CliError> {
        let output = self.files.out.file(RESULTS)?;
        let written = output.stream_durably(|out| Ok(write_results(&self.suite, kept, out)?));
        written.map_err(|error| told(&output, error))
    }

    fn state(&self) -> MutexGuard<'_, State> {
        // A panic never leaves the state half changed.
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

/// `error` with the name of the results file if writing failed.
fn told(output: &Output, error: CliError) -> CliError {
    match error {
        CliError::Results(ResultsError::Write(error)) => output.failed(error),
        error => error,
    }
}
