//! The output folder of a suite: one suite at a time, without leftovers of earlier ones.
use crate::error::ResultsError;
use crate::journal::{self, JournalError};
use crate::results::files_of_results;
use crate::runs::Runs;
use servobench_files::FolderLock;
use servobench_trace::unfinished_by;
use std::collections::HashSet;
use std::ffi::OsStr;
use std::fs::{self, TryLockError};
use std::io::{self, Read as _};
use std::path::{Path, PathBuf};
use thiserror::Error;

/// List of results that `run` leaves beside its recordings.
pub const RESULTS: &str = "results.json";
/// Journal that an interrupted `run` leaves beside `results.json`.
pub const JOURNAL: &str = "results.journal";
/// List of results that `compare` leaves beside its recording.
pub const COMPARISON: &str = "comparison.json";

/// Table of `sweep` for spreadsheets.
pub const TABLE_CSV: &str = "sweep.csv";
/// Table of `sweep` for data tools.
pub const TABLE_PARQUET: &str = "sweep.parquet";
/// Drawing of `sweep`: metrics over the dimensions that vary.
pub const SWEEP_MAP: &str = "sweep.svg";
/// Drawing of `sweep`: time against vibration.
pub const SWEEP_FRONT: &str = "sweep-front.svg";
/// All files that `sweep` leaves besides results and recordings.
pub const OF_A_SWEEP: [&str; 4] = [TABLE_CSV, TABLE_PARQUET, SWEEP_MAP, SWEEP_FRONT];

/// Endings of the names of files that a run may leave.
const KINDS: [&str; 3] = [".parquet", ".timing.svg", ".rrd"];

/// A folder into which only this process writes, until it is dropped or the process ends, in whatever way.
#[derive(Debug)]
pub struct Folder {
    path: PathBuf,
    _lock: FolderLock,
}

/// Reasons why a folder cannot be written into.
#[derive(Debug, Error)]
pub enum FolderError {
    /// The folder cannot be created.
    #[error("cannot make the folder `{}`: {source}", path.display())]
    Make {
        /// The folder.
        path: PathBuf,
        /// Error of the system.
        source: io::Error,
    },
    /// Another process writes into the folder.
    #[error(
        "another servobench writes into `{}` now: wait until it has ended, or name another folder with `--out`",
        .0.display()
    )]
    InUse(PathBuf),
    /// The file in the place of results is something else.
    #[error(
        "`{}` is no list of results that this program wrote ({why}) and would be lost: name another folder with `--out`, or \
         remove it", path.display()
    )]
    NotOurs {
        /// The file.
        path: PathBuf,
        /// Reason why it is not one of ours.
        why: ResultsError,
    },
    /// The folder cannot be locked.
    #[error(
        "cannot lock the folder `{}`: {source}; name one on a file system with locks (flock) with `--out`", path.display()
    )]
    Lock {
        /// The folder.
        path: PathBuf,
        /// Error of the system.
        source: io::Error,
    },
}

/// Leftovers of earlier suites in a folder.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Former {
    /// Recordings, diagrams and drawings.
    names: HashSet<String>,
    /// Their lists.
    lists: Vec<&'static str>,
}

impl Folder {
    /// Creates the folder if it is missing, and locks it against other processes.
    ///
    /// # Errors
    /// [`FolderError`]
    pub fn open(path: &Path) -> Result<Self, FolderError> {
        fs::create_dir_all(path).map_err(|source| FolderError::Make { path: path.to_owned(), source })?;
        let cannot_lock = |source| FolderError::Lock { path: path.to_owned(), source };
        match FolderLock::of(path) {
            Ok(lock) => {
                remove_unfinished(path);
                Ok(Self { path: path.to_owned(), _lock: lock })
            }
            Err(TryLockError::WouldBlock) => Err(FolderError::InUse(path.to_owned())),
            Err(TryLockError::Error(error)) => Err(cannot_lock(error)),
        }
    }

    /// Path of the folder.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Path of the journal.
    #[must_use]
    pub fn journal(&self) -> PathBuf {
        self.path.join(JOURNAL)
    }

    /// Leftovers of earlier suites: exactly the files that `list` names and the list itself; with [`RESULTS`] also the files that a journal
    /// names and those half written when its suite was interrupted. Files named by the list of another command are left out.
    ///
    /// # Errors
    /// [`FolderError::NotOurs`] if a file of that name is something else.
    pub fn former(&self, list: &'static str) -> Result<Former, FolderError> {
        let mut names = HashSet::new();
        let path = self.path.join(list);
        match files_of_results(&path) {
            Ok(files) => names.extend(files.into_iter().filter(|name| is_left_by_a_run(name))),
            // Most often it is missing.
            Err(ResultsError::Read(_)) => {}
            Err(why) => return Err(FolderError::NotOurs { path, why }),
        }
        let mut former = Former { lists: vec![list], ..Former::default() };
        if list == RESULTS {
            former.lists.push(JOURNAL);
            if is_table_of_a_sweep(&self.path.join(TABLE_CSV)).is_ok_and(|is_ours| is_ours) {
                former.lists.extend(OF_A_SWEEP);
            }
            if let Ok(file) = servobench_files::open(&self.journal(), u64::MAX)
                && let Ok(suite) = journal::read(file, &self.journal(), |one, _| {
                    names.extend(one.result.files.into_iter().filter(|name| is_left_by_a_run(name)));
                })
            {
                names.extend(left_by(&suite.stems));
            }
        }
        let other = if list == RESULTS { COMPARISON } else { RESULTS };
        for kept in files_of_results(&self.path.join(other)).unwrap_or_default() {
            names.remove(&kept);
        }
        former.names = names;
        Ok(former)
    }

    /// Removes the leftovers; returns the number of recordings, diagrams and drawings removed.
    #[expect(clippy::must_use_candidate, reason = "to remove them is what it is for")]
    pub fn remove(&self, former: &Former) -> usize {
        let removed = former.names.iter().filter(|name| fs::remove_file(self.path.join(name)).is_ok()).count();
        // The lists name nothing any more; the current suite writes new ones.
        for list in &former.lists {
            fs::remove_file(self.path.join(list)).ok();
        }
        removed
    }

    /// Removes the files of runs with these `stems` that the results of `runs` do not name: the runs were interrupted after writing
    /// them and before they were recorded.
    ///
    /// # Errors
    /// [`JournalError`] if a result cannot be read: all files stay then.
    pub fn remove_unnamed(&self, stems: &[String], runs: &dyn Runs) -> Result<(), JournalError> {
        let mut named = HashSet::new();
        for run in runs.each() {
            named.extend(run?.into_owned().files);
        }
        for name in left_by(stems).filter(|name| !named.contains(name)) {
            // Most were never there.
            fs::remove_file(self.path.join(name)).ok();
        }
        Ok(())
    }
}

/// Beginning of the heading of a table written by `sweep`.
const HEADING: &str = "point,engine,";

/// True if the file at `path` is a table written by `sweep`, judging by its heading.
///
/// # Errors
/// Errors of the operating system.
pub fn is_table_of_a_sweep(path: &Path) -> io::Result<bool> {
    let mut start = Vec::new();
    servobench_files::open(path, u64::MAX)?.take(HEADING.len() as u64).read_to_end(&mut start)?;
    Ok(start == HEADING.as_bytes())
}

/// Removes incomplete files of killed programs: no other process writes into a locked folder.
fn remove_unfinished(folder: &Path) {
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        if unfinished_by(&entry.file_name().to_string_lossy()).is_some() {
            // A leftover only takes space.
            fs::remove_file(entry.path()).ok();
        }
    }
}

/// All files that runs with these stems may have left.
fn left_by(stems: &[String]) -> impl Iterator<Item = String> {
    let names = stems.iter().flat_map(|stem| KINDS.iter().map(move |kind| format!("{stem}{kind}")));
    names.filter(|name| is_left_by_a_run(name))
}

/// True if `name` is a file beside the list, of a kind that a run leaves: a list may come from anywhere.
pub(crate) fn is_left_by_a_run(name: &str) -> bool {
    let path = Path::new(name);
    let is_beside = path.file_name() == Some(OsStr::new(name)) && !name.contains(['/', '\\']);
    is_beside && path.extension().is_some_and(|kind| kind == "parquet" || kind == "rrd" || kind == "svg")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::digest::Digest;
    use crate::journal::{Finished, Journal, Suite};
    use crate::results::Results;
    use crate::samples;

    fn names(folder: &Path) -> Vec<String> {
        let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap());
        let mut names: Vec<_> = entries.collect();
        names.sort();
        names
    }

    #[test]
    fn one_at_a_time_writes_into_a_folder() {
        let there = tempfile::tempdir().unwrap();
        let path = there.path().join("out");
        let first = Folder::open(&path).unwrap();
        let refusal = Folder::open(&path).unwrap_err().to_string();
        assert!(refusal.starts_with("another servobench writes into `") && refusal.contains("--out"), "{refusal}");
        // The same folder by another path.
        std::os::unix::fs::symlink(&path, there.path().join("link")).unwrap();
        assert!(matches!(Folder::open(&there.path().join("link")), Err(FolderError::InUse(_))));
        drop(first);
        Folder::open(&path).unwrap();
    }

    #[test]
    fn exactly_what_is_listed_is_removed() {
        let there = tempfile::tempdir().unwrap();
        let folder = Folder::open(there.path()).unwrap();
        let mut run = samples::jerk();
        run.files = ["a.parquet", "a.timing.svg", "../a.parquet", "notes.txt"].map(String::from).to_vec();
        fs::write(there.path().join(RESULTS), Results::new(vec![run]).to_json().unwrap()).unwrap();
        for name in ["a.parquet", "a.timing.svg", "notes.txt", "b.parquet"] {
            fs::write(there.path().join(name), "").unwrap();
        }
        let former = folder.former(RESULTS).unwrap();
        assert_eq!(folder.remove(&former), 2);
        assert_eq!(names(there.path()), ["b.parquet", "notes.txt"]);
    }

    /// Leftovers of a killed suite: the files named in its journal, and those written just before they could be.
    #[test]
    fn what_a_killed_suite_left_is_removed() {
        let there = tempfile::tempdir().unwrap();
        let folder = Folder::open(there.path()).unwrap();
        let stems = vec!["a.exact".to_owned(), "../b".to_owned()];
        let suite = Suite::new(Digest::default(), vec![], there.path().to_owned(), None, stems);
        let mut journal = Journal::create(folder.journal(), &suite).unwrap();
        journal.append(&Finished { index: 0, seconds: 0.0, result: samples::jerk() }).unwrap();
        for name in ["a.exact.parquet", "a.exact.rrd", "other.parquet"] {
            fs::write(there.path().join(name), "").unwrap();
        }
        let former = folder.former(RESULTS).unwrap();
        assert_eq!(folder.remove(&former), 2);
        assert_eq!(names(there.path()), ["other.parquet"]);
    }

    #[test]
    fn what_is_none_of_ours_stays() {
        let there = tempfile::tempdir().unwrap();
        let folder = Folder::open(there.path()).unwrap();
        fs::write(there.path().join(RESULTS), "{}").unwrap();
        let refusal = folder.former(RESULTS).unwrap_err().to_string();
        assert!(refusal.contains("results.json` is no list of results") && refusal.contains("--out"), "{refusal}");
        assert!(folder.former(COMPARISON).is_ok());
        assert_eq!(names(there.path()), [RESULTS]);
    }

    #[test]
    fn only_files_beside_the_list_are_ever_removed() {
        for name in ["a.exact.parquet", "a.exact.rrd", "a.exact.timing.svg", "-a.parquet", "a b.parquet"] {
            assert!(is_left_by_a_run(name), "{name}");
        }
        for name in ["../a.parquet", "/a.parquet", "b/a.parquet", "..", "", ".", "a.toml", "results.json", "a\\b.rrd"] {
            assert!(!is_left_by_a_run(name), "{name}");
        }
    }
}
