//! `servobench run`: scenarios in, verdicts out.
mod wanted;

use crate::args::{Keep, RunArgs};
use crate::console::{print, program, say, style};
use crate::engines;
use crate::error::CliError;
use crate::exit::{Exit, of_outcome, of_run_error};
use crate::interrupt;
use crate::output::{self, RESULTS, Written};
use crate::progress::Progress;
use crate::workers;
use servobench_report::{Outcome, Results, RunIdentity, RunResult, brief, junit, verdict_table};
use servobench_suite::{Broken, Engines, Job, Run, WorkerCommand, execute, map_in_parallel};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};
use wanted::Wanted;

/// Where results go unless somebody says so; those of the demo go below it, so that they take nobody else's place.
const OUT: &str = "servobench-out";
const OUT_OF_THE_DEMO: &str = "servobench-out/demo";

/// What a run came to, and how long that took by the clock.
type Timed = (RunResult, Duration);

/// Runs the scenarios, judges them and writes what came of them.
pub(crate) fn run(args: &RunArgs) -> Result<Exit, CliError> {
    let engines = engines::installed();
    if args.rrd && args.keep == Keep::None {
        return Err(CliError::NothingForTheViewer);
    }
    let wanted = Wanted::of(args, &engines)?;
    if wanted.jobs.is_empty() {
        return nothing_to_run(args, wanted);
    }
    let out = args.out.clone().unwrap_or_else(|| {
        let default = if args.scenarios.is_empty() { OUT_OF_THE_DEMO } else { OUT };
        PathBuf::from(default)
    });
    if !args.quiet {
        say(&wanted.shown());
        if args.scenarios.is_empty() {
            say(&wanted.demo(&out));
        }
    }
    output::make_folder(&out)?;
    interrupt::watch(&out)?;
    let removed = output::remove_former(&out, RESULTS);
    let ended = carried_out(args, &wanted.jobs, &engines, &out)?;
    let (runs, times): (Vec<_>, Vec<_>) = wanted.in_order(ended).into_iter().unzip();
    let results = Results::new(runs);

    let mut exit = results.scenarios.iter().fold(Exit::Passed, |worst, run| worst.worse(of_outcome(run.verdict)));
    let mut troubles = Vec::new();
    let mut keep = |done: Result<(), CliError>| {
        if let Err(error) = done {
            exit = exit.worse(error.exit());
            troubles.push(error);
        }
    };
    keep(write_results(&results, &out));
    if let Some(path) = &args.junit {
        keep(write_junit(&results, &times, path));
    }
    // What could not be written does not keep the verdicts from being said.
    print(&text_of(&results, args, &out, removed))?;
    for trouble in troubles {
        say(&format!("servobench: {trouble}\n"));
    }
    Ok(exit)
}

/// Every file is wrong: the mistakes are what is said, and nothing of earlier runs is touched.
fn nothing_to_run(args: &RunArgs, wanted: Wanted) -> Result<Exit, CliError> {
    let ended: Vec<Timed> = wanted.in_order(Vec::new());
    let (runs, times): (Vec<_>, Vec<_>) = ended.into_iter().unzip();
    let results = Results::new(runs);
    if let Some(path) = &args.junit
        && let Err(error) = write_junit(&results, &times, path)
    {
        say(&format!("servobench: {error}\n"));
    }
    if !args.quiet {
        return Err(CliError::Scenarios(wanted.into_unusable()));
    }
    print(&brief(&results))?;
    Ok(Exit::Input)
}

/// Runs all jobs.
fn carried_out(args: &RunArgs, jobs: &[Job], engines: &Engines, out: &Path) -> Result<Vec<Timed>, CliError> {
    let worker = workers::command(out, args.worker_timeout)?;
    let progress = Progress::new(jobs.len(), args.quiet);
    let ended = map_in_parallel(jobs, workers::at_a_time(args.jobs), Job::memory, |job| {
        let start = Instant::now();
        let result = one(job, engines, &worker, args, out, &progress);
        (result, start.elapsed())
    });
    let ended = jobs.iter().zip(ended).map(|(job, ended)| {
        ended.unwrap_or_else(|panic| {
            progress.ended(&job.id, Outcome::Error.word());
            let run = output::identity(job, Written::default());
            (RunResult::error(run, None, vec![panic.to_string()]), Duration::ZERO)
        })
    });
    let ended = ended.collect();
    progress.finish();
    Ok(ended)
}

/// Runs one job and writes its recording, if that is to stay. One that cannot be written takes the verdict away.
fn one(
    job: &Job,
    engines: &Engines,
    worker: &WorkerCommand,
    args: &RunArgs,
    folder: &Path,
    progress: &Progress,
) -> RunResult {
    let write = |recording, outcome, shown: servobench_view::Verdict| {
        if output::is_kept(args.keep, outcome) {
            output::write_recording(job, recording, folder, args.rrd.then_some(shown))
        } else {
            Ok(Written::default())
        }
    };
    let result = match execute(job, engines, worker, &mut progress.of_run(&job.id)) {
        Ok(Run { recording, metrics, verdict }) => {
            let judged = RunResult::judged(RunIdentity::default(), &recording, &metrics, &verdict).verdict;
            match write(&recording, judged, output::shown(&recording, &metrics, &verdict)) {
                Ok(written) => RunResult::judged(output::identity(job, written), &recording, &metrics, &verdict),
                Err((error, written)) => {
                    let (run, until_then) = (output::identity(job, written), Some((&recording, &metrics)));
                    RunResult::error(run, until_then, vec![error.to_string()])
                }
            }
        }
        Err(broken) if of_run_error(&broken.error) == Exit::Input => {
            RunResult::invalid(output::identity(job, Written::default()), vec![broken.error.to_string()])
        }
        Err(broken) => {
            let Broken { error, until_then } = *broken;
            let mut reasons = vec![error.to_string()];
            let written = until_then.as_ref().map(|(recording, _)| {
                let outcome = servobench_view::Outcome::Failed;
                let shown = servobench_view::Verdict { outcome, reasons: reasons.clone(), warnings: Vec::new() };
                write(recording, Outcome::Error, shown).unwrap_or_else(|(unwritten, written)| {
                    reasons.push(unwritten.to_string());
                    written
                })
            });
            let until_then = until_then.as_ref().map(|(recording, metrics)| (recording, metrics));
            RunResult::error(output::identity(job, written.unwrap_or_default()), until_then, reasons)
        }
    };
    progress.ended(&job.id, result.verdict.word());
    result
}

fn write_results(results: &Results, out: &Path) -> Result<(), CliError> {
    let text = results.to_json()?;
    output::write_file(&out.join(RESULTS), &text)?;
    interrupt::told();
    Ok(())
}

fn write_junit(results: &Results, times: &[Duration], path: &Path) -> Result<(), CliError> {
    let text = junit(results, times)?;
    output::write_file_anywhere(path, &text)
}

fn text_of(results: &Results, args: &RunArgs, out: &Path, removed: Result<usize, String>) -> String {
    if args.quiet {
        return brief(results);
    }
    let older = match output::older_recordings(out, results) {
        0 => String::new(),
        1 => ", with a recording that they do not name".into(),
        count => format!(", with {count} recordings that they do not name"),
    };
    let removed = match removed {
        Ok(0) => String::new(),
        Ok(1) => "; removed 1 file of the run before".into(),
        Ok(count) => format!("; removed {count} files of the run before"),
        Err(why) => format!("; what the run before left stays: {why}"),
    };
    let out = out.display();
    let kept = results.scenarios.iter().filter(|run| run.recording.is_some()).count();
    let what = match (args.keep, kept) {
        (Keep::All, _) => "results and recordings".to_owned(),
        (_, 0) => "results, no recordings".to_owned(),
        (_, 1) => "results and 1 recording".to_owned(),
        (_, kept) => format!("results and {kept} recordings"),
    };
    let mut parts = vec![verdict_table(results, style(), args.verbose), format!("{what}: {out}{older}{removed}\n")];
    parts.extend((args.rrd && kept > 0).then(|| format!("look at them: {} view {out}\n", program())));
    parts.concat()
}
