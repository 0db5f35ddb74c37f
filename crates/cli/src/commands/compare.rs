//! `servobench compare`: runs side by side, with the differences in their scenarios and in their results.
mod earlier;
mod heading;
mod labels;
mod recording;
mod seeds;
mod slowing;
mod variants;

use crate::args::{CompareArgs, Equal};
use crate::console::{command, print, say, style};
use crate::engines;
use crate::error::{CliError, FailedRun};
use crate::exit::{Exit, of_outcome};
use crate::interrupt;
use crate::output::{self, Written};
use crate::outputs::{OutputFolder, Outputs};
use crate::progress::Progress;
use crate::suite::deny;
use crate::view_program::ViewProgram;
use crate::workers;
use earlier::Earlier;
use servobench::Run;
use servobench::preview::warnings;
use servobench::size::memory;
use servobench_report::{Compared, Comparison, Noise};
use servobench_results::{COMPARISON, Folder, Outcome, Results, RunResult};
use servobench_suite::{
    Job, RunError, comparable, equal_length, execute, limits_agree, map_in_parallel, only_setpoints_differ,
    setpoints_have_closed_form,
};
use servobench_view_request::check_labels;
use slowing::Slowing;
use variants::Wanted;

/// Runs the scenarios in their variants on one engine, reports differences and, where decidable, the winner and its lead, and writes one
/// recording of all runs.
pub(crate) fn compare(args: &CompareArgs) -> Result<Exit, CliError> {
    let mut wanted = variants::wanted(args)?;
    let earlier = earlier_runs(args, &wanted)?;
    if wanted.len() + earlier.len() < 2 {
        return Err(CliError::TooFewScenarios);
    }
    if let labels @ [_, _, ..] = wanted.iter().map(|one| one.label.as_str()).collect::<Vec<_>>().as_slice() {
        check_labels(labels)?;
    }
    let mut jobs: Vec<Job> = wanted.iter().map(|one| one.job.clone()).collect();
    comparable(&jobs)?;
    let has_closed_form = earlier.is_empty() && only_setpoints_differ(&jobs) && setpoints_have_closed_form(&jobs);
    let (mut slowing, mut target) = (None, None);
    match &args.equal {
        None => {}
        Some(Equal::Limits) => limits_agree(&jobs)?,
        Some(Equal::Slowed(term)) => {
            target = slowing::target(term, &jobs.iter().collect::<Vec<_>>())?;
            slowing = slowing::without_runs(term, target, &mut jobs)?;
        }
    }
    let name = recording::name(&wanted);
    // The comparison itself does not need it.
    let view_program = ViewProgram::find().inspect_err(|missing| {
        say(&format!("servobench: warning: no recording for the viewer: {missing}\n"));
    });
    let out = Outputs::default().folder("--out", &args.out, |one| one == name || one == COMPARISON)?;
    let folder = Folder::open(out.path())?;
    let former = folder.former(COMPARISON)?;
    interrupt::watch(&args.out)?;
    let limits = workers::limits(args.time_limit, args.memory.memory_limit);
    if let (Some(Equal::Slowed(term)), None) = (&args.equal, &slowing) {
        let workers = workers::of(&args.out, args.worker_timeout, limits)?;
        let at_a_time = workers::at_a_time(None, limits);
        slowing = Some(slowing::by_runs(term, target, &mut jobs, (&workers, at_a_time))?);
    }
    for (one, job) in wanted.iter_mut().zip(jobs) {
        one.job = job;
    }
    let of_seeds = seeds::jobs(&wanted);
    let jobs: Vec<&Job> = wanted.iter().map(|one| &one.job).chain(of_seeds.iter().map(|(_, job)| job)).collect();
    let mut runs = carried_out(args, &jobs)?;
    let seeded = seeded(&wanted, &of_seeds, runs.split_off(wanted.len()));
    let length = equal_length(&wanted.iter().map(|one| one.job.clone()).collect::<Vec<_>>());

    folder.remove(&former);
    if let Ok(program) = &view_program {
        recording::write(program, &out, &name, &wanted, &runs)?;
    }
    let drawn = view_program.is_ok().then_some(name.as_str());
    let results = results(drawn, &wanted, &runs);
    let judged = results.iter().chain(seeded.iter().flatten());
    let exit = judged.fold(Exit::Passed, |worst, run| worst.worse(of_outcome(run.verdict)));
    let all = Results::new(results.clone());
    let now = wanted.iter().zip(&results).zip(&runs).zip(&seeded).map(|(((one, result), run), seeds)| Compared {
        label: &one.label,
        result,
        moves: &run.recording.moves,
        noise: if one.job.scenario.seeds().is_empty() { Noise::None } else { Noise::Seeds(seeds) },
    });
    // Earlier results have one seed; whether they had random numbers is taken from the scenario of the same name now.
    let before = earlier.iter().map(|one| {
        let is_random = wanted.iter().any(|now| !now.job.scenario.seeds().is_empty());
        let noise = if is_random { Noise::Seeds(&[]) } else { Noise::None };
        Compared { label: &one.label, result: &one.result, moves: &[], noise }
    });
    let comparison = Comparison::new(now.chain(before).collect()).with_equal_lengths(length);
    let comparison = comparison.made_equal(slowing.as_ref().and_then(Slowing::metric));
    let comparison = if has_closed_form { comparison } else { comparison.of_more_than_set_points() };
    let has_something = comparison.has_something_to_compare();
    let heading = heading::heading(args, &wanted, &earlier, slowing.as_ref());
    let text = text_of(args, &comparison, &heading, drawn);
    let json = all.to_json()?;
    write_list(&out, &json)?;
    if !has_something {
        return Err(CliError::NothingToCompare);
    }
    print(&text)?;
    Ok(exit.worse(deny(&all, &args.deny, false)?))
}

fn write_list(out: &OutputFolder, json: &str) -> Result<(), CliError> {
    out.file(COMPARISON)?.write(json)?;
    interrupt::told();
    Ok(())
}

/// The runs of earlier results shown beside those of now.
fn earlier_runs(args: &CompareArgs, wanted: &[Wanted]) -> Result<Vec<Earlier>, CliError> {
    let jobs: Vec<&Job> = wanted.iter().map(|one| &one.job).collect();
    let taken: Vec<&str> = wanted.iter().map(|one| one.label.as_str()).collect();
    earlier::read(&args.against, &jobs, &taken)
}

/// Results of the runs, which share the recording `name` if it was drawn.
fn results(name: Option<&str>, wanted: &[Wanted], runs: &[Run]) -> Vec<RunResult> {
    let name = name.map(str::to_owned);
    let written = Written { recording: name.clone(), files: name.into_iter().collect(), ..Written::default() };
    let each = wanted.iter().zip(runs).map(|(one, run)| {
        let mut identity = output::identity(&one.job, written.clone());
        identity.check_warnings = Some(warnings(&one.job.scenario, one.job.engine));
        RunResult::judged(identity, &run.recording, &run.metrics, &run.verdict)
    });
    each.collect()
}

/// Results of the runs with other seeds, for each run.
fn seeded(wanted: &[Wanted], jobs: &[(usize, Job)], runs: Vec<Run>) -> Vec<Vec<RunResult>> {
    let mut all: Vec<Vec<RunResult>> = vec![Vec::new(); wanted.len()];
    for ((place, job), run) in jobs.iter().zip(runs) {
        let identity = output::identity(job, Written::default());
        all[*place].push(RunResult::judged(identity, &run.recording, &run.metrics, &run.verdict));
    }
    all
}

/// Runs all jobs; an error when one of them could not be carried out.
fn carried_out(args: &CompareArgs, jobs: &[&Job]) -> Result<Vec<Run>, CliError> {
    let limits = workers::limits(args.time_limit, args.memory.memory_limit);
    let (engines, workers) = (engines::installed(), workers::of(&args.out, args.worker_timeout, limits)?);
    let progress = Progress::new(jobs.len(), false);
    let ready = |job: &&Job| ((), memory(&job.scenario));
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

/// Table, excluded runs, conclusion, notes.
fn text_of(args: &CompareArgs, comparison: &Comparison<'_>, heading: &str, drawn: Option<&str>) -> String {
    let style = style();
    let out = comparison.out(style.width);
    [
        heading.to_owned() + "\n\n",
        comparison.table(style) + "\n",
        if out.is_empty() { out } else { out + "\n" },
        comparison.words(style.width) + "\n",
        comparison.notes(style.width),
        drawn.map_or_else(String::new, |name| {
            format!("look at it: {}\n", command(&["view", &args.out.join(name).to_string_lossy()]))
        }),
    ]
    .concat()
}
