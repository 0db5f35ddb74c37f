//! What a run leaves on the disk: recordings, results, reports. Each file is there whole or not at all.
use crate::exit::CliError;
use servobench_report::{RunIdentity, RunResult};
use servobench_scenario::{Motor, Scenario};
use servobench_suite::{Job, Report, RunError};
use servobench_view::ViewOptions;
use std::path::Path;

/// Makes the folder for everything.
pub(crate) fn make_folder(folder: &Path) -> Result<(), CliError> {
    std::fs::create_dir_all(folder)
        .map_err(|error| CliError::Run(format!("cannot make the folder `{}`: {error}", folder.display())))
}

/// Writes the whole file or nothing.
pub(crate) fn write_file(path: &Path, text: &str) -> Result<(), CliError> {
    servobench_trace::write_whole(path, text)
        .map_err(|error| CliError::Run(format!("cannot write `{}`: {error}", path.display())))
}

/// Writes the recording of `job` into `folder`, for the Rerun viewer too when `rrd` says so. A recording that cannot be
/// written takes the verdict away.
pub(crate) fn write_recording(job: &Job, report: &mut Report, folder: &Path, rrd: bool) {
    let Some(recording) = &report.recording else { return };
    let written = recording.write_parquet(folder.join(recording_name(job))).map_err(|error| error.to_string());
    let shown = written.and_then(|()| {
        if !rrd {
            return Ok(());
        }
        let path = folder.join(format!("{}.rrd", job.id));
        servobench_view::write_rrd(recording, path, &view_options(&job.scenario)).map_err(|error| error.to_string())
    });
    if let Err(error) = shown {
        report.outcome = Err(RunError::Failed(error));
    }
}

/// The job as results have it.
pub(crate) fn result(job: &Job, report: &Report) -> RunResult {
    let run = RunIdentity {
        name: job.scenario.name.clone(),
        file: job.scenario.path.as_ref().map(|path| path.display().to_string()),
        engine: job.engine.as_str().to_owned(),
        recording: report.recording.as_ref().map(|_| recording_name(job)),
    };
    match (&report.outcome, &report.recording) {
        (Ok(verdict), Some(recording)) => RunResult::judged(run, recording, &report.metrics, verdict),
        (Ok(_), None) => RunResult::error(run, None, &report.metrics, "there is no recording".into()),
        (Err(error), recording) => RunResult::error(run, recording.as_ref(), &report.metrics, error.to_string()),
    }
}

fn recording_name(job: &Job) -> String {
    format!("{}.parquet", job.id)
}

/// What a viewer is told beside the recording: limits and the settling window.
pub(crate) fn view_options(scenario: &Scenario) -> ViewOptions {
    let limit = |channel: &str, value: f64| value.is_finite().then(|| (channel.to_owned(), value));
    let mut limits: Vec<_> = limit("effort.reference", scenario.drive.max_effort).into_iter().collect();
    match &scenario.motor {
        Motor::Pmsm(motor) => {
            limits.extend(limit("current.q", motor.max_current));
            let voltage = servobench_plant::inverter::voltage_limit(scenario.drive.dc_link);
            limits.extend(limit("voltage.magnitude", voltage));
        }
        Motor::IdealSource(source) => limits.extend(limit("command.output", source.limit)),
        Motor::Prescribed => limits.clear(),
    }
    ViewOptions {
        limits,
        window: scenario.measure.window,
        residual_from: scenario.measure.from,
        ..ViewOptions::default()
    }
}
