//! Files of a run in its folder: recording, timing diagram, drawing for the viewer. Each is written whole or not at all.
use crate::args::Keep;
use crate::build_id;
use crate::error::CliError;
use crate::outputs::OutputFolder;
use crate::view_program::ViewProgram;
use jiff::Timestamp;
use servobench::channel_limits;
use servobench_metrics::{Metrics, REQUEST_KIND, Verdict};
use servobench_plant::inverter;
use servobench_plant::pmsm::Bounds;
use servobench_report::{TimingOptions, timing_diagram};
use servobench_results::{
    COMPARISON, Digest, Digester, LimitPlace, Outcome, RunIdentity, RunResult, Runs, Unfinished, files_of_results,
    printable_lines,
};
use servobench_scenario::{Actuator, Parameter, Scenario, Step};
use servobench_suite::Job;
use servobench_trace::{Recording, seal_of};
use servobench_view_request::{self as view, MotorLimits, Request, ViewOptions};
use std::collections::HashSet;
use std::ffi::OsStr;
use std::path::Path;

/// Time of writing stated in files: now, or that of `SOURCE_DATE_EPOCH`, by the convention of reproducible builds
/// (<https://reproducible-builds.org/specs/source-date-epoch/>).
pub(crate) fn write_time() -> Result<Timestamp, CliError> {
    let Some(told) = std::env::var_os("SOURCE_DATE_EPOCH") else { return Ok(Timestamp::now()) };
    let seconds = told.to_str().and_then(|text| text.parse().ok());
    let time = seconds.and_then(|seconds| Timestamp::from_second(seconds).ok());
    time.ok_or(CliError::SourceDateEpoch(told))
}

/// Suffixes of the files of a run.
const RECORDING: &str = ".parquet";
const DIAGRAM: &str = ".timing.svg";
const FOR_THE_VIEWER: &str = ".rrd";

/// The run to which a file called `name` would belong.
pub(crate) fn run_of(name: &str) -> Option<&str> {
    [RECORDING, DIAGRAM, FOR_THE_VIEWER].into_iter().find_map(|end| name.strip_suffix(end))
}

/// Files that a run wrote into its folder.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(crate) struct Written {
    /// Name of the recording.
    pub(crate) recording: Option<String>,
    /// Its seal.
    pub(crate) recording_seal: Option<String>,
    /// Names of all files, including the recording.
    pub(crate) files: Vec<String>,
}

/// Writes the recording of `job` into `folder`, its timing diagram where it has signals and, with a program that draws it, the recording
/// for the Rerun viewer with a verdict.
///
/// # Errors
/// Includes the files written until then.
pub(crate) fn write_recording(
    job: &Job,
    recording: &Recording,
    folder: &OutputFolder,
    drawn: Option<(&ViewProgram, view::Verdict)>,
) -> Result<Written, (Box<CliError>, Written)> {
    let mut written = Written::default();
    let done = write_each(job, recording, folder, drawn, &mut written);
    done.map_err(|error| (Box::new(error), written.clone())).map(|()| written)
}

fn write_each(
    job: &Job,
    recording: &Recording,
    folder: &OutputFolder,
    drawn: Option<(&ViewProgram, view::Verdict)>,
    written: &mut Written,
) -> Result<(), CliError> {
    let name = format!("{}{RECORDING}", job.id);
    let path = folder.place(&name)?;
    recording.write_parquet(&path).map_err(CliError::WriteRecording)?;
    written.recording_seal = seal_of(&path).map_err(|error| CliError::Write { path: path.clone(), error })?;
    written.recording = Some(name.clone());
    written.note(name);
    // A task's requests alone have no edges that are worth a drawing.
    if recording.signals.iter().any(|signal| signal.source != REQUEST_KIND.0) {
        let name = format!("{}{DIAGRAM}", job.id);
        let diagram = timing_diagram(recording, &TimingOptions::default())?;
        folder.file(&name)?.write(&diagram)?;
        written.note(name);
    }
    if let Some((program, verdict)) = drawn {
        let name = format!("{}{FOR_THE_VIEWER}", job.id);
        let options = ViewOptions { verdicts: vec![verdict], ..view_options(&job.scenario) };
        program.draw(&[&path], &Request { labels: Vec::new(), options }, &folder.file(&name)?)?;
        written.note(name);
    }
    Ok(())
}

impl Written {
    /// `result`, which left these files.
    pub(crate) fn of(self, result: RunResult) -> RunResult {
        let Self { recording, recording_seal, files } = self;
        RunResult { recording, recording_seal, files, ..result }
    }

    fn note(&mut self, name: String) {
        self.files.push(name);
    }
}

/// Number of recordings in `folder` that neither `runs` nor the comparison beside them name; 0 for an unreadable folder.
pub(crate) fn older_recordings(folder: &Path, runs: &dyn Runs) -> usize {
    let stem = |path: &Path| path.file_stem().map(OsStr::to_owned);
    let is_recording = |path: &Path| path.extension().is_some_and(|kind| kind == "parquet" || kind == "rrd");
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path());
    let mut found: HashSet<_> = entries.filter(|path| is_recording(path)).filter_map(|path| stem(&path)).collect();
    // Of a comparison's files only its recording counts.
    for name in files_of_results(&folder.join(COMPARISON)).unwrap_or_default() {
        stem(name.as_ref()).map(|stem| found.remove(&stem));
    }
    for head in runs.heads().filter(|head| head.has_recording) {
        let recording = runs.result(head.index).ok().and_then(|run| run.recording.clone());
        recording.and_then(|name| stem(name.as_ref())).map(|stem| found.remove(&stem));
    }
    found.len()
}

/// Identity of a run for results, with its files.
pub(crate) fn identity(job: &Job, written: Written) -> RunIdentity {
    let scenario = &job.scenario;
    RunIdentity {
        name: scenario.name.clone(),
        file: scenario.path.as_ref().map(|path| path.display().to_string()),
        engine: job.engine.to_string(),
        axis: scenario.axis.name,
        inputs: inputs_of(job),
        made_of: scenario.made_of.clone(),
        recording: written.recording,
        recording_seal: written.recording_seal,
        files: written.files,
        parameters: scenario.parameters.iter().map(|one| (one.key.clone(), one.value.clone())).collect(),
        overrides: scenario.overrides.iter().map(ToString::to_string).collect(),
        limits: limit_places(scenario),
        check_warnings: None,
    }
}

/// Identity of a run for lists of runs.
pub(crate) fn unfinished(job: &Job) -> Unfinished {
    let Scenario { name, path, axis, .. } = &job.scenario;
    let file = path.as_ref().map(|path| path.display().to_string());
    Unfinished { name: name.clone(), file, engine: job.engine.to_string(), axis: axis.name }
}

/// Digest of all inputs of the run of `job`.
pub(crate) fn inputs_of(job: &Job) -> Digest {
    let scenario = &job.scenario;
    let start = Digester::default().with(build_id::program()).with(job.engine.to_string()).with(&scenario.name);
    let start = scenario.overrides.iter().fold(start.with(&job.text), |digester, one| digester.with(one.to_string()));
    let parameters = scenario.parameters.iter().fold(start, |digester, one| digester.with(&one.key).with(&one.value));
    // The content of files, in the order in which the scenario names them; their location does not matter.
    let files = scenario.made_of.iter().fold(parameters, |digester, file| digester.with(&file.sha256));
    files.finish()
}

/// Where the scenario file has which limit: `limits.settling_time`, `limits.x.settling_time`, `program.1.limits.overshoot.max`.
fn limit_places(scenario: &Scenario) -> Vec<LimitPlace> {
    let moves: Vec<usize> = (0..).zip(&scenario.program).filter_map(|(k, step)| of_move(step).then_some(k)).collect();
    let place = |parameter: &Parameter| {
        let mut parts = parameter.key.split('.');
        let in_move = match parts.next()? {
            "limits" => None,
            "program" => {
                let index: usize = parts.next()?.parse().ok()?;
                (parts.next()? == "limits").then_some(())?;
                Some(moves.iter().position(|step| *step == index)?)
            }
            _ => return None,
        };
        let mut parts = parts.skip_while(|part| scenario.axis.name.is_some_and(|axis| axis.as_str() == *part));
        Some(LimitPlace { in_move, metric: parts.next()?.to_owned(), line: parameter.line? })
    };
    scenario.parameters.iter().filter_map(place).collect()
}

const fn of_move(step: &Step) -> bool {
    matches!(step, Step::Move(_))
}

/// True if a run with this `outcome` keeps its recording. An unjudged run did not fail.
pub(crate) const fn is_kept(keep: Keep, outcome: Outcome) -> bool {
    match keep {
        Keep::All => true,
        Keep::Failed => !outcome.is_good(),
        Keep::None => false,
    }
}

/// Verdict on a judged run, for a viewer.
pub(crate) fn shown(recording: &Recording, metrics: &Metrics, verdict: &Verdict) -> view::Verdict {
    let judged = RunResult::judged(RunIdentity::default(), recording, metrics, verdict);
    said_of(judged.verdict, judged.reasons, judged.warnings)
}

/// The words of a result for a viewer.
pub(crate) fn said_of(outcome: Outcome, reasons: Vec<String>, warnings: Vec<String>) -> view::Verdict {
    let outcome = match outcome {
        Outcome::Passed => view::Outcome::Passed,
        Outcome::Unjudged => view::Outcome::Unjudged,
        Outcome::Failed | Outcome::Invalid | Outcome::Error => view::Outcome::Failed,
    };
    // A viewer shows them as they are.
    let printable = |all: Vec<String>| all.iter().map(|one| printable_lines(one)).collect();
    view::Verdict { outcome, reasons: printable(reasons), warnings: printable(warnings) }
}

/// Options for a viewer beside the recording: limits and the settling window.
pub(crate) fn view_options(scenario: &Scenario) -> ViewOptions {
    ViewOptions {
        limits: channel_limits(scenario).into_iter().map(|(signal, limit)| (signal.name().to_owned(), limit)).collect(),
        allowed: scenario.limits.iter().filter_map(|limit| Some((limit.metric, limit.max?))).collect(),
        window: scenario.measure.window,
        residual_from: scenario.measure.from,
        motor: motor_limits(scenario),
        ..ViewOptions::default()
    }
}

/// The synchronous motor of `scenario` and its bounds.
fn motor_limits(scenario: &Scenario) -> Option<MotorLimits> {
    let Actuator::Pmsm { motor, dc_link, drive, .. } = &scenario.actuator else { return None };
    let (current, _) = drive.params.current_loop()?;
    Some(MotorLimits {
        motor: *motor,
        bounds: Bounds { current: current.max_current, voltage: inverter::voltage_limit(*dc_link) },
        dc_link: *dc_link,
        effort: scenario.actuator.max_effort(),
        transmission: scenario.direction() * scenario.axis.transmission,
        motion: scenario.axis.motor_motion,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_are_placed_by_the_move_that_has_them() {
        let text = "run.base_rate = \"12 kHz\"\naxis = { motion = \"linear\", motor_side.mass = \"21 kg\" }\n\
                    motor.kind = \"prescribed\"\nsetpoint = { order = 2, velocity = \"1 m/s\", acceleration = \"1 m/s2\" }\n\
                    [[program]]\nwait = \"1 s\"\n[[program]]\nmove_to = \"1 m\"\nlimits.overshoot = { max = \"1 um\" }\n\
                    [limits]\nmove_time = \"2 s\"\n";
        let loaded = servobench_scenario::parse("a.toml", text, None).unwrap_or_else(|error| panic!("{error}"));
        let place = |in_move, metric: &str, line| LimitPlace { in_move, metric: metric.into(), line };
        assert_eq!(limit_places(&loaded.scenario), [place(Some(0), "overshoot", 9), place(None, "move_time", 11)]);
        let text = text.replace("axis = { ", "axis = { name = \"x\", ").replace("[limits]", "[limits.x]");
        let text = text.replace("limits.overshoot", "limits.x.overshoot");
        let loaded = servobench_scenario::parse("a.toml", &text, None).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(limit_places(&loaded.scenario), [place(Some(0), "overshoot", 9), place(None, "move_time", 11)]);
    }
}
