//! What a command leaves on the disk: recordings, results, diagrams, reports. Each file is there whole or not at all.
use crate::console::print;
use crate::exit::CliError;
use jiff::Timestamp;
use servobench_report::{Results, RunIdentity, TimingOptions, timing_diagram};
use servobench_scenario::Scenario;
use servobench_suite::{Job, channel_limits};
use servobench_trace::Recording;
use servobench_view::ViewOptions;
use std::collections::HashSet;
use std::ffi::OsStr;
use std::fmt::Display;
use std::path::Path;

/// What `run` leaves beside its recordings.
pub(crate) const RESULTS: &str = "results.json";
/// What `compare` leaves beside its recording.
pub(crate) const COMPARISON: &str = "comparison.json";

/// Makes the folder for everything.
pub(crate) fn make_folder(folder: &Path) -> Result<(), CliError> {
    std::fs::create_dir_all(folder)
        .map_err(|error| CliError::Run(format!("cannot make the folder `{}`: {error}", folder.display())))
}

/// Writes the whole file or nothing.
pub(crate) fn write_file(path: &Path, text: impl AsRef<[u8]>) -> Result<(), CliError> {
    servobench_trace::write_whole(path, text)
        .map_err(|error| CliError::Run(format!("cannot write `{}`: {error}", path.display())))
}

/// Refuses to write over `input`, which the output is made of.
pub(crate) fn spares(input: &Path, output: Option<&Path>) -> Result<(), CliError> {
    let place = |path: &Path| path.canonicalize().ok();
    match output {
        Some(output) if place(output).is_some() && place(output) == place(input) => Err(CliError::Input(format!(
            "-o: `{}` is what is read here and would be lost; name another file",
            output.display()
        ))),
        _ => Ok(()),
    }
}

/// Writes the whole file or nothing; without a path to standard output.
pub(crate) fn print_or_write(path: Option<&Path>, text: &str) -> Result<(), CliError> {
    path.map_or_else(|| print(text), |path| write_file(path, text))
}

/// When a file that says so was written: now, or at the time that the build asks for, by the convention of reproducible
/// builds (<https://reproducible-builds.org/specs/source-date-epoch/>).
pub(crate) fn write_time() -> Result<Timestamp, CliError> {
    let Some(told) = std::env::var_os("SOURCE_DATE_EPOCH") else { return Ok(Timestamp::now()) };
    let seconds = told.to_str().and_then(|text| text.parse().ok());
    seconds.and_then(|seconds| Timestamp::from_second(seconds).ok()).ok_or_else(|| {
        CliError::Input(format!(
            "the variable SOURCE_DATE_EPOCH is `{}`; it is a number of seconds since 1970, or unset",
            told.display()
        ))
    })
}

/// Writes the recording of `job` into `folder`, and returns its name. Beside it goes its timing diagram where it has
/// signals, and when `rrd` says so the recording for the Rerun viewer.
pub(crate) fn write_recording(job: &Job, recording: &Recording, folder: &Path, rrd: bool) -> Result<String, CliError> {
    let name = format!("{}.parquet", job.id);
    let failed = |error: &dyn Display| CliError::Run(error.to_string());
    recording.write_parquet(folder.join(&name)).map_err(|error| failed(&error))?;
    if !recording.signals.is_empty() {
        let diagram = timing_diagram(recording, &TimingOptions::default()).map_err(|error| failed(&error))?;
        write_file(&folder.join(format!("{}.timing.svg", job.id)), &diagram)?;
    }
    if rrd {
        let path = folder.join(format!("{}.rrd", job.id));
        servobench_view::write_rrd(recording, path, &view_options(&job.scenario)).map_err(|error| failed(&error))?;
    }
    Ok(name)
}

/// How many recordings in `folder` neither `results` nor the comparison beside them name. A folder that cannot be read
/// is said to hold none.
pub(crate) fn older_recordings(folder: &Path, results: &Results) -> usize {
    let comparison = std::fs::read_to_string(folder.join(COMPARISON)).ok();
    let comparison = comparison.and_then(|text| Results::from_json(&text).ok());
    let stem = |path: &Path| path.file_stem().map(OsStr::to_owned);
    let runs = results.scenarios.iter().chain(comparison.iter().flat_map(|comparison| &comparison.scenarios));
    let named: HashSet<_> = runs.filter_map(|run| stem(run.recording.as_deref()?.as_ref())).collect();
    let is_recording = |path: &Path| path.extension().is_some_and(|kind| kind == "parquet" || kind == "rrd");
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path());
    let found: HashSet<_> = entries.filter(|path| is_recording(path)).filter_map(|path| stem(&path)).collect();
    found.difference(&named).count()
}

/// Which run it is, for results; `recording` is the file beside them that holds it.
pub(crate) fn identity(job: &Job, recording: Option<String>) -> RunIdentity {
    RunIdentity {
        name: job.scenario.name.clone(),
        file: job.scenario.path.as_ref().map(|path| path.display().to_string()),
        engine: job.engine.as_str().to_owned(),
        recording,
    }
}

/// What a viewer is told beside the recording: limits and the settling window.
pub(crate) fn view_options(scenario: &Scenario) -> ViewOptions {
    ViewOptions {
        limits: channel_limits(scenario).into_iter().map(|(channel, limit)| (channel.to_owned(), limit)).collect(),
        window: scenario.measure.window,
        residual_from: scenario.measure.from,
        ..ViewOptions::default()
    }
}
