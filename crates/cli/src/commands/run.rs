//! `servobench run`: scenarios in, verdicts out.
mod ledger;
mod resume;
mod wanted;

use crate::args::{self, Keep, RunArgs};
use crate::console::{print, program, say, style};
use crate::engines;
use crate::error::CliError;
use crate::exit::{Exit, of_outcome, of_run_error};
use crate::interrupt;
use crate::output::{self, Written};
use crate::outputs::{Output, OutputFolder, Outputs};
use crate::progress::Progress;
use crate::sources;
use crate::workers;
use ledger::{Closed, Ledger};
use resume::{Begun, Found};
use servobench_report::{brief, junit, verdict_table};
use servobench_results::{Folder, Former, JOURNAL, Outcome, RESULTS, Results, RunIdentity, RunResult, Suite};
use servobench_suite::{Broken, Engines, Job, Run, Workers, execute, map_in_parallel};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};
use wanted::Wanted;

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
        let names = wanted.jobs.iter().flat_map(output::names_of).chain([RESULTS, JOURNAL].map(str::to_owned));
        let out = outputs.folder("--out", out, names)?;
        let junit = args.junit.as_deref().map(|path| outputs.anywhere(JUNIT, path)).transpose()?;
        Ok(Self { out, junit })
    }
}

/// What a run came to, and how long that took by the clock.
type Timed = (RunResult, Duration);

/// Runs the scenarios, judges them and writes what came of them; or what is left of a suite that was ended before its time.
pub(crate) fn run(args: &RunArgs) -> Result<Exit, CliError> {
    match &args.resume {
        None => begun(args),
        Some(folder) => match resume::suite_in(folder, args)? {
            Found::Begun(suite) => resumed(*suite),
            Found::Complete(results) => {
                print(&text_of(&results, args, folder, &Former::default()))?;
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
    let wanted = Wanted::of(args, &engines)?;
    if wanted.jobs.is_empty() {
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
    let former = folder.remove_former(RESULTS);
    let here = std::env::current_dir().map_err(|error| CliError::Read { path: ".".into(), error })?;
    let suite = Suite::new(wanted.digest(args), args::command_line(), here, sources::stdin(), wanted.stems());
    let ledger = Ledger::begin(folder, files, wanted.planned(), &suite)?;
    carried_out(args, &wanted, &engines, ledger, &former)
}

/// The rest of a suite: the same runs, of which those that ended are not run again.
fn resumed(begun: Begun) -> Result<Exit, CliError> {
    let Begun { folder, journal, suite, finished, args } = begun;
    let engines = engines::installed();
    let wanted = Wanted::of(&args, &engines)?;
    if wanted.digest(&args) != suite.suite {
        return Err(CliError::OtherSuite(folder.path().to_owned()));
    }
    let files = Files::named(&args, folder.path(), &wanted)?;
    if !args.quiet {
        say(&format!("{} of {} runs had ended; running the others\n", finished.len(), wanted.planned().len()));
    }
    let ledger = Ledger::resume(folder, files, wanted.planned(), (journal, &suite), finished);
    carried_out(&args, &wanted, &engines, ledger, &Former::default())
}

/// Runs what has not ended yet, and says what came of all.
fn carried_out(
    args: &RunArgs,
    wanted: &Wanted,
    engines: &Engines,
    ledger: Ledger,
    former: &Former,
) -> Result<Exit, CliError> {
    let ledger = Arc::new(ledger);
    let for_signals = Arc::clone(&ledger);
    interrupt::watch_suite(ledger.folder().path(), move || {
        if let Some(Closed { results, troubles }) = for_signals.close() {
            say(&brief(&results));
            say_all(&troubles);
        }
    })?;
    wanted.note_unusable(&ledger);
    run_all(args, wanted, engines, &ledger)?;
    interrupt::end_if_ending();
    let Some(Closed { results, troubles }) = ledger.close() else { return Ok(Exit::Interrupted) };
    let exit = troubles.iter().fold(exit_of(&results), |worst, trouble| worst.worse(trouble.exit()));
    // What could not be written does not keep the verdicts from being said.
    print(&text_of(&results, args, ledger.folder().path(), former))?;
    say_all(&troubles);
    Ok(if interrupt::is_stopping() { Exit::Interrupted } else { exit })
}

/// What a suite ends with.
fn exit_of(results: &Results) -> Exit {
    results.scenarios.iter().fold(Exit::Passed, |worst, run| worst.worse(of_outcome(run.verdict)))
}

fn say_all(troubles: &[CliError]) {
    for trouble in troubles {
        say(&format!("servobench: {trouble}\n"));
    }
}

/// Every file is wrong: the mistakes are what is said, and nothing of earlier runs is touched.
fn nothing_to_run(args: &RunArgs, wanted: Wanted) -> Result<Exit, CliError> {
    let runs = wanted.invalid();
    let times = vec![Duration::ZERO; runs.len()];
    let results = Results::new(runs);
    if let Some(path) = &args.junit {
        let output = Outputs::default().anywhere(JUNIT, path)?;
        let text = junit(&results, &times).map_err(CliError::from);
        if let Err(error) = text.and_then(|text| output.write(text)) {
            say(&format!("servobench: {error}\n"));
        }
    }
    if !args.quiet {
        return Err(CliError::Scenarios(wanted.into_unusable()));
    }
    print(&brief(&results))?;
    Ok(Exit::Input)
}

/// Runs all jobs that have not ended. Once the suite is to stop, none begins.
fn run_all(args: &RunArgs, wanted: &Wanted, engines: &Engines, ledger: &Ledger) -> Result<(), CliError> {
    let folder = ledger.folder().path();
    let limits = workers::limits(args.time_limit, args.memory.memory_limit);
    let workers = workers::of(folder, args.worker_timeout, limits)?;
    let pending: Vec<(usize, &Job)> = wanted.places().filter(|(index, _)| !ledger.has(*index)).collect();
    let progress = Progress::new(pending.len(), args.quiet);
    let ended = map_in_parallel(
        &pending,
        workers::at_a_time(args.jobs, limits),
        |(_, job)| job.memory(),
        |(index, job)| {
            if interrupt::is_stopping() {
                return;
            }
            let start = Instant::now();
            let result = one(job, engines, &workers, args, ledger.out(), &progress);
            ledger.note(*index, result, start.elapsed());
        },
    );
    for ((index, job), ended) in pending.iter().zip(ended) {
        if let Err(panic) = ended {
            progress.ended(&job.id, Outcome::Error.word());
            let run = output::identity(job, Written::default());
            ledger.note(*index, RunResult::error(run, None, vec![panic.to_string()]), Duration::ZERO);
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
    let write = |recording, outcome, shown: servobench_view::Verdict| {
        if output::is_kept(args.keep, outcome) {
            output::write_recording(job, recording, out, args.rrd.then_some(shown))
        } else {
            Ok(Written::default())
        }
    };
    let result = match execute(job, engines, workers, &mut progress.of_run(&job.id, workers.slow(job))) {
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

fn text_of(results: &Results, args: &RunArgs, out: &Path, former: &Former) -> String {
    if args.quiet {
        return brief(results);
    }
    let older = match output::older_recordings(out, results) {
        0 => String::new(),
        1 => ", with a recording that they do not name".into(),
        count => format!(", with {count} recordings that they do not name"),
    };
    let removed = match former {
        Former { stays: Some(why), .. } => format!("; what the run before left stays: {why}"),
        Former { removed: 0, .. } => String::new(),
        Former { removed: 1, .. } => "; removed 1 file of the run before".into(),
        Former { removed, .. } => format!("; removed {removed} files of the run before"),
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
    if !results.unfinished.is_empty() {
        let (count, of) = (results.unfinished.len(), results.unfinished.len() + results.scenarios.len());
        let trust = if args.fmus.allow_unisolated_fmus { " --allow-unisolated-fmus" } else { "" };
        parts.push(format!(
            "{count} of {of} runs have no result yet; to run them: {} run --resume {out}{trust}\n",
            program()
        ));
    }
    parts.extend((args.rrd && kept > 0).then(|| format!("look at them: {} view {out}\n", program())));
    parts.concat()
}
