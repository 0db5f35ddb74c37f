//! `servobench check`: validates without running.
use crate::args::CheckArgs;
use crate::console::print;
use crate::diagnostics::mistakes;
use crate::engines;
use crate::exit::{CliError, Exit};
use crate::sources;
use crate::workers;
use servobench_scenario::{Diagnostic, EngineName, Loaded};
use servobench_suite::{Engines, RunError, Source, WorkerCommand, check as objections, jobs};
use std::time::Duration;

/// How long an isolated engine may take to read a model.
const PATIENCE: Duration = Duration::from_mins(1);

/// Reports every mistake of every file in one go: what is wrong in the file, and in a file without such what the engines
/// that it names object to.
pub(crate) fn check(args: &CheckArgs) -> Result<Exit, CliError> {
    let (engines, worker) = (engines::installed(), workers::command(&std::env::temp_dir(), PATIENCE)?);
    let files = sources::files(&args.scenarios)?;
    let (mut wrong, mut failed, mut missing) = (Vec::new(), Vec::new(), Vec::new());
    for file in &files {
        match sources::read(file) {
            Ok(loaded) => {
                let asked = Asked::about(&loaded, &engines, &worker);
                wrong.extend((!asked.mistakes.is_empty()).then(|| mistakes(&asked.mistakes, &loaded.sources)));
                failed.extend(asked.failed.iter().map(|error| format!("{}: {error}", file.display())));
                missing.extend(asked.missing);
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
    print(&format!("{} {plural} valid{}\n", files.len(), not_asked(&missing)))?;
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
