//! `servobench check`: validates without running.
use crate::args::CheckArgs;
use crate::console::print;
use crate::diagnostics::mistakes;
use crate::engines;
use crate::exit::{CliError, Exit};
use crate::sources;
use crate::workers;
use servobench_scenario::{Diagnostic, EngineName, Loaded};
use servobench_sim::ConnectionDelay;
use servobench_suite::{Engines, RunError, Source, WorkerCommand, check as objections, delays, jobs};
use std::time::Duration;

/// How long an isolated engine may take to read a model.
const PATIENCE: Duration = Duration::from_mins(1);

/// Reports every mistake of every file in one go: what is wrong in the file, and in a file without such what the engines
/// that it names object to.
pub(crate) fn check(args: &CheckArgs) -> Result<Exit, CliError> {
    let (engines, worker) = (engines::installed(), workers::command(&std::env::temp_dir(), PATIENCE)?);
    let files = sources::files(&args.scenarios)?;
    let (mut wrong, mut failed, mut missing, mut late) = (Vec::new(), Vec::new(), Vec::new(), String::new());
    for file in &files {
        match sources::read(file) {
            Ok(loaded) => {
                let asked = Asked::about(&loaded, &engines, &worker);
                wrong.extend((!asked.mistakes.is_empty()).then(|| mistakes(&asked.mistakes, &loaded.sources)));
                failed.extend(asked.failed.iter().map(|error| format!("{}: {error}", file.display())));
                missing.extend(asked.missing);
                late.push_str(&asked.late);
            }
            Err(error) => wrong.push(error.to_string()),
        }
    }
    if !wrong.is_empty() {
        wrong.append(&mut failed);
        return Err(CliError::Input(wrong.join("\n")));
    }
    if !failed.is_empty() {
        return Err(CliError::Run(failed.join("\n")));
    }
    let plural = if files.len() == 1 { "scenario is" } else { "scenarios are" };
    print(&format!("{late}{} {plural} valid{}\n", files.len(), not_asked(&missing)))?;
    Ok(Exit::Passed)
}

/// What the engines of a scenario say of it.
#[derive(Default)]
struct Asked {
    mistakes: Vec<Diagnostic>,
    /// Engines that this build lacks.
    missing: Vec<EngineName>,
    /// Why others could not be asked.
    failed: Vec<RunError>,
    /// How late what axis and FMUs exchange is.
    late: String,
}

impl Asked {
    fn about(loaded: &Loaded, engines: &Engines, worker: &WorkerCommand) -> Self {
        let mut asked = Self::default();
        let text = loaded.sources.text(loaded.sources.scenario()).to_owned();
        for job in jobs(vec![Source { scenario: loaded.scenario.clone(), text }], &[]) {
            let found = match objections(&job, engines, worker) {
                Ok(found) => found,
                Err(RunError::EngineMissing(missing)) => {
                    asked.missing.push(missing.name);
                    continue;
                }
                Err(error) => {
                    asked.failed.push(error);
                    continue;
                }
            };
            if found.is_empty() && asked.late.is_empty() {
                match delays(&job, engines) {
                    Ok(delays) => asked.late = listed(&loaded.scenario.name, &delays),
                    Err(error) => asked.failed.push(error),
                }
            }
            for objection in found {
                let mistake = match objection.line {
                    Some(line) => loaded.mistake_in_mjcf(line, objection.message, &objection.way_out),
                    None => loaded.mistake(&objection.key, objection.message, objection.way_out),
                };
                // What is no engine's own is said by each of them.
                if !asked.mistakes.contains(&mistake) {
                    asked.mistakes.push(mistake);
                }
            }
        }
        asked.mistakes.sort_by_key(|mistake| (mistake.source, mistake.span.start));
        asked
    }
}

/// The connections of a scenario and how late each is.
fn listed(scenario: &str, delays: &[ConnectionDelay]) -> String {
    let from = delays.iter().map(|delay| delay.from.chars().count()).max().unwrap_or(0);
    let to = delays.iter().map(|delay| delay.to.chars().count()).max().unwrap_or(0);
    let line = |delay: &ConnectionDelay| {
        let age = match delay.steps {
            0 => "no delay".to_owned(),
            steps => {
                let plural = if steps == 1 { "step" } else { "steps" };
                let how = if delay.is_extrapolated { ", extrapolated" } else { "" };
                format!("{steps} {plural}, {} ms{how}", 1e3 * delay.delay)
            }
        };
        format!("  {:from$} -> {:to$}  {age}\n", delay.from, delay.to)
    };
    if delays.is_empty() {
        String::new()
    } else {
        format!("{scenario}: connections and how late they are\n{}", delays.iter().map(line).collect::<String>())
    }
}

/// Which engines had no say.
fn not_asked(missing: &[EngineName]) -> String {
    let names: Vec<String> = EngineName::ALL
        .into_iter()
        .filter(|engine| missing.contains(engine))
        .map(|engine| format!("`{}`", engine.as_str()))
        .collect();
    if names.is_empty() {
        String::new()
    } else {
        format!(" as far as this build can tell, which lacks {}", names.join(" and "))
    }
}
