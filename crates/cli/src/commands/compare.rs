//! `servobench compare`: the same axis under different set-points.
use super::run::{cores, style, worker_command};
use crate::args::{CompareArgs, Equal};
use crate::engines;
use crate::exit::{CliError, Exit, of_run_error};
use crate::output;
use crate::progress::Progress;
use crate::sources;
use servobench_report::{Compared, Comparison, Results, RunResult};
use servobench_scenario::EngineName;
use servobench_suite::{Job, Report, execute, for_each_in_parallel, jobs, to_equal_duration};
use servobench_trace::Recording;
use std::io::Write;

/// Runs the scenarios on one engine, says which wins by how much, and writes one recording of them all.
pub(crate) fn compare(args: &CompareArgs) -> Result<Exit, CliError> {
    let mut jobs = wanted_jobs(args)?;
    if args.equal == Equal::Duration {
        to_equal_duration(&mut jobs).map_err(|error| CliError::Input(error.to_string()))?;
    }
    let labels = labels(&jobs.iter().map(|job| job.scenario.name.as_str()).collect::<Vec<_>>());
    output::make_folder(&args.out)?;
    let (engines, worker) = (engines::installed(), worker_command(&args.out)?);
    let progress = Progress::new(jobs.len(), false);
    let reports: Vec<Report> = for_each_in_parallel(&jobs, cores(), |_, job| {
        let report = execute(job, &engines, &worker, &mut progress.of_run());
        progress.ended(&job.id, if report.outcome.is_ok() { "done" } else { "could not be carried out" });
        report
    });
    progress.finish();
    for (job, report) in jobs.iter().zip(&reports) {
        if let Err(error) = &report.outcome {
            let words = format!("{} on {}: {error}", job.scenario.name, job.engine.as_str());
            return Err(if of_run_error(error) == Exit::Input { CliError::Input(words) } else { CliError::Run(words) });
        }
    }

    let results: Vec<RunResult> = jobs.iter().zip(&reports).map(|(job, report)| output::result(job, report)).collect();
    let recording = write_recording(args, &jobs, &labels, &reports)?;
    let compared = labels.iter().zip(&results).map(|(label, result)| Compared { label, result }).collect();
    let comparison = Comparison::new(compared);
    let mut out = std::io::stdout();
    writeln!(out, "{}", heading(args, &jobs))?;
    writeln!(out)?;
    writeln!(out, "{}", comparison.table(style()))?;
    writeln!(out, "{}", comparison.words(style().width))?;
    writeln!(out, "look at it: servobench view {recording}")?;
    drop(comparison);
    let text = Results::new(results).to_json().map_err(|error| CliError::Run(error.to_string()))?;
    output::write_file(&args.out.join("comparison.json"), &text)?;
    Ok(Exit::Passed)
}

/// Every scenario once, all on the same engine.
fn wanted_jobs(args: &CompareArgs) -> Result<Vec<Job>, CliError> {
    let sources = sources::load(&args.scenarios)?;
    if sources.len() < 2 {
        return Err(CliError::Input("a comparison needs two scenarios at least".into()));
    }
    let engine = args.engine.map(EngineName::from).or_else(|| sources[0].scenario.engines.first().copied());
    let engine = engine.unwrap_or(EngineName::Exact);
    if let Some(other) = sources.iter().find(|other| other.scenario.axis != sources[0].scenario.axis) {
        let (one, two) = (&sources[0].scenario.name, &other.scenario.name);
        return Err(CliError::Input(format!(
            "`{one}` and `{two}` have different axes; a comparison is of one axis under different set-points"
        )));
    }
    Ok(jobs(sources, &[engine]))
}

fn heading(args: &CompareArgs, jobs: &[Job]) -> String {
    let equal = match args.equal {
        Equal::Limits => "each at its own limits",
        Equal::Duration => "slowed to equal duration",
    };
    let names: Vec<_> = jobs.iter().map(|job| job.scenario.name.as_str()).collect();
    let engine = jobs.first().map_or("", |job| job.engine.as_str());
    format!("{} on {engine}, {equal}", names.join(" and "))
}

/// Writes the one recording in which the runs lie over each other, and returns its name.
fn write_recording(
    args: &CompareArgs,
    jobs: &[Job],
    labels: &[String],
    reports: &[Report],
) -> Result<String, CliError> {
    let runs: Vec<(&str, &Recording)> = labels
        .iter()
        .zip(reports)
        .filter_map(|(label, report)| Some((label.as_str(), report.recording.as_ref()?)))
        .collect();
    let options = jobs.first().map(|job| output::view_options(&job.scenario)).unwrap_or_default();
    let path = args.out.join(format!("{}.rrd", labels.join("-against-")));
    servobench_view::write_comparison_rrd(&runs, &path, &options).map_err(|error| CliError::Run(error.to_string()))?;
    Ok(path.display().to_string())
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
