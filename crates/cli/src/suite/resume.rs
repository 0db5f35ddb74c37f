//! `--resume`: the rest of a suite that was interrupted.
//!
//! A journal may come from an untrusted source. Only the scenarios and the settings of their runs are taken from it; they must be where
//! the present command line allows scenarios. That alone sets readable folders, the path of the JUnit report and the trust in FMUs.
use super::complete::{complete, listed};
use super::held::{changed_files, changed_inputs};
use crate::args::{self, Command, SuiteArgs};
use crate::build_id;
use crate::console::say;
use crate::error::CliError;
use crate::sources::{self, is_stdin};
use servobench_results::{Digest, Finished, Folder, JournalError, Kept, Outcome, Results, Suite};
use servobench_scenario::root_of;
use std::cell::RefCell;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

/// A suite that can be resumed.
pub(crate) struct Begun {
    pub(crate) folder: Folder,
    pub(crate) suite: Suite,
    /// The runs whose results and files exist.
    pub(crate) kept: Kept,
    /// The command that began it.
    pub(crate) command: Command,
    /// Folder of relative paths on the present command line.
    pub(crate) here: PathBuf,
}

/// Content of a folder that is to be resumed.
pub(crate) enum Found {
    Begun(Box<Begun>),
    /// Nothing is left to run.
    Complete(Results),
}

/// The suite in `folder`, as far as it came. If it is to be resumed, the current folder becomes that of the command that began it.
pub(crate) fn suite_in(folder: &Path, now: &SuiteArgs) -> Result<Found, CliError> {
    if !folder.is_dir() {
        return Err(CliError::NothingToResume(folder.to_owned()));
    }
    let unread = |path: &Path| {
        let path = path.to_owned();
        |error| CliError::Read { path, error }
    };
    let absolute = std::path::absolute(folder).map_err(unread(folder))?;
    let there = Folder::open(&absolute)?;
    let again = RefCell::new(Vec::new());
    let counts = |one: &Finished| {
        let changed = changed_files(there.path(), &one.result);
        let is_whole = changed.is_none();
        again.borrow_mut().extend(changed);
        is_settled(one) && is_whole
    };
    let (kept, suite) = match Kept::resume(there.journal(), counts) {
        Ok(found) => found,
        Err(JournalError::Io { source, .. }) if source.kind() == ErrorKind::NotFound => {
            return complete(folder, now.with.root.as_deref()).map(Found::Complete);
        }
        Err(error) => return Err(error.into()),
    };
    let Some(command) = args::of(&suite.command) else { return Err(CliError::NothingToResume(absolute)) };
    let (began, scenarios) = match &command {
        Command::Run(began) => (&began.suite, began.scenarios.clone()),
        Command::Sweep(began) => (&began.suite, began.sweep.iter().cloned().collect()),
        _ => return Err(CliError::NothingToResume(absolute)),
    };
    let here = std::env::current_dir().map_err(unread(Path::new(".")))?;
    allowed(&absolute, &here, now, &suite.folder, &scenarios)?;
    if began.fmus.allow_unisolated_fmus && !now.fmus.allow_unisolated_fmus {
        return Err(CliError::TrustAgain);
    }
    if let (Some(root), None) = (&began.with.root, &now.with.root) {
        return Err(CliError::RootAgain(root.clone()));
    }
    if began.junit.is_some() && now.junit.is_none() && !now.quiet {
        say("no JUnit report is written: where it goes is said by `--junit` of this command line alone\n");
    }
    for what in again.into_inner().iter().filter(|_| !now.quiet) {
        say(&format!("{what}: that is run again\n"));
    }
    std::env::set_current_dir(&suite.folder).map_err(unread(&suite.folder))?;
    if let Some(text) = &suite.standard_input {
        sources::give_stdin(text.clone());
    }
    Ok(Found::Begun(Box::new(Begun { folder: there, suite, kept, command, here })))
}

/// Refuses a journal that would read more than the present command line allows: the starting folder of paths and all scenarios must be
/// within `--root`; without it within the project of the current folder, or beside the folder of the results.
fn allowed(results: &Path, here: &Path, now: &SuiteArgs, start: &Path, scenarios: &[PathBuf]) -> Result<(), CliError> {
    let given = now.with.root.as_deref();
    let unread = |error| CliError::Read { path: given.unwrap_or(here).to_owned(), error };
    let mut roots = vec![root_of(here, given).map_err(unread)?];
    if given.is_none() {
        roots.extend(results.canonicalize().ok().and_then(|folder| folder.parent().map(Path::to_owned)));
    }
    let files = scenarios.iter().filter(|path| !is_stdin(path)).map(|path| start.join(path));
    for path in std::iter::once(start.to_owned()).chain(files) {
        // A missing path is not read.
        let Ok(real) = path.canonicalize() else { continue };
        if !roots.iter().any(|root| real.starts_with(root)) {
            return Err(CliError::OutsideOfToday { folder: results.to_owned(), path: real, roots });
        }
    }
    Ok(())
}

/// Error of a suite in `folder` that has changed, with the differences found in its ended runs.
pub(crate) fn other_suite(folder: &Path, suite: &Suite, kept: &Kept, root: Option<&Path>) -> CliError {
    let mut found: Vec<String> = Vec::new();
    let program = Digest::of(build_id::program().as_bytes());
    if suite.program == program || suite.program == Digest::default() {
        let runs: &dyn servobench_results::Runs = kept;
        for run in runs.each().flatten() {
            let changed =
                changed_inputs(&run, root).into_iter().filter(|what| !found.contains(what)).collect::<Vec<_>>();
            found.extend(changed);
        }
    } else {
        found.push(format!("the program is another one ({} now)", build_id::program()));
    }
    if found.is_empty() {
        found.push("a scenario that has no result yet, or its place in the suite, has changed".into());
    }
    CliError::OtherSuite { folder: folder.to_owned(), found: listed(found) }
}

/// True for a run that has a verdict. One that could not be carried out is tried again: its process may have been ended from outside, or
/// the disk may have been full.
fn is_settled(finished: &Finished) -> bool {
    finished.result.verdict != Outcome::Error
}
