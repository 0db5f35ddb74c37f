//! `results.json` while its runs are read, one after the other.
use crate::digest::Digest;
use crate::error::ResultsError;
use crate::journal::JournalError;
use crate::results::Results;
use crate::runs::Runs;
use serde::ser::SerializeSeq as _;
use serde::{Serialize, Serializer};
use std::cell::RefCell;
use std::io::Write;

/// The results of runs that are read while they are written.
struct OneByOne<'a> {
    runs: &'a dyn Runs,
    /// Why a run could not be read.
    refusal: RefCell<Option<JournalError>>,
}

impl Serialize for &OneByOne<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut all = serializer.serialize_seq(None)?;
        for run in self.runs.each() {
            match run {
                Ok(run) => all.serialize_element(&*run)?,
                Err(error) => {
                    let words = error.to_string();
                    self.refusal.replace(Some(error));
                    return Err(serde::ser::Error::custom(words));
                }
            }
        }
        all.end()
    }
}

/// Writes what came of `runs`, those of `suite`, as [`Results::to_json`] does it.
///
/// # Errors
/// [`ResultsError::Journal`] when a run cannot be read, [`ResultsError::Write`].
pub fn write_results(suite: &Digest, runs: &dyn Runs, out: &mut dyn Write) -> Result<(), ResultsError> {
    let each = OneByOne { runs, refusal: RefCell::new(None) };
    let written =
        serde_json::to_writer_pretty(&mut *out, &Results::of_suite(*suite, &each, runs.unfinished().collect()));
    match (written, each.refusal.into_inner()) {
        (_, Some(refusal)) => Err(refusal.into()),
        (Err(error), None) if error.is_io() => Err(ResultsError::Write(error.into())),
        (Err(error), None) => Err(error.into()),
        (Ok(()), None) => out.write_all(b"\n").map_err(ResultsError::Write),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::{Status, Unfinished};
    use crate::samples;

    /// Whoever writes results one by one writes the same bytes.
    #[test]
    fn written_one_by_one_they_are_the_same() {
        let mut results = samples::results();
        results.unfinished = vec![Unfinished { name: "last".into(), file: None, engine: "exact".into() }];
        results.status = Status::Incomplete;
        results.suite = Digest::of(b"suite");
        let mut written = Vec::new();
        write_results(&results.suite, &results, &mut written).unwrap();
        assert_eq!(String::from_utf8(written).unwrap(), results.to_json().unwrap());
        let nowhere = write_results(&results.suite, &results, &mut &mut [0; 100][..]);
        assert!(matches!(nowhere, Err(ResultsError::Write(_))), "{nowhere:?}");
    }
}
