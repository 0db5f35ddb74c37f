//! `servobench run`: scenarios in, verdicts out.
use crate::args::RunArgs;
use crate::engines;
use crate::exit::{CliError, Exit, of_run_error};
use crate::output;
use crate::progress::Progress;
use crate::sources;
use servobench_report::{Outcome, Results, RunResult, Style, junit, verdict_table};
use servobench_scenario::EngineName;
use servobench_suite::{Engines, Job, WorkerCommand, execute, for_each_in_parallel, jobs};
use std::io::{IsTerminal, Write};
use std::num::NonZero;
use std::path::Path;

/// Runs the scenarios, judges them and writes what came of them.
pub(crate) fn run(args: &RunArgs) -> Result<Exit, CliError> {
    let engines = engines::installed();
    let jobs = wanted_jobs(args, &engines)?;
    output::make_folder(&args.out)?;
    let worker = worker_command(&args.out)?;

    let progress = Progress::new(jobs.len(), args.quiet);
    let workers = args.jobs.map_or_else(cores, usize::from);
    let ended =
        for_each_in_parallel(&jobs, workers, |_, job| one(job, &engines, &worker, args.rrd, &args.out, &progress));
    progress.finish();

    let exit = ended.iter().fold(Exit::Passed, |worst, (_, exit)| worst.worse(*exit));
    let results = Results::new(ended.into_iter().map(|(result, _)| result).collect());
    let text = results.to_json().map_err(|error| CliError::Run(error.to_string()))?;
    output::write_file(&args.out.join("results.json"), &text)?;
    if let Some(path) = &args.junit {
        output::write_file(path, &junit(&results).map_err(|error| CliError::Run(error.to_string()))?)?;
    }
    print(&results, args)?;
    Ok(exit)
}

fn wanted_jobs(args: &RunArgs, engines: &Engines) -> Result<Vec<Job>, CliError> {
    let asked: Vec<EngineName> = args.engine.iter().map(|engine| (*engine).into()).collect();
    if !args.scenarios.is_empty() {
        return Ok(jobs(sources::load(&args.scenarios)?, &asked));
    }
    let all = engines.names();
    Ok(jobs(sources::demo()?, if asked.is_empty() { &all } else { &asked }))
}

/// Runs one job and writes its recording.
fn one(
    job: &Job,
    engines: &Engines,
    worker: &WorkerCommand,
    rrd: bool,
    folder: &Path,
    progress: &Progress,
) -> (RunResult, Exit) {
    let mut report = execute(job, engines, worker, &mut progress.of_run());
    output::write_recording(job, &mut report, folder, rrd);
    let (exit, words) = match &report.outcome {
        Ok(verdict) if verdict.passed() => (Exit::Passed, "passed"),
        Ok(_) => (Exit::Limit, "missed a limit"),
        Err(error) => (of_run_error(error), "could not be carried out"),
    };
    progress.ended(&job.id, words);
    (output::result(job, &report), exit)
}

fn print(results: &Results, args: &RunArgs) -> Result<(), CliError> {
    let mut out = std::io::stdout();
    if args.quiet {
        for run in results.scenarios.iter().filter(|run| run.verdict != Outcome::Passed) {
            let reason = run.reason.as_deref().unwrap_or_default();
            writeln!(out, "{} on {}: {reason}", run.name, run.engine)?;
        }
        return Ok(());
    }
    write!(out, "{}", verdict_table(results, style()))?;
    writeln!(out, "results and recordings: {}", args.out.display())?;
    if args.rrd {
        writeln!(out, "look at them: servobench view {}", args.out.display())?;
    }
    Ok(())
}

/// How tables are shown on standard output.
pub(super) fn style() -> Style {
    let colour = std::io::stdout().is_terminal() && std::env::var_os("NO_COLOR").is_none();
    Style { colour, ..Style::default() }
}

/// How worker processes are started: this program again.
pub(super) fn worker_command(folder: &Path) -> Result<WorkerCommand, CliError> {
    let program = std::env::current_exe().map_err(|error| CliError::Run(format!("cannot find myself: {error}")))?;
    Ok(WorkerCommand { program, folder: folder.to_owned() })
}

pub(super) fn cores() -> usize {
    std::thread::available_parallelism().map_or(1, NonZero::get)
}
