//! `--resume` of a complete suite: shows its report again if inputs and files are unchanged.
use super::held::{changed_files, changed_inputs};
use crate::error::CliError;
use servobench_results::{RESULTS, Results, Status, read_results};
use std::path::Path;

/// Differences that are listed.
const MOST: usize = 10;

/// Results of a complete suite in `folder`, checked against the present scenarios, files, program and recordings. Files that scenarios
/// name may be below `root`.
pub(super) fn complete(folder: &Path, root: Option<&Path>) -> Result<Results, CliError> {
    let path = folder.join(RESULTS);
    let nothing = || CliError::NothingToResume(folder.to_owned());
    // A link would lead to results of another folder.
    let is_there = path.symlink_metadata().is_ok_and(|found| found.is_file());
    let text = is_there.then(|| read_results(&path).ok()).flatten().ok_or_else(nothing)?;
    let unread = |error| CliError::ReadResults { path: path.clone(), error };
    let results = Results::from_json(&text).map_err(unread)?;
    if results.status != Status::Complete {
        return Err(nothing());
    }
    let mut found: Vec<String> = Vec::new();
    let mut note = |what: String| {
        if !found.contains(&what) {
            found.push(what);
        }
    };
    if let Err(error) = Results::from_sealed_json(&text) {
        note(format!("`{RESULTS}`: {error}"));
    }
    for run in &results.scenarios {
        changed_inputs(run, root).into_iter().for_each(&mut note);
        changed_files(folder, run).into_iter().for_each(&mut note);
    }
    if found.is_empty() {
        Ok(results)
    } else {
        Err(CliError::NotOfToday { folder: folder.to_owned(), found: listed(found) })
    }
}

/// The first [`MOST`] of `all`, and the number of others.
pub(super) fn listed(mut all: Vec<String>) -> Vec<String> {
    let more = all.len().saturating_sub(MOST);
    if more > 0 {
        all.truncate(MOST);
        all.push(format!("and {more} more"));
    }
    all
}
