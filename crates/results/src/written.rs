//! Output of `results.json` while its runs are read, one after the other, with the digest that reveals edits.
use crate::digest::{Digest, Digester};
use crate::error::ResultsError;
use crate::journal::JournalError;
use crate::results::{Results, Unfinished};
use crate::run::RunResult;
use crate::runs::Runs;
use serde::ser::{Error as _, SerializeSeq as _};
use serde::{Serialize, Serializer};
use std::cell::RefCell;
use std::io::Write;

/// Results followed by their digest, which is computed while the runs are written.
#[derive(Serialize)]
struct Sealed<'a, R: Serialize> {
    #[serde(flatten)]
    results: Results<R, &'a Unfinished>,
    digest: Sum<'a>,
}

/// The digest of the parts written so far.
struct Sum<'a>(&'a RefCell<Digester>);

impl Serialize for Sum<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.0.borrow().clone().finish().serialize(serializer)
    }
}

/// The digest of results begins with the parts that do not depend on the finished runs.
fn begun(suite: &Digest, unfinished: &[&Unfinished]) -> Result<Digester, serde_json::Error> {
    let start = Digester::default().with(suite.to_string());
    unfinished.iter().try_fold(start, |digester, run| Ok(digester.with(serde_json::to_vec(run)?)))
}

/// The digest of a file of these results: of the suite, the unfinished runs, and the finished ones, each as JSON.
pub(crate) fn digest_of(results: &Results) -> Result<Digest, ResultsError> {
    let begun = begun(&results.suite, &results.unfinished.iter().collect::<Vec<_>>())?;
    let all = results.scenarios.iter().try_fold(begun, |digester, run| Ok(digester.with(serde_json::to_vec(run)?)));
    Ok(all.map_err(ResultsError::Json)?.finish())
}

/// The results of runs, each read when it is written.
struct OneByOne<'a> {
    runs: &'a dyn Runs,
    /// Error of a run that could not be read.
    refusal: RefCell<Option<JournalError>>,
    digester: &'a RefCell<Digester>,
}

impl Serialize for &OneByOne<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut all = serializer.serialize_seq(None)?;
        for run in self.runs.each() {
            match run {
                Ok(run) => {
                    let run: &RunResult = &run;
                    let json = serde_json::to_vec(run).map_err(S::Error::custom)?;
                    self.digester.replace_with(|digester| std::mem::take(digester).with(json));
                    all.serialize_element(run)?;
                }
                Err(error) => {
                    let words = error.to_string();
                    self.refusal.replace(Some(error));
                    return Err(S::Error::custom(words));
                }
            }
        }
        all.end()
    }
}

/// Writes the results of `runs`, which belong to `suite`, as [`Results::to_json`] does.
///
/// # Errors
/// [`ResultsError::Journal`] if a run cannot be read, [`ResultsError::Write`].
pub fn write_results(suite: &Digest, runs: &dyn Runs, out: &mut dyn Write) -> Result<(), ResultsError> {
    let unfinished: Vec<&Unfinished> = runs.unfinished().collect();
    let digester = RefCell::new(begun(suite, &unfinished)?);
    let each = OneByOne { runs, refusal: RefCell::new(None), digester: &digester };
    let results = Results::of_suite(*suite, &each, unfinished);
    let written = serde_json::to_writer_pretty(&mut *out, &Sealed { results, digest: Sum(&digester) });
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

    /// Results written one by one give the same bytes.
    #[test]
    fn written_one_by_one_they_are_the_same() {
        let mut results = samples::results();
        results.unfinished = vec![Unfinished { name: "last".into(), file: None, engine: "exact".into(), axis: None }];
        results.status = Status::Incomplete;
        results.suite = Digest::of(b"suite");
        let mut written = Vec::new();
        write_results(&results.suite, &results, &mut written).unwrap();
        assert_eq!(String::from_utf8(written).unwrap(), results.to_json().unwrap());
        let nowhere = write_results(&results.suite, &results, &mut &mut [0; 100][..]);
        assert!(matches!(nowhere, Err(ResultsError::Write(_))), "{nowhere:?}");
    }
}
