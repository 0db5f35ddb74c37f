//! `servobench view`: opens a recording in the Rerun viewer.
use crate::args::ViewArgs;
use crate::error::CliError;
use crate::exit::Exit;
use crate::output;
use crate::outputs::{Outputs, is_name, reads};
use crate::view_program::ViewProgram;
use servobench_results::{COMPARISON, RESULTS, Results, RunResult, read_results};
use servobench_trace::seal_of;
use servobench_view_request::{Request, Verdict, ViewOptions};
use std::ffi::OsStr;
use std::io;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::SystemTime;

/// Opens a recording in the installed viewer, or in the one that `cargo xtask viewer` fetched.
pub(crate) fn view(args: &ViewArgs) -> Result<Exit, CliError> {
    let recordings = recordings(&args.recording)?;
    let viewer = viewer().ok_or(CliError::NoViewer)?;
    let status = Command::new(&viewer).args(&recordings).status();
    let status = status.map_err(|error| CliError::StartViewer { viewer, error })?;
    if status.success() { Ok(Exit::Passed) } else { Err(CliError::ViewerEnded(status)) }
}

/// The `.rrd` files of `path`: a recording, or those that the results in a folder name.
fn recordings(path: &Path) -> Result<Vec<PathBuf>, CliError> {
    if !path.is_dir() {
        return Ok(vec![as_rrd(path)?]);
    }
    let results = latest_results(path)?;
    let text = read_results(&results).map_err(|error| CliError::Read { path: results.clone(), error })?;
    let results = Results::from_json(&text).map_err(|error| CliError::ReadResults { path: results, error })?;
    for name in results.scenarios.iter().filter_map(|run| run.recording.as_deref()) {
        is_name(name)?;
    }
    if let Some(other) = results.scenarios.iter().find(|run| !is_own(run, path)) {
        return Err(CliError::OtherRecording(path.join(other.recording.as_deref().unwrap_or_default())));
    }
    let mut names: Vec<String> = results.scenarios.into_iter().filter_map(|run| run.recording).collect();
    // All runs of a comparison lie in one recording.
    names.dedup();
    if names.is_empty() {
        return Err(CliError::NoRecording { folder: path.to_owned() });
    }
    names.iter().map(|name| as_rrd(&path.join(name))).collect()
}

/// False if the seal of the recording in `folder` differs from that in `run`.
fn is_own(run: &RunResult, folder: &Path) -> bool {
    let Some((name, seal)) = run.recording.as_ref().zip(run.recording_seal.as_ref()) else { return true };
    // An unreadable one is reported by its reader.
    seal_of(folder.join(name)).map_or(true, |found| found.as_ref() == Some(seal))
}

/// The latest results that `run` or `compare` wrote into `folder`.
pub(super) fn latest_results(folder: &Path) -> Result<PathBuf, CliError> {
    let files = [RESULTS, COMPARISON].map(|name| folder.join(name));
    let written = files.into_iter().filter_map(|file| Some((modified(&file).ok()?, file)));
    let latest = written.max_by_key(|(when, _)| *when).map(|(_, file)| file);
    latest.ok_or_else(|| CliError::NoResults { folder: folder.to_owned() })
}

/// The recording for the viewer: the `.rrd` made from a Parquet file, or a new one when that is older.
fn as_rrd(path: &Path) -> Result<PathBuf, CliError> {
    let written = modified(path).map_err(|error| CliError::Read { path: path.to_owned(), error })?;
    if path.extension() != Some(OsStr::new("parquet")) {
        return Ok(path.to_owned());
    }
    let rrd = path.with_extension("rrd");
    if !modified(&rrd).is_ok_and(|made| made >= written) {
        reads(path, "the recording");
        let output = Outputs::default().file("the recording for the viewer", &rrd)?;
        let verdicts = verdict_beside(path).into_iter().collect();
        let options = ViewOptions { verdicts, ..ViewOptions::default() };
        ViewProgram::find()?.draw(&[path], &Request { labels: Vec::new(), options }, &output)?;
    }
    Ok(rrd)
}

/// Verdict on the run of the recording at `path`, from the results beside it; `None` without results or for another run.
fn verdict_beside(path: &Path) -> Option<Verdict> {
    let results = Results::from_json(&read_results(&path.with_file_name(RESULTS)).ok()?).ok()?;
    let (name, seal) = (path.file_name()?.to_str()?, seal_of(path).ok()??);
    let is_of = |run: &RunResult| run.recording.as_deref() == Some(name) && run.recording_seal.as_ref() == Some(&seal);
    let run = results.scenarios.into_iter().find(is_of)?;
    Some(output::said_of(run.verdict, run.reasons, run.warnings))
}

/// Time of the last write to the file.
fn modified(path: &Path) -> io::Result<SystemTime> {
    std::fs::metadata(path)?.modified()
}

/// The viewer on the search path, or the one that `cargo xtask viewer` put beside the build.
fn viewer() -> Option<PathBuf> {
    let name = format!("rerun{}", std::env::consts::EXE_SUFFIX);
    let on_path = std::env::var_os("PATH")
        .into_iter()
        .flat_map(|paths| std::env::split_paths(&paths).collect::<Vec<_>>())
        .map(|folder| folder.join(&name));
    let fetched = std::env::current_exe()
        .ok()
        .into_iter()
        .flat_map(|exe| exe.ancestors().skip(1).take(3).map(Path::to_owned).collect::<Vec<_>>())
        .map(|folder| folder.join("viewer").join("bin").join(&name));
    on_path.chain(fetched).find(|candidate| candidate.is_file())
}

#[cfg(test)]
mod tests {
    use super::*;
    use servobench_base::Rate;
    use servobench_metrics::Metrics;
    use servobench_results::RunIdentity;
    use servobench_trace::{About, Channel, ChannelSpec, Recording};
    use servobench_view_request::Outcome;

    /// A run of so many rows at 10 Hz.
    fn recording(rows: usize) -> Recording {
        let about = About {
            scenario: "slide".into(),
            engine: "exact".into(),
            axis_unit: "m".into(),
            bodies: vec![],
            overrides: vec![],
        };
        let rate = Rate::new(10).unwrap();
        let mut recording = Recording::new(about, rate);
        let spec = ChannelSpec {
            axis: None,
            name: "load.position".into(),
            unit: "m".into(),
            writer: "mechanics".into(),
            rate,
        };
        recording.channels.push(Channel { spec, values: vec![0.0; rows].into() });
        recording
    }

    #[test]
    fn a_stored_recording_has_the_verdict_of_the_results_beside_it_that_are_of_its_run() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("slide.exact.parquet");
        let own = recording(11);
        own.write_parquet(&path).unwrap();
        assert_eq!(verdict_beside(&path), None, "no results");
        let identity = RunIdentity {
            name: "slide".into(),
            engine: "exact".into(),
            recording: Some("slide.exact.parquet".into()),
            recording_seal: seal_of(&path).unwrap(),
            ..RunIdentity::default()
        };
        let run = RunResult::error(identity, Some((&own, &Metrics::default())), vec!["it broke".into()]);
        let results = Results::new(vec![run]).to_json().unwrap();
        std::fs::write(folder.path().join(RESULTS), results).unwrap();
        let verdict = verdict_beside(&path).unwrap();
        assert_eq!((verdict.outcome, verdict.reasons), (Outcome::Failed, vec!["it broke".to_owned()]));
        // Drawn already.
        std::fs::write(path.with_extension("rrd"), "drawn").unwrap();
        assert_eq!(recordings(folder.path()).unwrap(), [path.with_extension("rrd")]);
        let other = folder.path().join("other.parquet");
        own.write_parquet(&other).unwrap();
        assert_eq!(verdict_beside(&other), None, "the results do not name it");
        // At any age: the time of a file does not identify its run.
        recording(12).write_parquet(&path).unwrap();
        assert_eq!(verdict_beside(&path), None, "another run");
        let refusal = recordings(folder.path()).unwrap_err().to_string();
        assert!(refusal.contains("slide.exact.parquet` is the recording of another run"), "{refusal}");
    }
}
