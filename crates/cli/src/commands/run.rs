//! `servobench run`: scenarios in, verdicts out.
use crate::args::RunArgs;
use crate::console::{print, style};
use crate::engines;
use crate::exit::{CliError, Exit, of_run_error};
use crate::output;
use crate::progress::Progress;
use crate::sources;
use crate::workers;
use servobench_report::{Outcome, Results, RunResult, junit, verdict_table};
use servobench_suite::{Broken, Engines, Job, Run, WorkerCommand, execute, jobs, map_in_parallel};
use std::path::Path;

/// Runs the scenarios, judges them and writes what came of them.
pub(crate) fn run(args: &RunArgs) -> Result<Exit, CliError> {
    let engines = engines::installed();
    let jobs = wanted_jobs(args, &engines)?;
    output::make_folder(&args.out)?;
    let worker = workers::command(&args.out, args.worker_timeout)?;

    let progress = Progress::new(jobs.len(), args.quiet);
    let ended = map_in_parallel(&jobs, workers::at_a_time(args.jobs), Job::memory, |job| {
        one(job, &engines, &worker, args.rrd, &args.out, &progress)
    });
    let ended: Vec<(RunResult, Exit)> = jobs
        .iter()
        .zip(ended)
        .map(|(job, ended)| {
            ended.unwrap_or_else(|panic| {
                progress.ended(&job.id, words(Exit::Run));
                (RunResult::error(output::identity(job, None), None, vec![panic.to_string()]), Exit::Run)
            })
        })
        .collect();
    progress.finish();

    let exit = ended.iter().fold(Exit::Passed, |worst, (_, exit)| worst.worse(*exit));
    let results = Results::new(ended.into_iter().map(|(result, _)| result).collect());
    let text = results.to_json().map_err(|error| CliError::Run(error.to_string()))?;
    output::write_file(&args.out.join(output::RESULTS), &text)?;
    if let Some(path) = &args.junit {
        output::write_file(path, &junit(&results).map_err(|error| CliError::Run(error.to_string()))?)?;
    }
    print(&text_of(&results, args))?;
    Ok(exit)
}

fn wanted_jobs(args: &RunArgs, engines: &Engines) -> Result<Vec<Job>, CliError> {
    if !args.scenarios.is_empty() {
        return Ok(jobs(sources::load(&args.scenarios)?, &args.engine));
    }
    let all = engines.names();
    Ok(jobs(sources::demo()?, if args.engine.is_empty() { &all } else { &args.engine }))
}

/// Runs one job and writes its recording. One that cannot be written takes the verdict away.
fn one(
    job: &Job,
    engines: &Engines,
    worker: &WorkerCommand,
    rrd: bool,
    folder: &Path,
    progress: &Progress,
) -> (RunResult, Exit) {
    let write = |recording| output::write_recording(job, recording, folder, rrd);
    let (result, exit) = match execute(job, engines, worker, &mut progress.of_run()) {
        Ok(Run { recording, metrics, verdict }) => match write(&recording) {
            Ok(name) => {
                let run = output::identity(job, Some(name));
                let exit = if verdict.passed() { Exit::Passed } else { Exit::Limit };
                (RunResult::judged(run, &recording, &metrics, &verdict), exit)
            }
            Err(error) => {
                let (run, until_then) = (output::identity(job, None), Some((&recording, &metrics)));
                (RunResult::error(run, until_then, vec![error.to_string()]), error.exit())
            }
        },
        Err(broken) => {
            let Broken { error, until_then } = *broken;
            let mut reasons = vec![error.to_string()];
            let name = until_then.as_ref().and_then(|(recording, _)| {
                write(recording).map_err(|unwritten| reasons.push(unwritten.to_string())).ok()
            });
            let until_then = until_then.as_ref().map(|(recording, metrics)| (recording, metrics));
            (RunResult::error(output::identity(job, name), until_then, reasons), of_run_error(&error))
        }
    };
    progress.ended(&job.id, words(exit));
    (result, exit)
}

/// What a progress line says of a run.
const fn words(exit: Exit) -> &'static str {
    match exit {
        Exit::Passed => "passed",
        Exit::Limit => "missed a limit",
        Exit::Input | Exit::Run => "could not be carried out",
    }
}

fn text_of(results: &Results, args: &RunArgs) -> String {
    if args.quiet {
        let bad = results.scenarios.iter().filter(|run| run.verdict != Outcome::Passed);
        let lines = bad.map(|run| format!("{} on {}: {}\n", run.name, run.engine, run.reasons.join("; ")));
        return lines.collect::<Vec<_>>().concat();
    }
    let out = args.out.display();
    let mut parts = vec![verdict_table(results, style()), format!("results and recordings: {out}\n")];
    parts.extend(args.rrd.then(|| format!("look at them: servobench view {out}\n")));
    parts.concat()
}
