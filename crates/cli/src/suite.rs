//! Carries out a suite: its runs in parallel, each noted when it ends, so that any end of the program keeps them.
mod complete;
mod denied;
mod files;
mod held;
mod ledger;
mod resume;

pub(crate) use denied::deny;
pub(crate) use files::{Files, JUNIT};
pub(crate) use ledger::{Closed, Ledger, write_junit};
pub(crate) use resume::{Begun, Found, other_suite, suite_in};

use crate::args::{Keep, SuiteArgs};
use crate::console::{command, say};
use crate::error::CliError;
use crate::exit::{Exit, of_outcome, of_run_error};
use crate::interrupt;
use crate::output::{self, Written};
use crate::outputs::OutputFolder;
use crate::progress::Progress;
use crate::view_program::ViewProgram;
use crate::workers;
use servobench::preview::warnings;
use servobench::size::memory;
use servobench::{Engines, Run};
use servobench_report::{Denied, Style, brief, run_count};
use servobench_results::{Finished, Outcome, RunIdentity, RunResult, Runs, Unfinished};
use servobench_suite::{Broken, Job, Workers, execute, map_in_parallel};
use servobench_view_request as view;
use std::borrow::Cow;
use std::path::Path;
use std::sync::Arc;
use std::time::Instant;
use thiserror::Error;

/// The runs of a suite by index, each prepared when its turn comes, so that their number hardly affects memory.
pub(crate) trait Plan: Sync {
    /// Indices of the runs, without those of files that cannot be used.
    fn places(&self) -> Box<dyn Iterator<Item = usize> + '_>;
    /// The name of a run, which its files have too.
    fn id(&self, index: usize) -> Cow<'_, str>;
    /// A run; an error if its inputs have changed since the suite began.
    fn job(&self, index: usize) -> Result<Job, NotReady>;
    /// Identity of a run that is not carried out, besides its name.
    fn identity(&self, index: usize) -> RunIdentity;
    /// True if the runs are one scenario with a few varied keys: results name only those, and there are too many runs to report the end of
    /// each.
    fn is_sweep(&self) -> bool;
}

/// Reason why a run is not carried out.
#[derive(Debug, Error)]
pub(crate) enum NotReady {
    #[error("the scenario, or a file that it names, has changed since the suite began: run the suite again")]
    Changed,
    #[error("{}", .0.join("\n"))]
    Invalid(Vec<String>),
}

/// Settings with which a suite is carried out.
#[derive(Clone, Copy)]
pub(crate) struct Carrying<'a> {
    pub(crate) plan: &'a dyn Plan,
    pub(crate) args: &'a SuiteArgs,
    pub(crate) keep: Keep,
    pub(crate) engines: &'a Engines,
    /// Draws each recording that is kept.
    pub(crate) view_program: Option<&'a ViewProgram>,
}

/// The program that draws recordings, if `args` request drawings; `keep` selects the recordings. To be called before anything runs.
pub(crate) fn view_program(args: &SuiteArgs, keep: Keep) -> Result<Option<ViewProgram>, CliError> {
    match (args.rrd, keep) {
        (false, _) => Ok(None),
        (true, Keep::None) => Err(CliError::NothingForTheViewer),
        (true, Keep::All | Keep::Failed) => Ok(Some(ViewProgram::find()?)),
    }
}

impl Carrying<'_> {
    /// Runs what has not ended yet and lets `end` report all results. `begun` notes results that exist before anything runs.
    pub(crate) fn out(
        self,
        ledger: Ledger,
        begun: impl FnOnce(&Ledger),
        end: impl FnOnce(&dyn Runs, &Path) -> Result<(), CliError>,
    ) -> Result<Exit, CliError> {
        let ledger = Arc::new(ledger);
        let (for_signals, is_sweep) = (Arc::clone(&ledger), self.plan.is_sweep());
        interrupt::watch_suite(ledger.folder().path(), move || {
            if let Some(Closed { kept, troubles }) = for_signals.close() {
                if is_sweep {
                    say(&(run_count(&kept, Style::default()) + "\n"));
                } else {
                    // Unreadable results are among the troubles.
                    brief(&kept).map_while(Result::ok).for_each(|part| say(&part));
                }
                say_all(&troubles);
            }
        })?;
        begun(&ledger);
        self.run_all(&ledger)?;
        interrupt::end_if_ending();
        let Some(Closed { kept, troubles }) = ledger.close() else { return Ok(Exit::Interrupted) };
        let exit = troubles.iter().fold(exit_of(&kept), |worst, trouble| worst.worse(trouble.exit()));
        // Verdicts are reported even if files could not be written.
        let said = end(&kept, ledger.folder().path());
        say_all(&troubles);
        said?;
        let exit = exit.worse(deny(&kept, &self.args.deny, self.args.quiet)?);
        Ok(if interrupt::is_stopping() { Exit::Interrupted } else { exit })
    }

    /// Runs all that have not ended. After a stop, none begins.
    fn run_all(self, ledger: &Ledger) -> Result<(), CliError> {
        let Self { plan, args, .. } = self;
        let limits = workers::limits(args.time_limit, args.memory.memory_limit);
        let workers = workers::of(ledger.folder().path(), args.worker_timeout, limits)?;
        let pending: Vec<usize> = plan.places().filter(|index| !ledger.has(*index)).collect();
        let progress = Progress::new(pending.len(), args.quiet);
        let progress = if plan.is_sweep() { progress.by_percent() } else { progress };
        let not_made = |index| {
            let Unfinished { name, file, engine, axis } = ledger.planned(index).unwrap_or_default();
            RunIdentity { name, file, engine, axis, ..plan.identity(index) }
        };
        let not_ready = |index, why: NotReady| {
            let result = match why {
                NotReady::Changed => RunResult::error(not_made(index), None, vec![why.to_string()]),
                NotReady::Invalid(reasons) => RunResult::invalid(not_made(index), reasons),
            };
            progress.ended(&plan.id(index), result.verdict.word());
            ledger.note(Finished { index, seconds: 0.0, result });
        };
        let ended = map_in_parallel(
            &pending,
            workers::at_a_time(args.jobs, limits),
            |index| {
                let job = if interrupt::is_stopping() { None } else { Some(plan.job(*index)) };
                let memory = job.as_ref().and_then(|job| job.as_ref().ok()).map_or(0, |job| memory(&job.scenario));
                (job, memory)
            },
            |index, job| match job.filter(|_| !interrupt::is_stopping()) {
                None => {}
                Some(Err(why)) => not_ready(*index, why),
                Some(Ok(job)) => {
                    let start = Instant::now();
                    let result = self.one(&job, &workers, ledger.out(), &progress);
                    ledger.note(Finished { index: *index, seconds: start.elapsed().as_secs_f64(), result });
                }
            },
        );
        for (index, ended) in pending.iter().zip(ended) {
            if let Err(panic) = ended {
                let identity = match plan.job(*index) {
                    Ok(job) => self.identity(&job, Written::default()),
                    Err(_) => not_made(*index),
                };
                progress.ended(&plan.id(*index), Outcome::Error.word());
                let result = RunResult::error(identity, None, vec![panic.to_string()]);
                ledger.note(Finished { index: *index, seconds: 0.0, result });
            }
        }
        progress.finish();
        workers::dismiss(&workers);
        Ok(())
    }

    /// Runs one job and writes its recording, if that is kept. A failed write makes the outcome an error.
    fn one(self, job: &Job, workers: &Workers, out: &OutputFolder, progress: &Progress) -> RunResult {
        let write = |recording, outcome, shown: &dyn Fn() -> view::Verdict| {
            if output::is_kept(self.keep, outcome) {
                output::write_recording(job, recording, out, self.view_program.map(|program| (program, shown())))
            } else {
                Ok(Written::default())
            }
        };
        let listen = &mut progress.of_run(&job.id, workers.slow(job));
        let result = match execute(job, self.engines, workers, listen) {
            Ok(Run { recording, metrics, verdict }) => {
                let identity = self.identity(job, Written::default());
                let judged = RunResult::judged(identity, &recording, &metrics, &verdict);
                let shown = || output::said_of(judged.verdict, judged.reasons.clone(), judged.warnings.clone());
                match write(&recording, judged.verdict, &shown) {
                    Ok(written) => written.of(judged),
                    Err((error, written)) => {
                        let (run, until_then) = (self.identity(job, written), Some((&recording, &metrics)));
                        RunResult::error(run, until_then, vec![error.to_string()])
                    }
                }
            }
            Err(broken) if of_run_error(&broken.error) == Exit::Input => {
                RunResult::invalid(self.identity(job, Written::default()), vec![broken.error.to_string()])
            }
            Err(broken) => {
                let Broken { error, until_then } = *broken;
                let mut reasons = vec![error.to_string()];
                let written = until_then.as_ref().map(|(recording, _)| {
                    let outcome = view::Outcome::Failed;
                    let said = reasons.clone();
                    let shown = || view::Verdict { outcome, reasons: said.clone(), warnings: Vec::new() };
                    write(recording, Outcome::Error, &shown).unwrap_or_else(|(unwritten, written)| {
                        reasons.push(unwritten.to_string());
                        written
                    })
                });
                let until_then = until_then.as_ref().map(|(recording, metrics)| (recording, metrics));
                RunResult::error(self.identity(job, written.unwrap_or_default()), until_then, reasons)
            }
        };
        progress.ended(&job.id, result.verdict.word());
        result
    }

    fn identity(self, job: &Job, written: Written) -> RunIdentity {
        let mut identity = output::identity(job, written);
        let is_sweep = self.plan.is_sweep();
        if is_sweep {
            identity.parameters.clear();
        }
        // A sweep has as many scenarios as runs, and one warning would stand in most of them.
        if !is_sweep || self.args.deny.kinds().contains(&Denied::Warnings) {
            identity.check_warnings = Some(warnings(&job.scenario, job.engine));
        }
        identity
    }
}

/// Exit code of a suite.
pub(crate) fn exit_of(runs: &dyn Runs) -> Exit {
    runs.heads().fold(Exit::Passed, |worst, run| worst.worse(of_outcome(run.verdict)))
}

fn say_all(troubles: &[CliError]) {
    for trouble in troubles {
        say(&format!("servobench: {trouble}\n"));
    }
}

/// Advice for runs that are left or ended with an error: `3 of 8 runs have no result yet; to run them: servobench run --resume DIR`; empty
/// without any.
pub(crate) fn how_to_resume(runs: &dyn Runs, subcommand: &str, args: &SuiteArgs, out: &Path) -> String {
    let mut words = vec![subcommand.to_owned(), "--resume".to_owned(), out.to_string_lossy().into_owned()];
    // Options that a journal does not hold.
    words.extend(args.fmus.allow_unisolated_fmus.then(|| "--allow-unisolated-fmus".to_owned()));
    for (option, path) in [("--root", &args.with.root), ("--junit", &args.junit)] {
        words.extend(path.iter().flat_map(|path| [option.to_owned(), path.to_string_lossy().into_owned()]));
    }
    let resume = command(&words.iter().map(String::as_str).collect::<Vec<_>>()) + "\n";
    let (unfinished, errors) = (runs.unfinished().count(), runs.count_of(Outcome::Error));
    if unfinished > 0 {
        let of = unfinished + runs.heads().count();
        format!("{unfinished} of {of} runs have no result yet; to run them: {resume}")
    } else if errors > 0 {
        let runs = if errors == 1 { "the run that ended" } else { "the runs that ended" };
        format!("to try {runs} with an error again: {resume}")
    } else {
        String::new()
    }
}
