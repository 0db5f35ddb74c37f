//! `servobench compare`: the same axis under different set-points.
use crate::args::{CompareArgs, Equal};
use crate::console::{print, program, style};
use crate::engines;
use crate::exit::{CliError, Exit, of_run_error};
use crate::output;
use crate::progress::Progress;
use crate::sources;
use crate::workers;
use servobench_report::{Compared, Comparison, Results, RunResult};
use servobench_scenario::EngineName;
use servobench_suite::{
    CompareError, Job, Run, RunError, execute, jobs, limits_agree, map_in_parallel, only_setpoints_differ,
    to_equal_duration,
};
use servobench_trace::Recording;

/// Runs the scenarios on one engine, says which wins by how much, and writes one recording of them all.
pub(crate) fn compare(args: &CompareArgs) -> Result<Exit, CliError> {
    let mut jobs = wanted_jobs(args)?;
    let wrong = |error: CompareError| CliError::Input(error.to_string());
    only_setpoints_differ(&jobs).map_err(wrong)?;
    match args.equal {
        None => {}
        Some(Equal::Limits) => limits_agree(&jobs).map_err(wrong)?,
        Some(Equal::Duration) => to_equal_duration(&mut jobs).map_err(wrong)?,
    }
    let labels = labels(&jobs.iter().map(|job| job.scenario.name.as_str()).collect::<Vec<_>>());
    output::make_folder(&args.out)?;
    let runs = carried_out(args, &jobs)?;

    let recording = write_recording(args, &jobs, &labels, &runs)?;
    let results: Vec<RunResult> = jobs
        .iter()
        .zip(&runs)
        .map(|(job, run)| {
            let identity = output::identity(job, Some(recording.clone()));
            RunResult::judged(identity, &run.recording, &run.metrics, &run.verdict)
        })
        .collect();
    let compared = labels.iter().zip(&results).zip(&runs);
    let compared = compared.map(|((label, result), run)| Compared { label, result, moves: &run.recording.moves });
    let compared = compared.collect();
    let text = text_of(args, &jobs, &Comparison::new(compared), &recording);
    let json = Results::new(results).to_json().map_err(|error| CliError::Run(error.to_string()))?;
    output::write_file(&args.out.join(output::COMPARISON), &json)?;
    print(&text)?;
    Ok(if runs.iter().all(|run| run.verdict.passed()) { Exit::Passed } else { Exit::Limit })
}

/// Every scenario once, all on the same engine.
fn wanted_jobs(args: &CompareArgs) -> Result<Vec<Job>, CliError> {
    let sources = sources::load(&args.scenarios)?;
    if sources.len() < 2 {
        return Err(CliError::Input("a comparison needs two scenarios at least".into()));
    }
    let engine = args.engine.or_else(|| sources[0].scenario.engines.first().copied());
    Ok(jobs(sources, &[engine.unwrap_or(EngineName::Exact)]))
}

/// Runs all of them; without one of them there is no comparison.
fn carried_out(args: &CompareArgs, jobs: &[Job]) -> Result<Vec<Run>, CliError> {
    let (engines, worker) = (engines::installed(), workers::command(&args.out, args.worker_timeout)?);
    let progress = Progress::new(jobs.len(), false);
    let ended = map_in_parallel(jobs, workers::at_a_time(None), Job::memory, |job| {
        let ended = execute(job, &engines, &worker, &mut progress.of_run()).map_err(|broken| broken.error);
        progress.ended(&job.id, if ended.is_ok() { "done" } else { "could not be carried out" });
        ended
    });
    progress.finish();
    let (mut runs, mut failures, mut exit) = (Vec::new(), Vec::new(), Exit::Passed);
    for (job, ended) in jobs.iter().zip(ended) {
        match ended.map_err(RunError::from).flatten() {
            Ok(run) => runs.push(run),
            Err(error) => {
                exit = exit.worse(of_run_error(&error));
                failures.push(format!("{} on {}: {error}", job.scenario.name, job.engine.as_str()));
            }
        }
    }
    match exit {
        Exit::Passed => Ok(runs),
        Exit::Input => Err(CliError::Input(failures.join("\n"))),
        Exit::Run | Exit::Limit => Err(CliError::Run(failures.join("\n"))),
    }
}

fn text_of(args: &CompareArgs, jobs: &[Job], comparison: &Comparison<'_>, recording: &str) -> String {
    let style = style();
    [
        heading(args, jobs) + "\n\n",
        comparison.table(style) + "\n",
        comparison.words(style.width) + "\n",
        comparison.missed(style.width),
        format!("look at it: {} view {}\n", program(), args.out.join(recording).display()),
    ]
    .concat()
}

fn heading(args: &CompareArgs, jobs: &[Job]) -> String {
    let equal = match args.equal {
        None => "each at its own limits",
        Some(Equal::Limits) => "at equal limits",
        Some(Equal::Duration) => "slowed to equal duration",
    };
    let names: Vec<_> = jobs.iter().map(|job| job.scenario.name.as_str()).collect();
    let engine = jobs.first().map_or("", |job| job.engine.as_str());
    format!("{} on {engine}, {equal}", names.join(" and "))
}

/// Writes the one recording in which the runs lie over each other, and returns its name.
fn write_recording(args: &CompareArgs, jobs: &[Job], labels: &[String], runs: &[Run]) -> Result<String, CliError> {
    let labelled: Vec<(&str, &Recording)> =
        labels.iter().map(String::as_str).zip(runs.iter().map(|run| &run.recording)).collect();
    let options = jobs.first().map(|job| output::view_options(&job.scenario)).unwrap_or_default();
    let name = format!("{}.rrd", labels.join("-against-"));
    servobench_view::write_comparison_rrd(&labelled, args.out.join(&name), &options)
        .map_err(|error| CliError::Run(error.to_string()))?;
    Ok(name)
}

/// What tells the names apart: `lambrechts-jerk` and `lambrechts-snap` are `jerk` and `snap`.
fn labels(names: &[&str]) -> Vec<String> {
    let parts: Vec<Vec<&str>> = names.iter().map(|name| name.split('-').collect()).collect();
    let shortest = parts.iter().map(Vec::len).min().unwrap_or(0);
    let same = |i: usize| parts.iter().all(|one| one[i] == parts[0][i]);
    let front = (0..shortest.saturating_sub(1)).take_while(|i| same(*i)).count();
    let mut labels: Vec<String> = parts.iter().map(|one| one[front..].join("-")).collect();
    for i in 0..labels.len() {
        if labels[..i].contains(&labels[i]) {
            labels[i] = format!("{}-{}", labels[i], i + 1);
        }
    }
    labels
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_are_what_tells_the_names_apart() {
        assert_eq!(labels(&["lambrechts-jerk", "lambrechts-snap"]), ["jerk", "snap"]);
        assert_eq!(labels(&["jerk", "snap"]), ["jerk", "snap"]);
        assert_eq!(labels(&["a-b", "a-b", "a"]), ["a-b", "a-b-2", "a"]);
    }
}
