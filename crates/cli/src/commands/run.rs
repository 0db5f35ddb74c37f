//! `servobench run`: scenarios in, verdicts out.
mod ledger;
mod resume;
mod wanted;

use crate::args::{self, Keep, RunArgs};
use crate::console::{print, print_parts, program, say, style};
use crate::engines;
use crate::error::CliError;
use crate::exit::{Exit, of_outcome, of_run_error};
use crate::interrupt;
use crate::output::{self, Written};
use crate::outputs::{Output, OutputFolder, Outputs};
use crate::progress::Progress;
use crate::sources;
use crate::workers;
use ledger::{Closed, Ledger, write_junit};
use resume::{Begun, Found};
use servobench_report::{brief, verdict_table};
use servobench_results::{
    Finished, Folder, JOURNAL, Kept, Outcome, RESULTS, RunIdentity, RunResult, Runs, Suite, Unfinished,
};
use servobench_suite::{Broken, Engines, Job, Run, Workers, execute, map_in_parallel};
use std::collections::HashSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;
use wanted::{PlannedRun, Wanted};

/// Where results go unless somebody says so; those of the demo go below it, so that they take nobody else's place.
const OUT: &str = "servobench-out";
const OUT_OF_THE_DEMO: &str = "servobench-out/demo";

/// The option that names the JUnit report.
const JUNIT: &str = "--junit";

/// Where the suite writes: nothing that it reads, and nothing twice.
struct Files {
    out: OutputFolder,
    junit: Option<Output>,
}

impl Files {
    fn named(args: &RunArgs, out: &Path, wanted: &Wanted) -> Result<Self, CliError> {
        let mut outputs = Outputs::default();
        let ids: HashSet<&str> = wanted.runs().map(|(_, run)| run.id()).collect();
        let is_ours = move |name: &str| {
            [RESULTS, JOURNAL].contains(&name) || output::run_of(name).is_some_and(|id| ids.contains(id))
        };
        let out = outputs.folder("--out", out, is_ours)?;
        let junit = args.junit.as_deref().map(|path| outputs.anywhere(JUNIT, path)).transpose()?;
        Ok(Self { out, junit })
    }
}

/// Runs the scenarios, judges them and writes what came of them; or what is left of a suite that was ended before its time.
pub(crate) fn run(args: &RunArgs) -> Result<Exit, CliError> {
    match &args.resume {
        None => begun(args),
        Some(folder) => match resume::suite_in(folder, args)? {
            Found::Begun(suite) => resumed(*suite),
            Found::Complete(results) => {
                say_what_came(&results, args, folder, 0)?;
                Ok(exit_of(&results))
            }
        },
    }
}

/// A suite from its beginning.
fn begun(args: &RunArgs) -> Result<Exit, CliError> {
    let engines = engines::installed();
    if args.rrd && args.keep == Keep::None {
        return Err(CliError::NothingForTheViewer);
    }
    let mut wanted = Wanted::of(args, &engines)?;
    if wanted.runs().next().is_none() {
        return nothing_to_run(args, wanted);
    }
    let out = args.out.clone().unwrap_or_else(|| {
        let default = if args.scenarios.is_empty() { OUT_OF_THE_DEMO } else { OUT };
        PathBuf::from(default)
    });
    let files = Files::named(args, &out, &wanted)?;
    if !args.quiet {
        say(&wanted.shown());
        if args.scenarios.is_empty() {
            say(&wanted.demo(&out));
        }
    }
    let folder = Folder::open(&out)?;
    let removed = folder.remove(&folder.former(RESULTS)?);
    let here = std::env::current_dir().map_err(|error| CliError::Read { path: ".".into(), error })?;
    let suite = Suite::new(wanted.digest(args), args::command_line(), here, sources::stdin(), wanted.stems());
    let ledger = Ledger::begin(folder, files, wanted.take_planned(), &suite)?;
    carried_out(args, &wanted, &engines, ledger, removed)
}

/// The rest of a suite: the same runs, of which those that ended are not run again.
fn resumed(begun: Begun) -> Result<Exit, CliError> {
    let Begun { folder, suite, mut kept, args } = begun;
    let engines = engines::installed();
    let mut wanted = Wanted::of(&args, &engines)?;
    if wanted.digest(&args) != suite.suite {
        return Err(CliError::OtherSuite(folder.path().to_owned()));
    }
    let files = Files::named(&args, folder.path(), &wanted)?;
    if !args.quiet {
        say(&format!("{} of {} runs had ended; running the others\n", kept.ended(), wanted.len()));
    }
    kept.plan(wanted.take_planned());
    let ledger = Ledger::resume(folder, files, kept, &suite);
    carried_out(&args, &wanted, &engines, ledger, 0)
}

/// Runs what has not ended yet, and says what came of all.
fn carried_out(
    args: &RunArgs,
    wanted: &Wanted,
    engines: &Engines,
    ledger: Ledger,
    removed: usize,
) -> Result<Exit, CliError> {
    let ledger = Arc::new(ledger);
    let for_signals = Arc::clone(&ledger);
    interrupt::watch_suite(ledger.folder().path(), move || {
        if let Some(Closed { kept, troubles }) = for_signals.close() {
            // What cannot be read is among the troubles.
            brief(&kept).map_while(Result::ok).for_each(|part| say(&part));
            say_all(&troubles);
        }
    })?;
    wanted.note_unusable(&ledger);
    run_all(args, wanted, engines, &ledger)?;
    interrupt::end_if_ending();
    let Some(Closed { kept, troubles }) = ledger.close() else { return Ok(Exit::Interrupted) };
    let exit = troubles.iter().fold(exit_of(&kept), |worst, trouble| worst.worse(trouble.exit()));
    // What could not be written does not keep the verdicts from being said.
    let said = say_what_came(&kept, args, ledger.folder().path(), removed);
    say_all(&troubles);
    said?;
    Ok(if interrupt::is_stopping() { Exit::Interrupted } else { exit })
}

/// What a suite ends with.
fn exit_of(runs: &dyn Runs) -> Exit {
    runs.heads().fold(Exit::Passed, |worst, run| worst.worse(of_outcome(run.verdict)))
}

fn say_all(troubles: &[CliError]) {
    for trouble in troubles {
        say(&format!("servobench: {trouble}\n"));
    }
}

/// Every file is wrong: the mistakes are what is said, and nothing of earlier runs is touched.
fn nothing_to_run(args: &RunArgs, mut wanted: Wanted) -> Result<Exit, CliError> {
    let mut kept = Kept::new(None, wanted.take_planned());
    wanted.invalid().try_for_each(|one| kept.note(one))?;
    if let Some(path) = &args.junit {
        let output = Outputs::default().anywhere(JUNIT, path)?;
        if let Err(error) = write_junit(&kept, &output) {
            say(&format!("servobench: {error}\n"));
        }
    }
    if !args.quiet {
        return Err(CliError::Scenarios(wanted.into_unusable()));
    }
    print_parts(brief(&kept))?;
    Ok(Exit::Input)
}

/// Runs all that have not ended. Once the suite is to stop, none begins.
fn run_all(args: &RunArgs, wanted: &Wanted, engines: &Engines, ledger: &Ledger) -> Result<(), CliError> {
    let folder = ledger.folder().path();
    let limits = workers::limits(args.time_limit, args.memory.memory_limit);
    let workers = workers::of(folder, args.worker_timeout, limits)?;
    let pending: Vec<(usize, &PlannedRun)> = wanted.runs().filter(|(index, _)| !ledger.has(*index)).collect();
    let progress = Progress::new(pending.len(), args.quiet);
    let without_a_result = |index, run: &PlannedRun, why: String| {
        progress.ended(run.id(), Outcome::Error.word());
        let identity = if let Ok(job) = run.job(args) {
            output::identity(&job, Written::default())
        } else {
            // Nothing is known of it but what it was called.
            let Unfinished { name, file, engine } = ledger.planned(index).unwrap_or_default();
            RunIdentity { name, file, engine, inputs: run.inputs(), ..RunIdentity::default() }
        };
        ledger.note(Finished { index, seconds: 0.0, result: RunResult::error(identity, None, vec![why]) });
    };
    let ended = map_in_parallel(
        &pending,
        workers::at_a_time(args.jobs, limits),
        |(_, run)| {
            let job = if interrupt::is_stopping() { None } else { Some(run.job(args)) };
            let memory = job.as_ref().and_then(|job| job.as_ref().ok()).map_or(0, Job::memory);
            (job, memory)
        },
        |(index, run), job| match job.filter(|_| !interrupt::is_stopping()) {
            None => {}
            Some(Err(changed)) => without_a_result(*index, run, changed.to_string()),
            Some(Ok(job)) => {
                let start = Instant::now();
                let result = one(&job, engines, &workers, args, ledger.out(), &progress);
                ledger.note(Finished { index: *index, seconds: start.elapsed().as_secs_f64(), result });
            }
        },
    );
    for ((index, run), ended) in pending.iter().zip(ended) {
        if let Err(panic) = ended {
            without_a_result(*index, run, panic.to_string());
        }
    }
    progress.finish();
    workers::dismiss(&workers);
    Ok(())
}

/// Runs one job and writes its recording, if that is to stay. One that cannot be written takes the verdict away.
fn one(
    job: &Job,
    engines: &Engines,
    workers: &Workers,
    args: &RunArgs,
    out: &OutputFolder,
    progress: &Progress,
) -> RunResult {
    let write = |recording, outcome, shown: &dyn Fn() -> servobench_view::Verdict| {
        if output::is_kept(args.keep, outcome) {
            output::write_recording(job, recording, out, args.rrd.then(shown))
        } else {
            Ok(Written::default())
        }
    };
    let result = match execute(job, engines, workers, &mut progress.of_run(&job.id, workers.slow(job))) {
        Ok(Run { recording, metrics, verdict }) => {
            let judged = RunResult::judged(output::identity(job, Written::default()), &recording, &metrics, &verdict);
            let shown = || output::said_of(judged.verdict, judged.reasons.clone(), judged.warnings.clone());
            match write(&recording, judged.verdict, &shown) {
                Ok(written) => written.of(judged),
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
                let said = reasons.clone();
                let shown = || servobench_view::Verdict { outcome, reasons: said.clone(), warnings: Vec::new() };
                write(recording, Outcome::Error, &shown).unwrap_or_else(|(unwritten, written)| {
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

/// Says what came of `runs`, and where it is.
fn say_what_came(runs: &dyn Runs, args: &RunArgs, out: &Path, removed: usize) -> Result<(), CliError> {
    if args.quiet {
        return print_parts(brief(runs));
    }
    let older = match output::older_recordings(out, runs) {
        0 => String::new(),
        1 => ", with a recording that they do not name".into(),
        count => format!(", with {count} recordings that they do not name"),
    };
    let removed = match removed {
        0 => String::new(),
        1 => "; removed 1 file of the run before".into(),
        removed => format!("; removed {removed} files of the run before"),
    };
    let out = out.display();
    let kept = runs.heads().filter(|run| run.has_recording).count();
    let what = match (args.keep, kept) {
        (Keep::All, _) => "results and recordings".to_owned(),
        (_, 0) => "results, no recordings".to_owned(),
        (_, 1) => "results and 1 recording".to_owned(),
        (_, kept) => format!("results and {kept} recordings"),
    };
    print_parts(verdict_table(runs, style(), args.verbose))?;
    let mut parts = vec![format!("{what}: {out}{older}{removed}\n")];
    let trust = if args.fmus.allow_unisolated_fmus { " --allow-unisolated-fmus" } else { "" };
    let resume = format!("{} run --resume {out}{trust}\n", program());
    let (unfinished, errors) = (runs.unfinished().count(), runs.count_of(Outcome::Error));
    if unfinished > 0 {
        let of = unfinished + runs.heads().count();
        parts.push(format!("{unfinished} of {of} runs have no result yet; to run them: {resume}"));
    } else if errors > 0 {
        let runs = if errors == 1 { "the run that ended" } else { "the runs that ended" };
        parts.push(format!("to try {runs} with an error again: {resume}"));
    }
    parts.extend((args.rrd && kept > 0).then(|| format!("look at them: {} view {out}\n", program())));
    print(&parts.concat())
}
