//! One run: which machine, what is wrong with it, by which file it is judged, and what it leaves.
use crate::fmus::Here;
use crate::sabotage::{Sabotage, SabotagedEngine};
use serde::{Deserialize, Serialize};
use servobench::run::judge;
use servobench_metrics::{Standing, Verdict};
use servobench_plant::Engine;
use servobench_scenario::{Loaded, Scenario, load};
use servobench_signals::Signal;
use servobench_sim::Bench;
use servobench_trace::{CallFate, Recording};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// One run.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Job {
    /// Its name in the result.
    pub(crate) id: String,
    /// Scenario of the machine that runs.
    run: PathBuf,
    /// Scenario that it is judged by; default: its own.
    judge: Option<PathBuf>,
    /// Scenario of the mechanics from the time `at` (s) on.
    #[serde(default)]
    then: Option<PathBuf>,
    #[serde(default)]
    at: f64,
    /// Engine of the mechanics.
    engine: String,
    /// What is wrong with the machine that no file can say.
    #[serde(default)]
    sabotage: Vec<Sabotage>,
    /// Where the values of `channels` go, rows of 64-bit numbers, of every so many ticks.
    rows: Option<PathBuf>,
    #[serde(default)]
    channels: Vec<String>,
    #[serde(default = "one")]
    every: usize,
}

const fn one() -> usize {
    1
}

/// What a run leaves.
#[derive(Debug, Serialize)]
pub(crate) struct Outcome {
    passed: bool,
    /// Requirements by name.
    standing: BTreeMap<&'static str, Standing>,
    /// Reasons of requirements that are broken, and of those that are lifted and would be.
    reasons: Vec<String>,
    warnings: Vec<String>,
    /// Why the run ended early.
    ended: Option<String>,
    /// Rows per second and names of the channels in `rows`.
    rate: f64,
    channels: Vec<String>,
    /// Start, end (s), from, to of each move.
    moves: Vec<[f64; 4]>,
    /// Name, block and fate of each call.
    calls: Vec<(String, String, &'static str)>,
    /// Changes of states, outputs and kinds of request, by source and name.
    signals: BTreeMap<String, Vec<(f64, String)>>,
    events: Vec<(f64, f64, String, String)>,
}

impl Job {
    /// Runs it.
    ///
    /// # Errors
    /// Why there is no result, in words.
    pub(crate) fn run(&self) -> Result<Outcome, String> {
        let mut scenario = scenario_at(&self.run)?;
        let judged_by = self.judge.as_ref().map_or_else(|| Ok(scenario.clone()), |path| scenario_at(path))?;
        let then = self.then.as_ref().map(|path| scenario_at(path)).transpose()?;
        let channels = self.channels.iter().map(|name| signal(name)).collect::<Result<Vec<_>, _>>()?;
        scenario.record.channels = channels;
        let engine = SabotagedEngine {
            inner: engine(&self.engine)?,
            sabotage: self.sabotage.clone(),
            then: then.map(|then| then.axis.mechanics),
            at: self.at,
            transmission: scenario.axis.transmission,
        };
        let bench = Bench::with_fmus(&scenario, &engine, &Here).map_err(|error| error.to_string())?;
        let outcome = bench.run(&mut |_| ());
        let ended = outcome.failure.as_ref().map(ToString::to_string);
        let mut recording = outcome.recording;
        let verdict = judge(&mut recording, outcome.failure, &judged_by).map_err(|error| error.to_string())?;
        self.write_rows(&recording)?;
        Ok(self.outcome(&recording, &verdict, ended))
    }

    fn write_rows(&self, recording: &Recording) -> Result<(), String> {
        let Some(path) = &self.rows else { return Ok(()) };
        let channels: Vec<&[f64]> = self.channels.iter().filter_map(|name| recording.channel(name)).collect();
        let rows = (0..recording.len()).step_by(self.every);
        let bytes = rows.flat_map(|row| channels.iter().flat_map(move |values| values[row].to_le_bytes()));
        fs::write(path, bytes.collect::<Vec<u8>>()).map_err(|error| format!("{}: {error}", path.display()))
    }

    fn outcome(&self, recording: &Recording, verdict: &Verdict, ended: Option<String>) -> Outcome {
        let results = &verdict.requirements;
        let counts = |standing| matches!(standing, Standing::Broken | Standing::Lifted);
        let reasons = results.iter().filter(|(_, result)| counts(result.standing));
        let reasons = reasons.flat_map(|(name, result)| result.reasons.iter().map(move |why| format!("{name}: {why}")));
        Outcome {
            passed: verdict.passed(),
            standing: results.iter().map(|(name, result)| (name.as_str(), result.standing)).collect(),
            reasons: reasons.chain(verdict.reasons().filter(|why| why.starts_with("expected"))).collect(),
            warnings: verdict.warnings.clone(),
            ended,
            rate: f64::from(recording.rate.hertz()) / self.every as f64,
            channels: self.channels.iter().filter(|name| recording.channel(name).is_some()).cloned().collect(),
            moves: recording.moves.iter().map(|made| [made.start, made.end, made.from, made.to]).collect(),
            calls: recording.calls.iter().map(|c| (c.name.clone(), c.block.clone(), fate(&c.fate))).collect(),
            signals: recording
                .signals
                .iter()
                .map(|s| (format!("{}.{}", s.source, s.name), s.changes.clone()))
                .collect(),
            events: recording.events.iter().map(|e| (e.start, e.end, e.source.clone(), e.message.clone())).collect(),
        }
    }
}

const fn fate(fate: &CallFate) -> &'static str {
    match fate {
        CallFate::NeverExecuted(_) => "never executed",
        CallFate::Executed => "executed",
        CallFate::Unfinished(_) => "unfinished",
        CallFate::Failed { .. } => "failed",
    }
}

fn scenario_at(path: &Path) -> Result<Scenario, String> {
    match load(path) {
        Ok(Loaded { scenario, .. }) => Ok(scenario),
        Err(error) => Err(format!("{}: {error}", path.display())),
    }
}

fn signal(name: &str) -> Result<Signal, String> {
    name.parse().map_err(|_| format!("`{name}` is not a channel"))
}

fn engine(name: &str) -> Result<&'static dyn Engine, String> {
    match name {
        "exact" => Ok(&servobench_plant::Exact),
        "rapier" => Ok(&servobench_engine_rapier::Rapier),
        #[cfg(feature = "mujoco")]
        "mujoco" => Ok(&servobench_engine_mujoco::Mujoco),
        _ => Err(format!("no engine `{name}` in this build")),
    }
}
