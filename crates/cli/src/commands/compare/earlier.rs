//! `--against`: results of earlier runs beside those of now.
use crate::commands::view::latest_results;
use crate::error::CliError;
use crate::outputs::reads;
use servobench_config::Choice as _;
use servobench_metrics::{Name, Quantity};
use servobench_report::{elided, wrapped};
use servobench_results::{Results, RunResult, printable, read_results};
use servobench_suite::Job;
use servobench_trace::of_axis;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};

/// A run of a file of results.
pub(super) struct Earlier {
    /// Name in tables and text.
    pub(super) label: String,
    pub(super) result: RunResult,
    /// The file.
    path: PathBuf,
    /// Program and version that wrote it.
    generator: String,
}

/// Most runs taken from one file, and most names listed in a message.
const MOST: usize = 20;
/// Characters of a foreign name that are shown.
const LONGEST: usize = 40;

/// The runs in the files at `paths` that are compared with `jobs`; their labels differ from those in `taken`.
pub(super) fn read(paths: &[PathBuf], jobs: &[&Job], taken: &[&str]) -> Result<Vec<Earlier>, CliError> {
    let mut all: Vec<Earlier> = Vec::new();
    for path in paths {
        let file = if path.is_dir() { latest_results(path)? } else { path.clone() };
        let (generator, runs) = matching(&file, jobs)?;
        let name = folder_name(&file);
        let is_one = runs.iter().all(|run| run.name == runs[0].name);
        for result in runs {
            let is_taken = |label: &str| taken.contains(&label) || all.iter().any(|other| other.label == label);
            let own = elided(&printable(&result.name), LONGEST);
            let base = if is_one { name.clone() } else { format!("{name} {own}") };
            let numbered = (2..).map(|number| format!("{base}-{number}"));
            let label = std::iter::once(base.clone()).chain(numbered).find(|label| !is_taken(label));
            let label = label.unwrap_or_else(|| base.clone());
            all.push(Earlier { label, result, path: file.clone(), generator: generator.clone() });
        }
    }
    Ok(all)
}

/// Name of the folder that holds a file.
fn folder_name(file: &Path) -> String {
    let folder = file.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or_else(|| Path::new("."));
    let name = |folder: &Path| folder.file_name().and_then(OsStr::to_str).map(str::to_owned);
    let name = name(folder).or_else(|| name(&folder.canonicalize().ok()?));
    elided(&printable(&name.unwrap_or_else(|| "earlier".into())), LONGEST)
}

/// The program that wrote the file, and those of its runs that have the name of a scenario in `jobs`; a single run is taken with any name.
fn matching(file: &Path, jobs: &[&Job]) -> Result<(String, Vec<RunResult>), CliError> {
    reads(file, format_args!("the results {}", file.display()));
    let text = read_results(file).map_err(|error| CliError::Read { path: file.to_owned(), error })?;
    let results = Results::from_json(&text).map_err(|error| CliError::ReadResults { path: file.to_owned(), error })?;
    let refused = |why: String| CliError::Earlier { path: file.to_owned(), why };
    let whole: Vec<RunResult> = results.scenarios.into_iter().filter(|run| run.verdict.is_whole()).collect();
    let is_of_now = |run: &RunResult| jobs.iter().any(|job| job.scenario.name == run.name);
    let found = match whole.as_slice() {
        [] => return Err(refused("it has no run that came to its end".into())),
        [one] => vec![one.clone()],
        many => many.iter().filter(|run| is_of_now(run)).cloned().collect(),
    };
    if found.is_empty() {
        let mut names: Vec<&str> = whole.iter().map(|run| run.name.as_str()).collect();
        names.dedup();
        let more = names.len().saturating_sub(MOST);
        let more = if more > 0 { format!(" and {more} more") } else { String::new() };
        let listed = names.iter().take(MOST).map(|name| format!("`{}`", elided(&printable(name), LONGEST)));
        let wanted = jobs.first().map_or("", |job| &job.scenario.name);
        let listed = listed.collect::<Vec<_>>().join(", ");
        return Err(refused(format!(
            "it has no run of `{wanted}` but of {listed}{more}; give the scenario one of these names (--set name=…)"
        )));
    }
    if found.len() > MOST {
        let count = found.len();
        return Err(refused(format!("it has {count} runs of these scenarios, and at most {MOST} stand in a table")));
    }
    let motion = jobs.first().map(|job| job.scenario.axis.motion.name());
    if let Some((run, other)) = found.iter().find_map(|run| {
        let other = motion_of(run)?;
        (Some(other) != motion).then_some((run, other))
    }) {
        let (name, own) = (elided(&printable(&run.name), LONGEST), motion.unwrap_or_default());
        return Err(refused(format!(
            "its run of `{name}` is of a {other} axis and those of now are {own}; compare axes of one kind"
        )));
    }
    Ok((elided(&printable(&results.generator), LONGEST), found))
}

/// Kind of axis of a result, linear or rotary, from the units of its lengths.
fn motion_of(result: &RunResult) -> Option<&'static str> {
    let lengths = [Name::FollowingErrorPeakLoad, Name::FollowingErrorPeakMotor, Name::ResidualVibrationPp];
    let (_, unit) = lengths.into_iter().find_map(|name| result.metric(name))?;
    Some(if unit == "rad" { "rotary" } else { "linear" })
}

impl Earlier {
    /// Description in lines that fit `width`.
    pub(super) fn words(&self, width: usize) -> String {
        let Self { label, result, path, generator } = self;
        let overrides: Vec<String> = result.overrides.iter().map(|one| printable(one)).collect();
        let overrides = if overrides.is_empty() { String::new() } else { format!(", with {}", overrides.join(", ")) };
        let words = format!(
            "{label}: `{}`{} on {} from {}, by {generator}, {} simulated, {}{overrides}",
            elided(&printable(&result.name), LONGEST),
            of_axis(result.axis),
            elided(&printable(&result.engine), LONGEST),
            printable(&path.display().to_string()),
            Quantity::new(result.duration, "s"),
            result.verdict.word(),
        );
        format!("\n{}", wrapped(&words, width.saturating_sub(2)).join("\n  "))
    }
}
