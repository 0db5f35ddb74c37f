//! `servobench run`: scenarios in, verdicts out.
use crate::args::RunArgs;
use crate::console::{print, program, style};
use crate::engines;
use crate::exit::{CliError, Exit, of_outcome, of_run_error};
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
    let ended = jobs.iter().zip(ended).map(|(job, ended)| {
        ended.unwrap_or_else(|panic| {
            progress.ended(&job.id, words(Outcome::Error));
            RunResult::error(output::identity(job, None), None, vec![panic.to_string()])
        })
    });
    let results = Results::new(ended.collect());
    progress.finish();
    let exit = results.scenarios.iter().fold(Exit::Passed, |worst, run| worst.worse(of_outcome(run.verdict)));
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
    // The demo names engines that this build may lack; an FMU it has none of.
    let demo = sources::demo()?;
    let mut there = engines.names();
    there.retain(|engine| demo.iter().any(|source| source.scenario.engines.contains(engine)));
    Ok(jobs(demo, if args.engine.is_empty() { &there } else { &args.engine }))
}

/// Runs one job and writes its recording. One that cannot be written takes the verdict away.
fn one(
    job: &Job,
    engines: &Engines,
    worker: &WorkerCommand,
    rrd: bool,
    folder: &Path,
    progress: &Progress,
) -> RunResult {
    let write = |recording| output::write_recording(job, recording, folder, rrd);
    let result = match execute(job, engines, worker, &mut progress.of_run()) {
        Ok(Run { recording, metrics, verdict }) => match write(&recording) {
            Ok(name) => RunResult::judged(output::identity(job, Some(name)), &recording, &metrics, &verdict),
            Err(error) => {
                let (run, until_then) = (output::identity(job, None), Some((&recording, &metrics)));
                RunResult::error(run, until_then, vec![error.to_string()])
            }
        },
        Err(broken) if of_run_error(&broken.error) == Exit::Input => {
            RunResult::input(output::identity(job, None), vec![broken.error.to_string()])
        }
        Err(broken) => {
            let Broken { error, until_then } = *broken;
            let mut reasons = vec![error.to_string()];
            let name = until_then.as_ref().and_then(|(recording, _)| {
                write(recording).map_err(|unwritten| reasons.push(unwritten.to_string())).ok()
            });
            let until_then = until_then.as_ref().map(|(recording, metrics)| (recording, metrics));
            RunResult::error(output::identity(job, name), until_then, reasons)
        }
    };
    progress.ended(&job.id, words(result.verdict));
    result
}

/// What a progress line says of a run.
const fn words(outcome: Outcome) -> &'static str {
    match outcome {
        Outcome::Passed => "passed",
        Outcome::Unjudged => "done, without limits",
        Outcome::Failed => "missed a limit",
        Outcome::Input => "wrong input",
        Outcome::Error => "could not be carried out",
    }
}

fn text_of(results: &Results, args: &RunArgs) -> String {
    if args.quiet {
        let bad = results.scenarios.iter().filter(|run| !run.verdict.is_good());
        let lines = bad.map(|run| format!("{} on {}: {}\n", run.name, run.engine, run.reasons.join("; ")));
        return lines.collect::<Vec<_>>().concat();
    }
    let out = args.out.display();
    let older = match output::older_recordings(&args.out, results) {
        0 => String::new(),
        1 => ", with a recording of an earlier run".into(),
        count => format!(", with {count} recordings of earlier runs"),
    };
    let mut parts =
        vec![verdict_table(results, style(), args.verbose), format!("results and recordings: {out}{older}\n")];
    parts.extend(args.rrd.then(|| format!("look at them: {} view {out}\n", program())));
    parts.concat()
}
