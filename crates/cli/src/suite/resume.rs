//! `--resume`: the rest of a suite that was ended before its time.
use crate::args::{self, Command, SuiteArgs};
use crate::error::CliError;
use crate::sources;
use servobench_results::{
    Finished, Folder, JournalError, Kept, Outcome, RESULTS, Results, Status, Suite, read_results,
};
use servobench_trace::verified_seal_of;
use std::io::ErrorKind;
use std::path::Path;

/// A suite that can go on.
pub(crate) struct Begun {
    pub(crate) folder: Folder,
    pub(crate) suite: Suite,
    /// The runs whose results and files are there.
    pub(crate) kept: Kept,
    /// The command that began it.
    pub(crate) command: Command,
}

/// What is in a folder that is to be resumed.
pub(crate) enum Found {
    Begun(Box<Begun>),
    /// Nothing is left to run.
    Complete(Results),
}

/// The suite in `folder`, as far as it came. From now on relative paths are those of the command that began it.
pub(crate) fn suite_in(folder: &Path, now: &SuiteArgs) -> Result<Found, CliError> {
    if !folder.is_dir() {
        return Err(CliError::NothingToResume(folder.to_owned()));
    }
    let absolute = std::path::absolute(folder).map_err(|error| CliError::Read { path: folder.to_owned(), error })?;
    let there = Folder::open(&absolute)?;
    let counts = |one: &Finished| is_settled(one) && is_there(there.path(), one);
    let (kept, suite) = match Kept::resume(there.journal(), counts) {
        Ok(found) => found,
        Err(JournalError::Io { source, .. }) if source.kind() == ErrorKind::NotFound => {
            return complete(folder).map(Found::Complete);
        }
        Err(error) => return Err(error.into()),
    };
    let Some(command) = args::of(&suite.command) else { return Err(CliError::NothingToResume(absolute)) };
    let began = match &command {
        Command::Run(began) => &began.suite,
        Command::Sweep(began) => &began.suite,
        _ => return Err(CliError::NothingToResume(absolute)),
    };
    // Trust is what is given now: the journal is a file.
    if began.fmus.allow_unisolated_fmus && !now.fmus.allow_unisolated_fmus {
        return Err(CliError::TrustAgain);
    }
    std::env::set_current_dir(&suite.folder).map_err(|error| CliError::Read { path: suite.folder.clone(), error })?;
    if let Some(text) = &suite.standard_input {
        sources::give_stdin(text.clone());
    }
    Ok(Found::Begun(Box::new(Begun { folder: there, suite, kept, command })))
}

/// Results of a suite that has ended.
fn complete(folder: &Path) -> Result<Results, CliError> {
    let path = folder.join(RESULTS);
    let text = read_results(&path).map_err(|_| CliError::NothingToResume(folder.to_owned()))?;
    let results = Results::from_json(&text).map_err(|error| CliError::ReadResults { path, error })?;
    if results.status == Status::Complete { Ok(results) } else { Err(CliError::NothingToResume(folder.to_owned())) }
}

/// Whether the run has a verdict. One that could not be carried out is tried again: its process may have been ended from outside, or
/// the disk may have been full.
fn is_settled(finished: &Finished) -> bool {
    finished.result.verdict != Outcome::Error
}

/// Whether every file that the run left is there, and its recording the one that was measured.
fn is_there(folder: &Path, finished: &Finished) -> bool {
    let run = &finished.result;
    let is_whole = |name: &String| folder.join(name).is_file();
    let is_own =
        run.recording.as_ref().zip(run.recording_seal.as_ref()).is_none_or(|(name, seal)| {
            verified_seal_of(folder.join(name)).is_ok_and(|found| found.as_ref() == Some(seal))
        });
    run.files.iter().all(is_whole) && is_own
}
