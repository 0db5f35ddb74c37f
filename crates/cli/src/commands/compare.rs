//! `servobench compare`: runs side by side, what differs in them and in what they give.
use crate::args::{CompareArgs, Equal};
use crate::console::{print, program, style};
use crate::engines;
use crate::error::{CliError, FailedRun};
use crate::exit::{Exit, of_outcome};
use crate::interrupt;
use crate::output::{self, Written};
use crate::outputs::{OutputFolder, Outputs};
use crate::progress::Progress;
use crate::sources;
use crate::workers;
use servobench_config::Choice as _;
use servobench_report::{Compared, Comparison, elided, wrapped};
use servobench_results::{COMPARISON, Folder, Outcome, Results, RunResult, printable};
use servobench_scenario::{Difference, differences};
use servobench_suite::{
    Job, Run, RunError, comparable, execute, file_name, jobs, limits_agree, map_in_parallel, only_setpoints_differ,
    to_equal_duration,
};
use servobench_trace::Recording;
use servobench_view::ViewOptions;

/// Differences that are listed; the others are counted.
const MOST: usize = 12;
/// Characters of a value that are shown.
const LONGEST: usize = 30;

/// Runs the scenarios on one engine, says what differs, which wins by how much where that can be said, and writes one
/// recording of them all.
pub(crate) fn compare(args: &CompareArgs) -> Result<Exit, CliError> {
    let mut jobs = wanted_jobs(args)?;
    comparable(&jobs)?;
    let is_of_set_points = only_setpoints_differ(&jobs);
    match args.equal {
        None => {}
        Some(Equal::Limits) => limits_agree(&jobs)?,
        Some(Equal::Duration) => to_equal_duration(&mut jobs)?,
    }
    let names: Vec<String> = jobs.iter().map(|job| printable(&job.scenario.name)).collect();
    let labels = labels(&names.iter().map(String::as_str).collect::<Vec<_>>());
    let (out, name) = outputs(args, &labels)?;
    let folder = Folder::open(out.path())?;
    let former = folder.former(COMPARISON)?;
    interrupt::watch(&args.out)?;
    let runs = carried_out(args, &jobs)?;

    folder.remove(&former);
    let recording = write_recording(&out, name, &jobs, &labels, &runs)?;
    let written = Written { recording: Some(recording.clone()), files: vec![recording.clone()], ..Written::default() };
    let results: Vec<RunResult> = jobs
        .iter()
        .zip(&runs)
        .map(|(job, run)| {
            let identity = output::identity(job, written.clone());
            RunResult::judged(identity, &run.recording, &run.metrics, &run.verdict)
        })
        .collect();
    let exit = results.iter().fold(Exit::Passed, |worst, run| worst.worse(of_outcome(run.verdict)));
    let compared = labels.iter().zip(&results).zip(&runs);
    let compared = compared.map(|((label, result), run)| Compared { label, result, moves: &run.recording.moves });
    let comparison = Comparison::new(compared.collect());
    let comparison = if is_of_set_points { comparison } else { comparison.of_more_than_set_points() };
    let has_something = comparison.has_something_to_compare();
    let text = text_of(args, &jobs, &comparison, &recording);
    let json = Results::new(results).to_json()?;
    out.file(COMPARISON)?.write(&json)?;
    interrupt::told();
    if !has_something {
        return Err(CliError::NothingToCompare);
    }
    print(&text)?;
    Ok(exit)
}

/// The folder, and the name of the recording in it.
fn outputs(args: &CompareArgs, labels: &[String]) -> Result<(OutputFolder, String), CliError> {
    let name = format!("{}.rrd", file_name(&labels.join("-against-")));
    let out = Outputs::default().folder("--out", &args.out, |one| one == name || one == COMPARISON)?;
    Ok((out, name))
}

/// Every scenario once, all on the same engine.
fn wanted_jobs(args: &CompareArgs) -> Result<Vec<Job>, CliError> {
    let sources = sources::load(&args.scenarios, &args.with)?;
    if sources.len() < 2 {
        return Err(CliError::TooFewScenarios);
    }
    let engine = args.engine.or_else(|| sources[0].scenario.engines.first().copied());
    Ok(jobs(sources, &[engine.unwrap_or_default()]))
}

/// Runs all of them; without one of them there is no comparison.
fn carried_out(args: &CompareArgs, jobs: &[Job]) -> Result<Vec<Run>, CliError> {
    let limits = workers::limits(args.time_limit, args.memory.memory_limit);
    let (engines, workers) = (engines::installed(), workers::of(&args.out, args.worker_timeout, limits)?);
    let progress = Progress::new(jobs.len(), false);
    let ready = |job: &Job| ((), job.memory());
    let ended = map_in_parallel(jobs, workers::at_a_time(None, limits), ready, |job, ()| {
        let ended = execute(job, &engines, &workers, &mut progress.of_run(&job.id, workers.slow(job)))
            .map_err(|broken| broken.error);
        progress.ended(&job.id, if ended.is_ok() { "done" } else { Outcome::Error.word() });
        ended
    });
    progress.finish();
    workers::dismiss(&workers);
    let (mut runs, mut failed) = (Vec::new(), Vec::new());
    for (job, ended) in jobs.iter().zip(ended) {
        match ended.map_err(RunError::from).flatten() {
            Ok(run) => runs.push(run),
            Err(error) => failed.push(FailedRun::new(job, error)),
        }
    }
    if failed.is_empty() { Ok(runs) } else { Err(CliError::Runs(failed)) }
}

fn text_of(args: &CompareArgs, jobs: &[Job], comparison: &Comparison<'_>, recording: &str) -> String {
    let style = style();
    [
        heading(args, jobs) + "\n\n",
        comparison.table(style) + "\n",
        comparison.words(style.width) + "\n",
        comparison.failed(style.width),
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
    let names: Vec<_> = jobs.iter().map(|job| printable(&job.scenario.name)).collect();
    let engine = jobs.first().map_or("", |job| job.engine.name());
    let mut text = format!("{} on {engine}, {equal}", names.join(" and "));
    let Some((one, others)) = jobs.split_first() else { return text };
    let overrides: Vec<String> = one.scenario.overrides.iter().map(|one| printable(&one.to_string())).collect();
    if !overrides.is_empty() {
        let words = format!("overrides of all runs: {}", overrides.join(", "));
        text.push('\n');
        text += &wrapped(&words, style().width.saturating_sub(2)).join("\n  ");
    }
    for (other, name) in others.iter().zip(&names[1..]) {
        let all = differences(&one.scenario.parameters, &other.scenario.parameters);
        let all: Vec<_> = all.into_iter().filter(|difference| is_of_the_run(&difference.key)).collect();
        let of = if others.len() > 1 { format!(" ({} against {name})", names[0]) } else { String::new() };
        text += &listed(&of, &all);
    }
    text
}

/// Whether a key says what is run, and not on what or what is kept of it.
fn is_of_the_run(key: &str) -> bool {
    key != "engine" && !key.starts_with("record.channels")
}

/// What differs, a line for each key: `drive.velocity.bandwidth  60 Hz against 90 Hz`.
fn listed(of: &str, all: &[Difference]) -> String {
    if all.is_empty() {
        return format!("\nthe files say the same{of}");
    }
    let value = |value: &Option<String>| {
        value.as_ref().map_or_else(|| "nothing".to_owned(), |value| elided(&printable(value), LONGEST))
    };
    let shown = &all[..all.len().min(MOST)];
    let keys = shown.iter().map(|difference| difference.key.chars().count());
    let key = keys.filter(|length| *length <= LONGEST).max().unwrap_or(0);
    let lines = shown.iter().map(|difference| {
        let values = format!("{} against {}", value(&difference.one), value(&difference.other));
        let line = format!("\n  {:key$}  {values}", difference.key);
        // Its values stand below a key that leaves them no room.
        if line.chars().count() > style().width + 1 { format!("\n  {}\n      {values}", difference.key) } else { line }
    });
    let more = all.len() - shown.len();
    let more = if more > 0 { format!("\n  and {more} more: see `parameters` in {COMPARISON}") } else { String::new() };
    format!("\nwhat differs{of}:{}{more}", lines.collect::<String>())
}

/// Writes the one recording in which the runs lie over each other, and returns its name.
fn write_recording(
    out: &OutputFolder,
    name: String,
    jobs: &[Job],
    labels: &[String],
    runs: &[Run],
) -> Result<String, CliError> {
    let labelled: Vec<(&str, &Recording)> =
        labels.iter().map(String::as_str).zip(runs.iter().map(|run| &run.recording)).collect();
    let options = jobs.iter().map(|job| output::view_options(&job.scenario));
    let options = options.reduce(|one, other| agreed(one, &other)).unwrap_or_default();
    let verdicts = runs.iter().map(|run| output::shown(&run.recording, &run.metrics, &run.verdict)).collect();
    let options = ViewOptions { verdicts, ..options };
    let place = out.place(&name)?;
    servobench_view::write_comparison_rrd(&labelled, &place, &options)?;
    interrupt::written(&place);
    Ok(name)
}

/// What both are held to: a line over all runs must not be the bound of one of them.
fn agreed(mut one: ViewOptions, other: &ViewOptions) -> ViewOptions {
    one.limits.retain(|limit| other.limits.contains(limit));
    one.allowed.retain(|allowed| other.allowed.contains(allowed));
    one.window = one.window.filter(|_| one.window == other.window);
    one.residual_from = one.residual_from.filter(|_| one.residual_from == other.residual_from);
    one
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
    use servobench_metrics::Name;

    #[test]
    fn differences_are_listed_by_key_and_value() {
        let difference = |key: &str, one: &str, other: Option<&str>| Difference {
            key: key.into(),
            one: Some(one.into()),
            other: other.map(str::to_owned),
        };
        let all = [
            difference("drive.velocity.bandwidth", "60 Hz", Some("90 Hz")),
            difference("drive.filter.1.frequency.of.the.notch.that.has.a.very.long.name", "1 kHz", None),
        ];
        assert_eq!(listed("", &all[..1]), "\nwhat differs:\n  drive.velocity.bandwidth  60 Hz against 90 Hz");
        let text = listed(" (a against b)", &all);
        let first = "\nwhat differs (a against b):\n  drive.velocity.bandwidth  60 Hz against 90 Hz\n";
        assert!(text.starts_with(first), "{text}");
        assert!(text.ends_with("long.name\n      1 kHz against nothing"), "{text}");
        let many: Vec<_> = (0..20).map(|k| difference(&format!("key{k}"), "1", Some("2"))).collect();
        assert!(listed("", &many).ends_with("\n  and 8 more: see `parameters` in comparison.json"));
    }

    #[test]
    fn a_bound_of_one_run_is_not_drawn_over_all() {
        let options = |most, window| ViewOptions {
            limits: vec![("current.q".into(), 18.0)],
            allowed: vec![(Name::SettlingTime, most), (Name::CurrentPeak, 18.0)],
            window: Some(window),
            ..ViewOptions::default()
        };
        let drawn = agreed(options(0.02, 5e-6), &options(0.9, 1e-5));
        assert_eq!(drawn.limits, [("current.q".to_owned(), 18.0)]);
        assert_eq!((drawn.allowed, drawn.window), (vec![(Name::CurrentPeak, 18.0)], None));
        let same = options(0.02, 5e-6);
        assert_eq!(agreed(same.clone(), &same), same);
    }

    #[test]
    fn labels_are_what_tells_the_names_apart() {
        assert_eq!(labels(&["lambrechts-jerk", "lambrechts-snap"]), ["jerk", "snap"]);
        assert_eq!(labels(&["jerk", "snap"]), ["jerk", "snap"]);
        assert_eq!(labels(&["a-b", "a-b", "a"]), ["a-b", "a-b-2", "a"]);
    }
}
