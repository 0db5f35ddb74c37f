//! `servobench check`: validates without running.
use crate::args::CheckArgs;
use crate::console::{print, say};
use crate::diagnostics::render;
use crate::engines;
use crate::error::CliError;
use crate::exit::Exit;
use crate::fmu_trust::{doubts, trusted};
use crate::interrupt;
use crate::sources;
use crate::workers;
use miette::Severity;
use servobench::Engines;
use servobench::preview::{Doubt, Preview, preview};
use servobench_config::Choice as _;
use servobench_plant::EngineName;
use servobench_report::{Style, elided};
use servobench_results::printable;
use servobench_scenario::{Diagnostic, Loaded};
use servobench_sim::ConnectionDelay;
use servobench_suite::{Job, RunError, Source, Workers, check as objections, exchange, jobs};
use std::fmt;
use std::path::PathBuf;
use std::time::Duration;
use thiserror::Error;

/// Longest time for an isolated engine to read a model.
const WORKER_TIMEOUT: Duration = Duration::from_mins(1);

/// Reports every mistake of every file in one go: mistakes in the file and, in a file without any, the objections of the engines that it
/// names.
pub(crate) fn check(args: &CheckArgs) -> Result<Exit, CliError> {
    let limits = workers::limits(None, args.memory.memory_limit);
    let (engines, workers) = (engines::installed(), workers::of(&std::env::temp_dir(), WORKER_TIMEOUT, limits)?);
    interrupt::watch(&std::env::temp_dir())?;
    let files = sources::files(&args.scenarios, args.with.root.as_deref())?;
    let (mut findings, mut missing, mut shown) = (Findings::default(), Vec::new(), String::new());
    let in_full = args.verbose || files.len() == 1;
    for file in &files {
        match sources::read(file, &args.with).and_then(trusted) {
            Ok(loaded) => {
                let asked = Asked::about(&loaded, &engines, &workers);
                if let Some(preview) = &asked.preview {
                    if !asked.doubts.is_empty() {
                        say(&render(&asked.doubts, &loaded.sources, Severity::Warning));
                    }
                    shown.push_str(&previewed(preview, in_full));
                }
                shown.push_str(&asked.late);
                missing.extend(asked.missing);
                if !asked.mistakes.is_empty() {
                    let sources = Box::new(loaded.sources);
                    findings.wrong.push(CliError::Mistakes { diagnostics: asked.mistakes, sources });
                }
                let failed = asked.failed.into_iter().map(|error| Unasked { file: file.clone(), error });
                findings.failed.extend(failed);
            }
            Err(error) => findings.wrong.push(error.into()),
        }
    }
    if !(findings.wrong.is_empty() && findings.failed.is_empty()) {
        return Err(CliError::Check(findings));
    }
    let plural = if files.len() == 1 { "scenario is" } else { "scenarios are" };
    print(&format!("{shown}{} {plural} valid{}\n", files.len(), not_asked(&missing)))?;
    Ok(Exit::Passed)
}

/// Reasons why scenarios are not valid, or could not be checked.
#[derive(Debug, Default)]
pub(crate) struct Findings {
    /// Mistakes, one entry for each file.
    wrong: Vec<CliError>,
    /// Why some could not be checked.
    failed: Vec<Unasked>,
}

impl Findings {
    /// Exit code of the program.
    pub(crate) fn exit(&self) -> Exit {
        if self.wrong.is_empty() { Exit::Run } else { Exit::Input }
    }
}

impl fmt::Display for Findings {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let wrong = self.wrong.iter().map(ToString::to_string);
        f.write_str(&wrong.chain(self.failed.iter().map(ToString::to_string)).collect::<Vec<_>>().join("\n"))
    }
}

impl std::error::Error for Findings {}

/// An engine that could not check a scenario.
#[derive(Debug, Error)]
#[error("{}: {}", sources::named(.file), printable(&.error.to_string()))]
struct Unasked {
    file: PathBuf,
    error: RunError,
}

/// Findings of the engines about a scenario.
#[derive(Default)]
struct Asked {
    mistakes: Vec<Diagnostic>,
    /// Engines that this build lacks.
    missing: Vec<EngineName>,
    /// Errors of engines that could not check it.
    failed: Vec<RunError>,
    /// Delays of the signals exchanged between axis and FMUs, as text.
    late: String,
    /// Doubts about these signals.
    exchange_doubts: Vec<Doubt>,
    /// Preview of the run, when there is no mistake.
    preview: Option<Preview>,
    /// Doubts about the scenario, shown as warnings.
    doubts: Vec<Diagnostic>,
}

impl Asked {
    fn about(loaded: &Loaded, engines: &Engines, workers: &Workers) -> Self {
        let mut asked = Self::default();
        let text = loaded.sources.text(loaded.sources.scenario()).to_owned();
        let jobs = jobs(vec![Source { scenario: loaded.scenario.clone(), text }], &[]);
        for job in &jobs {
            let found = match objections(job, engines, workers) {
                Ok(found) => found,
                Err(RunError::Loop(servobench::Error::EngineMissing(missing))) => {
                    asked.missing.push(missing.name());
                    continue;
                }
                Err(error) => {
                    asked.failed.push(error);
                    continue;
                }
            };
            if found.is_empty() && asked.late.is_empty() {
                match exchange(job, engines) {
                    Ok(exchange) => {
                        asked.late = listed(&loaded.scenario.name, &exchange.delays);
                        asked.exchange_doubts = exchange.doubts;
                    }
                    Err(error) => asked.failed.push(error),
                }
            }
            for objection in found {
                let mistake = match objection.line {
                    Some(line) => loaded.mistake_in_mjcf(line, objection.message, &objection.help),
                    None => loaded.mistake(&objection.key, objection.message, objection.help),
                };
                // A mistake that concerns all engines is reported by each of them.
                if !asked.mistakes.contains(&mistake) {
                    asked.mistakes.push(mistake);
                }
            }
        }
        asked.mistakes.sort_by_key(|mistake| (mistake.source, mistake.span.start));
        if asked.mistakes.is_empty() {
            asked.look_ahead(loaded, &jobs, workers);
        }
        asked
    }

    /// Previews `loaded`, whose `jobs` can all be built, and collects its doubts.
    fn look_ahead(&mut self, loaded: &Loaded, jobs: &[Job], workers: &Workers) {
        let Some(first) = jobs.first() else { return };
        let names: Vec<EngineName> = jobs.iter().map(|job| job.engine).collect();
        match preview(&first.scenario, &names, workers.linearise(first).as_ref()) {
            Ok(preview) => self.preview = Some(preview),
            Err(error) => self.failed.push(error.into()),
        }
        let exchanged = std::mem::take(&mut self.exchange_doubts);
        let found = self.preview.iter().flat_map(|preview| &preview.doubts).cloned().chain(exchanged);
        self.doubts = found
            .map(|Doubt { key, line, message, help }| match line {
                Some(line) => loaded.mistake_in_mjcf(line, message, &help),
                None => loaded.mistake(&key, message, help),
            })
            .collect();
        self.doubts.extend(doubts(loaded));
        self.doubts.sort_by_key(|doubt| (doubt.source, doubt.span.start));
    }
}

/// A preview: a screen, or a line of it.
fn previewed(preview: &Preview, in_full: bool) -> String {
    let Style { width, .. } = Style::default();
    let name = &printable(&preview.name);
    if in_full {
        format!("{}\n{}", elided(name, width), preview.screen())
    } else {
        format!("{}\n", elided(&format!("{name}: {}", preview.line()), width))
    }
}

/// The connections of a scenario and their delays: in columns, or below each other where names are too long for that.
fn listed(scenario: &str, delays: &[ConnectionDelay]) -> String {
    if delays.is_empty() {
        return String::new();
    }
    let Style { width, .. } = Style::default();
    let widest = |name: fn(&ConnectionDelay) -> &str| {
        delays.iter().map(|delay| name(delay).chars().count()).max().unwrap_or_default()
    };
    let (from, to) = (widest(|delay| &delay.from), widest(|delay| &delay.to));
    let longest_age = delays.iter().map(|delay| age(delay).chars().count()).max().unwrap_or_default();
    let fits = 2 + from + 4 + to + 2 + longest_age <= width;
    let line = |delay: &ConnectionDelay| {
        let age = age(delay);
        if fits {
            format!("  {:from$} -> {:to$}  {age}\n", delay.from, delay.to)
        } else {
            let column = to.min(width - 9 - longest_age);
            let (from, to) = (elided(&delay.from, width - 2), elided(&delay.to, column));
            format!("  {from}\n    -> {to:column$}  {age}\n")
        }
    };
    let heading = ": connections and how late they are";
    let name = elided(&printable(scenario), width - heading.len());
    format!("{name}{heading}\n{}", delays.iter().map(line).collect::<String>())
}

/// Delay of a connection, in words: `1 step, 0.0625 ms`.
fn age(delay: &ConnectionDelay) -> String {
    let steps = match delay.steps {
        0 => return "no delay".to_owned(),
        1 => "1 step".to_owned(),
        steps => format!("{steps} steps"),
    };
    let how = if delay.is_extrapolated { ", extrapolated" } else { "" };
    // To the nanosecond: a number of ticks is not a round number of seconds.
    format!("{steps}, {} ms{how}", (delay.delay * 1e9).round() / 1e6)
}

/// Remark about engines that this build lacks; empty without any.
fn not_asked(missing: &[EngineName]) -> String {
    let all = EngineName::ALL.iter().filter(|(_, engine, _)| missing.contains(engine));
    let names: Vec<String> = all.map(|(name, ..)| format!("`{name}`")).collect();
    if names.is_empty() {
        String::new()
    } else {
        format!(" as far as this build can tell, which lacks {}", names.join(" and "))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn connection(from: &str, to: &str, steps: u64) -> ConnectionDelay {
        let is_extrapolated = steps > 0;
        ConnectionDelay { from: from.into(), to: to.into(), delay: steps as f64 * 1e-4, steps, is_extrapolated }
    }

    #[test]
    fn connections_are_in_columns_where_they_fit() {
        let all = [connection("load.position", "press.x", 3), connection("press.force", "disturbance.load", 0)];
        insta::assert_snapshot!(listed("punch", &all), @r"
        punch: connections and how late they are
          load.position -> press.x           3 steps, 0.3 ms, extrapolated
          press.force   -> disturbance.load  no delay
        ");
        assert_eq!(listed("alone", &[]), "");
    }

    #[test]
    fn long_names_stay_within_80_columns() {
        let long = "gearbox.housing.bearing_2.flange.torque";
        let all = [
            connection(&format!("press.{long}"), "disturbance.load", 1),
            connection("load.position", &"x".repeat(300), 1_000_000),
            connection(&format!("{long}.{long}.{long}"), &format!("press.{long}.{long}"), 0),
        ];
        let text = listed(&"scenario-".repeat(20), &all);
        insta::assert_snapshot!(text, @r"
        scenario-scenario-scen…rio-scenario-scenario-: connections and how late they are
          press.gearbox.housing.bearing_2.flange.torque
            -> disturbance.load                   1 step, 0.1 ms, extrapolated
          load.position
            -> xxxxxxxxxxxxxxxx…xxxxxxxxxxxxxxxx  1000000 steps, 100000 ms, extrapolated
          gearbox.housing.bearing_2.flange.torque…earbox.housing.bearing_2.flange.torque
            -> press.gearbox.ho…_2.flange.torque  no delay
        ");
        assert!(text.lines().all(|line| line.chars().count() <= 80), "{text}");
    }
}
