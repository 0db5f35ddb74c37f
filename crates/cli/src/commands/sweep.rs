//! `servobench sweep`: a scenario over many values of its keys, as a suite, with tables and pictures of the results.
mod outcome;
mod points;

use crate::args::{self, Command, SweepArgs};
use crate::build_id;
use crate::console::{print, say, style};
use crate::engines;
use crate::error::CliError;
use crate::exit::Exit;
use crate::sources;
use crate::suite::{
    Begun, Carrying, Files, Found, Ledger, deny, exit_of, other_suite, suite_in, view_program, write_junit,
};
use crate::view_program::ViewProgram;
use points::Points;
use servobench_report::run_count;
use servobench_results::{Digest, Folder, OF_A_SWEEP, RESULTS, Runs, Suite, TABLE_CSV, is_table_of_a_sweep};
use std::path::Path;

/// Runs every point of a sweep, judges it and reports the cost of the values; or resumes a sweep that was interrupted.
pub(crate) fn sweep(args: &SweepArgs) -> Result<Exit, CliError> {
    match (&args.resume, &args.sweep) {
        (Some(folder), _) => match suite_in(folder, &args.suite)? {
            Found::Begun(suite) => resumed(*suite, args),
            Found::Complete(results) => {
                print(&(run_count(&results, style()) + "\n"))?;
                let files = Files::named(folder, args.suite.junit.as_deref(), |_| true, &OF_A_SWEEP)?;
                if let Some(output) = &files.junit {
                    write_junit(&results, output)?;
                }
                Ok(exit_of(&results).worse(deny(&results, &args.suite.deny, args.suite.quiet)?))
            }
        },
        (None, Some(path)) => begun(path, args),
        (None, None) => Err(CliError::NoSweep),
    }
}

/// A sweep from its beginning.
fn begun(path: &Path, args: &SweepArgs) -> Result<Exit, CliError> {
    let view_program = view_program(&args.suite, args.keep)?;
    let points = Points::of(path, args)?;
    let out = args.out.clone().unwrap_or_else(|| points::default_folder(path));
    let files = files(args, &out, &points)?;
    let folder = Folder::open(&out)?;
    if is_table_of_a_sweep(&out.join(TABLE_CSV)).is_ok_and(|is_ours| !is_ours) {
        return Err(CliError::OtherTable(out.join(TABLE_CSV)));
    }
    folder.remove(&folder.former(RESULTS)?);
    let here = std::env::current_dir().map_err(|error| CliError::Read { path: ".".into(), error })?;
    let suite = Suite::new(points.digest(), args::command_line(), here, sources::stdin(), points.stems());
    let suite = suite.by(Digest::of(build_id::program().as_bytes()));
    let ledger = Ledger::begin(folder, files, points.planned(), &suite)?;
    carried_out(args, &points, ledger, view_program.as_ref())
}

/// Resumes a sweep: the same points, without those that have ended.
fn resumed(begun: Begun, now: &SweepArgs) -> Result<Exit, CliError> {
    let Begun { folder, suite, mut kept, command, here } = begun;
    let Command::Sweep(began) = command else {
        return Err(CliError::OtherCommand { folder: folder.path().to_owned(), command: "run" });
    };
    let args = SweepArgs { suite: began.suite.resumed(&now.suite, &here), ..began };
    let view_program = view_program(&args.suite, args.keep)?;
    let path = args.sweep.clone().ok_or(CliError::NoSweep)?;
    let points = Points::of(&path, &args)?;
    if points.digest() != suite.suite {
        return Err(other_suite(folder.path(), &suite, &kept, args.suite.with.root.as_deref()));
    }
    let files = files(&args, folder.path(), &points)?;
    if !args.suite.quiet {
        say(&format!("{} of {} runs had ended; running the others\n", kept.ended(), points.len()));
    }
    kept.plan(points.planned());
    let ledger = Ledger::resume(folder, files, kept, &suite);
    carried_out(&args, &points, ledger, view_program.as_ref())
}

/// Runs what has not ended yet, writes tables and pictures, and reports all results.
fn carried_out(
    args: &SweepArgs,
    points: &Points<'_>,
    ledger: Ledger,
    view_program: Option<&ViewProgram>,
) -> Result<Exit, CliError> {
    let engines = engines::installed();
    let carrying = Carrying { plan: points, args: &args.suite, keep: args.keep, engines: &engines, view_program };
    let files = ledger.out().clone();
    carrying.out(ledger, |_| {}, |runs: &dyn Runs, _| outcome::say_what_came(runs, args, points, &files))
}

fn files(args: &SweepArgs, out: &Path, points: &Points<'_>) -> Result<Files, CliError> {
    Files::named(out, args.suite.junit.as_deref(), |id| points.has_id(id), &OF_A_SWEEP)
}
