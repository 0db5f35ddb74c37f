//! `servobench run`: scenarios in, verdicts out.
mod wanted;

use crate::args::{self, Command, Keep, RunArgs};
use crate::build_id;
use crate::console::{command, print, print_parts, say, style};
use crate::engines;
use crate::error::CliError;
use crate::exit::Exit;
use crate::output;
use crate::outputs::Outputs;
use crate::sources;
use crate::suite::{
    Begun, Carrying, Files, Found, JUNIT, Ledger, deny, exit_of, how_to_resume, other_suite, suite_in, view_program,
    write_junit,
};
use crate::view_program::ViewProgram;
use servobench::Engines;
use servobench_report::{brief, verdict_table};
use servobench_results::{Digest, Folder, Kept, OF_A_SWEEP, RESULTS, Results, Runs, Suite};
use std::collections::HashSet;
use std::path::{Path, PathBuf};
use wanted::Wanted;

/// Default folder of results; those of the demo go below it, so that they do not replace others.
const OUT: &str = "servobench-out";
const OUT_OF_THE_DEMO: &str = "servobench-out/demo";

/// Runs the scenarios, judges them and writes the results; or finishes a suite that was interrupted.
pub(crate) fn run(args: &RunArgs) -> Result<Exit, CliError> {
    if args.suite.quiet {
        sources::leave_warnings_to_the_report();
    }
    match &args.resume {
        None => begun(args),
        Some(folder) => match suite_in(folder, &args.suite)? {
            Found::Begun(suite) => resumed(*suite, args),
            Found::Complete(results) => reported_again(&results, args, folder),
        },
    }
}

/// Reports a complete suite whose inputs and files are unchanged, without running anything.
fn reported_again(results: &Results, args: &RunArgs, folder: &Path) -> Result<Exit, CliError> {
    if !args.suite.quiet {
        say("nothing is left to run: scenarios, files, program, recordings and results are as they were\n");
    }
    say_what_came(results, args, folder, 0)?;
    let files = Files::named(folder, args.suite.junit.as_deref(), |_| true, &OF_A_SWEEP)?;
    if let Some(output) = &files.junit {
        write_junit(results, output)?;
    }
    Ok(exit_of(results).worse(deny(results, &args.suite.deny, args.suite.quiet)?))
}

/// A suite from its beginning.
fn begun(args: &RunArgs) -> Result<Exit, CliError> {
    let engines = engines::installed();
    let view_program = view_program(&args.suite, args.keep)?;
    let mut wanted = Wanted::of(args, &engines)?;
    if wanted.ids().next().is_none() {
        return nothing_to_run(args, wanted);
    }
    let out = args.out.clone().unwrap_or_else(|| {
        let default = if args.scenarios.is_empty() { OUT_OF_THE_DEMO } else { OUT };
        PathBuf::from(default)
    });
    let files = files(args, &out, &wanted)?;
    if !args.suite.quiet {
        say(&wanted.shown());
        if args.scenarios.is_empty() {
            say(&wanted.demo(&out));
        }
    }
    let folder = Folder::open(&out)?;
    let removed = folder.remove(&folder.former(RESULTS)?);
    let here = std::env::current_dir().map_err(|error| CliError::Read { path: ".".into(), error })?;
    let suite = Suite::new(wanted.digest(), args::command_line(), here, sources::stdin(), wanted.stems());
    let suite = suite.by(Digest::of(build_id::program().as_bytes()));
    let ledger = Ledger::begin(folder, files, wanted.take_planned(), &suite)?;
    carried_out(args, &wanted, (&engines, view_program.as_ref()), ledger, removed)
}

/// Resumes a suite: the same runs, without those that have ended.
fn resumed(begun: Begun, now: &RunArgs) -> Result<Exit, CliError> {
    let Begun { folder, suite, mut kept, command, here } = begun;
    let Command::Run(began) = command else {
        return Err(CliError::OtherCommand { folder: folder.path().to_owned(), command: "sweep" });
    };
    let args = RunArgs { suite: began.suite.resumed(&now.suite, &here), verbose: now.verbose, ..began };
    let view_program = view_program(&args.suite, args.keep)?;
    let engines = engines::installed();
    let mut wanted = Wanted::of(&args, &engines)?;
    if wanted.digest() != suite.suite {
        return Err(other_suite(folder.path(), &suite, &kept, args.suite.with.root.as_deref()));
    }
    // A result in a journal counts only for a run with the same inputs.
    kept.hold_inputs(|index| wanted.inputs(index));
    let files = files(&args, folder.path(), &wanted)?;
    if !args.suite.quiet {
        say(&format!("{} of {} runs had ended; running the others\n", kept.ended(), wanted.len()));
    }
    kept.plan(wanted.take_planned());
    let ledger = Ledger::resume(folder, files, kept, &suite);
    carried_out(&args, &wanted, (&engines, view_program.as_ref()), ledger, 0)
}

/// Runs what has not ended yet and reports all results.
fn carried_out(
    args: &RunArgs,
    wanted: &Wanted<'_>,
    (engines, view_program): (&Engines, Option<&ViewProgram>),
    ledger: Ledger,
    removed: usize,
) -> Result<Exit, CliError> {
    let carrying = Carrying { plan: wanted, args: &args.suite, keep: args.keep, engines, view_program };
    carrying.out(ledger, |ledger| wanted.note_unusable(ledger), |runs, out| say_what_came(runs, args, out, removed))
}

fn files(args: &RunArgs, out: &Path, wanted: &Wanted<'_>) -> Result<Files, CliError> {
    let ids: HashSet<&str> = wanted.ids().collect();
    Files::named(out, args.suite.junit.as_deref(), |id| ids.contains(id), &[])
}

/// Reports the mistakes when no file can be used; files of earlier runs are left alone.
fn nothing_to_run(args: &RunArgs, mut wanted: Wanted<'_>) -> Result<Exit, CliError> {
    let mut kept = Kept::new(None, wanted.take_planned());
    wanted.invalid().try_for_each(|one| kept.note(one))?;
    if let Some(path) = &args.suite.junit {
        let output = Outputs::default().anywhere(JUNIT, path)?;
        if let Err(error) = write_junit(&kept, &output) {
            say(&format!("servobench: {error}\n"));
        }
    }
    if !args.suite.quiet {
        return Err(CliError::Scenarios(wanted.into_unusable()));
    }
    print_parts(brief(&kept))?;
    Ok(Exit::Input)
}

/// Reports the results of `runs` and the folder that holds them.
fn say_what_came(runs: &dyn Runs, args: &RunArgs, out: &Path, removed: usize) -> Result<(), CliError> {
    if args.suite.quiet {
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
    let kept = runs.heads().filter(|run| run.has_recording).count();
    let what = match (args.keep, kept) {
        (Keep::All, _) => "results and recordings".to_owned(),
        (_, 0) => "results, no recordings".to_owned(),
        (_, 1) => "results and 1 recording".to_owned(),
        (_, kept) => format!("results and {kept} recordings"),
    };
    print_parts(verdict_table(runs, style(), args.verbose))?;
    let mut parts = vec![format!("{what}: {}{older}{removed}\n", out.display())];
    parts.push(how_to_resume(runs, "run", &args.suite, out));
    parts.extend(
        (args.suite.rrd && kept > 0).then(|| format!("look at them: {}\n", command(&["view", &out.to_string_lossy()]))),
    );
    print(&parts.concat())
}
