//! Checks of results against their scenarios and files, the program, and the files that the runs left.
use crate::args::OverrideArgs;
use crate::build_id;
use crate::output;
use crate::sources::{self, is_stdin};
use servobench_config::Choice as _;
use servobench_plant::EngineName;
use servobench_results::{Digest, Outcome, RunResult, printable};
use servobench_scenario::{LoadError, Override};
use servobench_suite::{Job, Source};
use servobench_trace::verified_seal_of;
use std::path::{Path, PathBuf};

/// Differences between the inputs of the earlier result `run` and those of the same run now. Files that it names may be below `root`.
pub(crate) fn changed_inputs(run: &RunResult, root: Option<&Path>) -> Vec<String> {
    let name = run.file.as_deref().unwrap_or(&run.name);
    if run.file.as_deref().is_some_and(|file| is_stdin(Path::new(file))) {
        return vec!["a scenario came in on standard input, and is not there again".into()];
    }
    let now = match (again(run, root), run.verdict) {
        // It could not be read before, and cannot for the same reasons now.
        (Err(error), Outcome::Invalid) if sources::reasons(&error) == run.reasons => return Vec::new(),
        (Err(error), _) => {
            let reasons = sources::reasons(&error);
            return vec![format!("`{name}` cannot be used now: {}", reasons.first().map_or("", String::as_str))];
        }
        (Ok(_), Outcome::Invalid) if run.inputs == Digest::default() => {
            return vec![format!("`{name}` could not be used then, and can be now")];
        }
        (Ok(source), _) => source,
    };
    let Some(engine) = EngineName::from_name(&run.engine) else {
        return vec![format!("`{name}` ran on `{}`, which is not an engine of this program", run.engine)];
    };
    let made_of = now.scenario.made_of.clone();
    if output::inputs_of(&Job::new(String::new(), now, engine)) == run.inputs {
        return Vec::new();
    }
    let mut found: Vec<String> = Vec::new();
    for before in &run.made_of {
        match made_of.iter().find(|file| file.path == before.path) {
            Some(file) if file.sha256 == before.sha256 => {}
            Some(_) => found.push(format!("`{}` has changed", before.path)),
            None => found.push(format!("`{}` is not a file of `{name}` any more", before.path)),
        }
    }
    let is_new = |path: &str| run.made_of.iter().all(|before| before.path != path);
    let new = made_of.iter().filter(|file| is_new(&file.path));
    found.extend(new.map(|file| format!("`{}` is a file of `{name}` only now", file.path)));
    if found.is_empty() {
        found.push(format!("the program is another one ({} now)", build_id::program()));
    }
    found
}

/// The scenario of `run` as it is now.
fn again(run: &RunResult, root: Option<&Path>) -> Result<Source, LoadError> {
    let overrides: Vec<Override> = run.overrides.iter().filter_map(|written| written.parse().ok()).collect();
    let with = OverrideArgs { overrides, root: root.map(Path::to_owned) };
    if let Some(file) = &run.file {
        return sources::again(Path::new(file), &with);
    }
    let no_demo = || LoadError::Read { path: PathBuf::from(&run.name), error: std::io::ErrorKind::NotFound.into() };
    sources::demo(&with)?.into_iter().find(|demo| demo.scenario.name == run.name).ok_or_else(no_demo)
}

/// Reason why the files in `folder` are not those that `run` wrote; `None` where they are.
pub(crate) fn changed_files(folder: &Path, run: &RunResult) -> Option<String> {
    let RunResult { recording, recording_seal, files, .. } = run;
    for name in recording.iter().chain(files) {
        // A link would lead to a file of another origin.
        if !folder.join(name).symlink_metadata().is_ok_and(|found| found.is_file()) {
            return Some(format!("`{}` is gone", printable(name)));
        }
    }
    let (name, seal) = recording.as_ref().zip(recording_seal.as_ref())?;
    let is_own = verified_seal_of(folder.join(name)).is_ok_and(|found| found.as_ref() == Some(seal));
    (!is_own).then(|| format!("`{}` is not the recording that was measured", printable(name)))
}
