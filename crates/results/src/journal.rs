//! The journal: the result of each run, written when the run has ended.
//!
//! ```text
//! <digest> {"suite":{…}}
//! <digest> {"finished":{"index":0,"seconds":0.25,"result":{…}}}
//! …
//! ```
//! A line holds one record as JSON, after the XXH64 (seed 0) of that JSON as 16 hexadecimal digits. A line is appended by one
//! system call, so that the end of the process, in whatever way, neither loses nor damages a written record.
//! A crash of the machine may: the journal is synced to disk when it is begun, with a record at most once in
//! [`PERIOD`], and when the suite ends.
//!
//! Reading keeps intact lines: a torn or damaged line counts as a run that has not ended.
use crate::digest::Digest;
use crate::folder::is_left_by_a_run;
use crate::run::RunResult;
use serde::{Deserialize, Serialize};
use servobench_files::named;
use std::fs::File;
use std::io::{self, BufRead, BufReader, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};
use thiserror::Error;
use twox_hash::XxHash64;

/// Longest time between syncs to disk, as long as records follow.
const PERIOD: Duration = Duration::from_secs(1);
/// Bytes of the longest line read.
const LONGEST: u64 = 1 << 26;
/// Version of the format.
const VERSION: u32 = 1;

/// The first record: description of the suite.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Suite {
    /// Version of the journal's format.
    pub version: u32,
    /// Value of [`crate::Results::suite`] in the results.
    pub suite: Digest,
    /// Digest of the program that began it; empty if unknown.
    #[serde(default)]
    pub program: Digest,
    /// The command line without the program's name.
    pub command: Vec<String>,
    /// Folder to which relative paths of the command line refer.
    pub folder: PathBuf,
    /// Text from standard input, if a scenario was read there.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub standard_input: Option<String>,
    /// Stems of the files that the runs may leave in the folder of the journal.
    pub stems: Vec<String>,
}

impl Suite {
    /// A suite of this version.
    #[must_use]
    pub fn new(
        suite: Digest,
        command: Vec<String>,
        folder: PathBuf,
        standard_input: Option<String>,
        stems: Vec<String>,
    ) -> Self {
        Self { version: VERSION, suite, program: Digest::default(), command, folder, standard_input, stems }
    }

    /// Sets the digest of the program that began the suite.
    #[must_use]
    pub fn by(self, program: Digest) -> Self {
        Self { program, ..self }
    }

    /// The first name that is not that of a file beside the journal.
    fn outside(&self) -> Option<String> {
        self.stems.iter().find(|stem| !is_left_by_a_run(&format!("{stem}.parquet"))).cloned()
    }
}

/// A finished run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Finished {
    /// Place of the run in the suite, from 0.
    pub index: usize,
    /// Wall-clock duration (s).
    pub seconds: f64,
    /// Result of the run.
    pub result: RunResult,
}

impl Finished {
    /// The first file name of the run that is not beside the journal, or not of a kind that runs leave.
    fn outside(&self) -> Option<String> {
        let RunResult { recording, files, .. } = &self.result;
        recording.iter().chain(files).find(|name| !is_left_by_a_run(name)).cloned()
    }
}

/// A record to be written.
#[derive(Serialize)]
#[serde(rename_all = "lowercase")]
enum Written<'a> {
    Suite(&'a Suite),
    Finished(&'a Finished),
}

/// A record that was read.
#[derive(Deserialize)]
#[serde(rename_all = "lowercase")]
enum Record {
    Suite(Suite),
    Finished(Box<Finished>),
}

/// Reasons why a journal cannot be used.
#[derive(Debug, Error)]
pub enum JournalError {
    /// Error of the operating system.
    #[error("cannot {action} the journal `{}`: {source}", path.display())]
    Io {
        /// Attempted action.
        action: &'static str,
        /// The journal.
        path: PathBuf,
        /// Error of the system.
        source: io::Error,
    },
    /// A record is not JSON.
    #[error("a result cannot be written into the journal: {0}")]
    Json(#[from] serde_json::Error),
    /// The first line is not that of a journal.
    #[error("`{}` is no journal of a suite: its first line is damaged", .0.display())]
    NoSuite(PathBuf),
    /// The journal is of a later version.
    #[error("the journal `{}` has version {found}, newer than this build, which reads version {VERSION}", path.display())]
    Newer {
        /// The journal.
        path: PathBuf,
        /// Its version.
        found: u32,
    },
    /// The journal is a link: records would be appended to another file.
    #[error("the journal `{}` is a link to another file and is not resumed: run the scenarios again in another folder", .0.display())]
    Link(PathBuf),
    /// The journal names a file that no run leaves beside it.
    #[error(
        "the journal `{}` names `{}`, which no run leaves beside it, and is not resumed: it is not as servobench wrote it; run the \
         scenarios again in another folder", path.display(), named(name)
    )]
    Outside {
        /// The journal.
        path: PathBuf,
        /// The name.
        name: String,
    },
    /// A record has changed since it was written.
    #[error("the record of a run in the journal `{}` has changed since it was written: is the disk in order?", .0.display())]
    Changed(PathBuf),
    /// The run has no result.
    #[error("there is no result of run {0}")]
    NoSuchRun(usize),
}

/// Place of a record in the journal.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Place {
    /// Bytes before its line.
    start: u64,
    /// Bytes of its line.
    length: u64,
}

/// The journal of a running suite.
#[derive(Debug)]
pub struct Journal {
    file: File,
    path: PathBuf,
    /// Time of the last sync.
    synced: Instant,
    /// True if the last line is torn: the next record begins a new line.
    is_torn: bool,
}

impl Journal {
    /// Begins the journal of `suite` at `path`, replacing an existing one.
    ///
    /// # Errors
    /// [`JournalError::Io`]
    pub fn create(path: PathBuf, suite: &Suite) -> Result<Self, JournalError> {
        // An existing file may be a planted link: it is removed, and nothing is written to its target.
        std::fs::remove_file(&path).or_else(not_found).map_err(failed("begin", &path))?;
        let file = File::options().create_new(true).read(true).write(true).open(&path);
        let file = file.map_err(failed("begin", &path))?;
        let mut journal = Self { file, path, synced: Instant::now(), is_torn: false };
        journal.write(&Written::Suite(suite))?;
        journal.sync()?;
        Ok(journal)
    }

    /// Continues the journal at `path`; returns its suite. `each` gets the finished runs with the places of their records;
    /// of several records of one run the last one counts. A journal may come from anywhere: one that is a link, or that names a file
    /// outside of its folder, is refused, and `each` gets none of its runs from there on.
    ///
    /// # Errors
    /// [`JournalError`]
    pub fn resume(path: PathBuf, mut each: impl FnMut(Finished, Place)) -> Result<(Self, Suite), JournalError> {
        if std::fs::symlink_metadata(&path).map_err(failed("read", &path))?.is_symlink() {
            return Err(JournalError::Link(path));
        }
        // A FIFO of that name would block its reader.
        servobench_files::metadata(&path, u64::MAX).map_err(failed("read", &path))?;
        let mut file = File::options().read(true).write(true).open(&path).map_err(failed("read", &path))?;
        let mut outside = None;
        let suite = read(&file, &path, |finished, place| {
            outside = outside.take().or_else(|| finished.outside());
            if outside.is_none() {
                each(finished, place);
            }
        })?;
        if let Some(name) = suite.outside().or(outside) {
            return Err(JournalError::Outside { path, name });
        }
        let length = file.seek(SeekFrom::End(0)).map_err(failed("read", &path))?;
        // An empty line is not a record, so a complete last line does no harm.
        Ok((Self { file, path, synced: Instant::now(), is_torn: length > 0 }, suite))
    }

    /// Appends the record of a finished run; returns its place.
    ///
    /// # Errors
    /// [`JournalError::Io`], [`JournalError::Json`]: then only this record is missing.
    pub fn append(&mut self, finished: &Finished) -> Result<Place, JournalError> {
        let place = self.write(&Written::Finished(finished))?;
        if self.synced.elapsed() >= PERIOD {
            self.sync()?;
        }
        Ok(place)
    }

    /// The record at `place`.
    ///
    /// # Errors
    /// [`JournalError::Io`], [`JournalError::Changed`]
    pub fn at(&self, place: Place) -> Result<Finished, JournalError> {
        let mut file = &self.file;
        file.seek(SeekFrom::Start(place.start)).map_err(failed("read", &self.path))?;
        let mut line = Vec::new();
        file.take(place.length).read_to_end(&mut line).map_err(failed("read", &self.path))?;
        match record(&line) {
            Some(Record::Finished(finished)) => Ok(*finished),
            Some(Record::Suite(_)) | None => Err(JournalError::Changed(self.path.clone())),
        }
    }

    /// Syncs the journal to disk.
    ///
    /// # Errors
    /// [`JournalError::Io`]
    pub fn sync(&mut self) -> Result<(), JournalError> {
        self.file.sync_data().map_err(failed("write", &self.path))?;
        self.synced = Instant::now();
        Ok(())
    }

    /// Replaces the file of the journal.
    #[cfg(test)]
    pub(crate) fn on(mut self, path: &str) -> Self {
        self.file = File::options().read(true).write(true).open(path).unwrap();
        self
    }

    fn write(&mut self, record: &Written<'_>) -> Result<Place, JournalError> {
        let json = serde_json::to_string(record)?;
        let start = if self.is_torn { "\n" } else { "" };
        let line = format!("{start}{:016x} {json}\n", digest(&json));
        self.is_torn = true;
        // Reading has moved away from the end, and a torn write may have left a part of itself.
        let end = self.file.seek(SeekFrom::End(0)).map_err(failed("write", &self.path))?;
        self.file.write_all(line.as_bytes()).map_err(failed("write", &self.path))?;
        self.is_torn = false;
        let start = start.len() as u64;
        Ok(Place { start: end + start, length: line.len() as u64 - start })
    }
}

/// The suite of the journal `file`, with `path` for messages. `each` is called as by [`Journal::resume`].
///
/// # Errors
/// [`JournalError`]
pub fn read(file: impl Read, path: &Path, mut each: impl FnMut(Finished, Place)) -> Result<Suite, JournalError> {
    let mut lines = Lines { source: BufReader::new(file), path, read: 0 };
    let Some((Some(Record::Suite(suite)), _)) = lines.next()? else {
        return Err(JournalError::NoSuite(path.to_owned()));
    };
    if suite.version > VERSION {
        return Err(JournalError::Newer { path: path.to_owned(), found: suite.version });
    }
    while let Some((line, place)) = lines.next()? {
        if let Some(Record::Finished(finished)) = line {
            each(*finished, place);
        }
    }
    Ok(suite)
}

struct Lines<'a, R> {
    source: BufReader<R>,
    path: &'a Path,
    /// Bytes before the next line.
    read: u64,
}

impl<R: Read> Lines<'_, R> {
    /// The record in the next line, if it is intact, and its place; `None` at the end.
    fn next(&mut self) -> Result<Option<(Option<Record>, Place)>, JournalError> {
        let mut line = Vec::new();
        let mut limited = (&mut self.source).take(LONGEST);
        limited.read_until(b'\n', &mut line).map_err(failed("read", self.path))?;
        let place = Place { start: self.read, length: line.len() as u64 };
        self.read += place.length;
        Ok((!line.is_empty()).then(|| (record(&line), place)))
    }
}

/// The record in `line`, if it is intact.
fn record(line: &[u8]) -> Option<Record> {
    let line = str::from_utf8(line).ok()?.strip_suffix('\n')?;
    let (found, json) = line.split_at_checked(16)?;
    let json = json.strip_prefix(' ')?;
    (found == format!("{:016x}", digest(json))).then(|| serde_json::from_str(json).ok())?
}

fn digest(json: &str) -> u64 {
    XxHash64::oneshot(0, json.as_bytes())
}

/// A missing file need not be removed.
fn not_found(error: io::Error) -> io::Result<()> {
    if error.kind() == io::ErrorKind::NotFound { Ok(()) } else { Err(error) }
}

fn failed(action: &'static str, path: &Path) -> impl FnOnce(io::Error) -> JournalError {
    move |source| JournalError::Io { action, path: path.to_owned(), source }
}

#[cfg(test)]
mod tests;
