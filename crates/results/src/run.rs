//! Result of one run.
use crate::digest::Digest;
use crate::entry::{ExpectedResult, MetricResult, MoveResult, of_set};
use crate::results::Outcome;
use indexmap::IndexMap;
use serde::{Deserialize, Serialize};
use servobench_base::AxisName;
use servobench_files::MadeOf;
use servobench_metrics::{Metrics, Name, RequirementResult, Standing, Verdict};
use servobench_trace::{Event, LogEntry, Recording};

/// Identity of a run.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct RunIdentity {
    /// Name of the scenario.
    pub name: String,
    /// File of the scenario.
    pub file: Option<String>,
    /// Engine.
    pub engine: String,
    /// Name of the axis, if it has one.
    pub axis: Option<AxisName>,
    /// Digest of its inputs; see [`RunResult::inputs`].
    pub inputs: Digest,
    /// File of the recording.
    pub recording: Option<String>,
    /// Seal of the recording.
    pub recording_seal: Option<String>,
    /// All files that the run left beside the results, including the recording.
    pub files: Vec<String>,
    /// Files from which the scenario is built.
    pub made_of: Vec<MadeOf>,
    /// Contents of the scenario file, by key.
    pub parameters: Vec<(String, String)>,
    /// Keys that were overridden, with their values: `setpoint.jerk=200 m/s3`.
    pub overrides: Vec<String>,
    /// Places of the limits in the scenario file.
    pub limits: Vec<LimitPlace>,
    /// Warnings of `check`; `None` if it was not run.
    pub check_warnings: Option<Vec<String>>,
}

/// Place of a limit in its file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LimitPlace {
    /// Index of its move; `None` for the run as a whole.
    pub in_move: Option<usize>,
    /// Name of the metric.
    pub metric: String,
    /// Line of the file, from 1.
    pub line: usize,
}

/// One scenario on one engine.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct RunResult {
    /// Name of the scenario.
    pub name: String,
    /// File of the scenario as given, `-` for standard input; `null` for an embedded one.
    pub file: Option<String>,
    /// Engine that computed the mechanics; empty for a file that could not be read.
    pub engine: String,
    /// Name of the axis; left out if it has none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub axis: Option<AxisName>,
    /// Digest of all inputs of the run: scenario, overrides, engine, every file that it names, and the program.
    /// Equal digests mean equal runs.
    #[serde(default)]
    pub inputs: Digest,
    /// Files from which the scenario is built, itself first: missing values come from the models among them. Empty for a scenario
    /// that could not be read.
    #[serde(default)]
    pub made_of: Vec<MadeOf>,
    /// Outcome of the run.
    pub verdict: Outcome,
    /// Simulated time, from tick 0 to the last recorded instant (s).
    pub duration: f64,
    /// Failures or mistakes, in words; empty without any.
    pub reasons: Vec<String>,
    /// Standing of each requirement.
    #[serde(default)]
    pub requirements: IndexMap<String, RequirementResult>,
    /// The expected faults.
    #[serde(default)]
    pub expected: Vec<ExpectedResult>,
    /// Calls with `optional`, by name; left out without any.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub optional_calls: Vec<String>,
    /// Warnings, which break no requirement.
    #[serde(default)]
    pub warnings: Vec<String>,
    /// Warnings of `check`; left out if it was not run.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub check_warnings: Option<Vec<String>>,
    /// Contents of the scenario file, models and overrides merged in, by key.
    #[serde(default)]
    pub parameters: IndexMap<String, String>,
    /// Keys that were overridden, with their values; left out without any.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub overrides: Vec<String>,
    /// Metrics by name, including those with a limit that could not be measured.
    pub metrics: IndexMap<String, MetricResult>,
    /// Metrics that could not be measured, with the reason.
    pub absent: IndexMap<String, String>,
    /// The moves.
    pub moves: Vec<MoveResult>,
    /// Events: limits that bound, warnings.
    pub events: Vec<Event>,
    /// Log of FMUs; left out if empty.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub log: Vec<LogEntry>,
    /// File of the recording, beside the results; `null` if none was written.
    pub recording: Option<String>,
    /// Seal of the recording: a recording of that name with another seal is not of this run. `null` if none was written.
    #[serde(default)]
    pub recording_seal: Option<String>,
    /// All files that the run left beside the results, by name.
    #[serde(default)]
    pub files: Vec<String>,
}

impl RunResult {
    /// A judged run.
    #[must_use]
    pub fn judged(run: RunIdentity, recording: &Recording, metrics: &Metrics, verdict: &Verdict) -> Self {
        let limits = run.limits.clone();
        let mut result = Self::of(run, Some(recording), metrics);
        result.reasons = verdict.reasons().collect();
        for miss in verdict.misses.iter().filter(|miss| miss.value.is_none()) {
            let missing = [(miss.limit.metric.to_string(), MetricResult::missing(&miss.limit))];
            if let Some(metrics) = result.metrics_of(miss.in_move) {
                *metrics = std::mem::take(metrics).into_iter().chain(missing).collect();
            }
        }
        for LimitPlace { in_move, metric, line } in limits {
            let metric = result.metrics_of(in_move).and_then(|metrics| metrics.get_mut(&metric));
            if let Some(metric) = metric.filter(|metric| metric.pass.is_some()) {
                metric.line = Some(line);
            }
        }
        let standings = verdict.requirements.iter();
        result.requirements = standings.map(|(name, result)| (name.to_string(), result.clone())).collect();
        result.expected = verdict.expected.iter().map(ExpectedResult::from).collect();
        result.warnings.clone_from(&verdict.warnings);
        let optional = recording.calls.iter().filter(|call| call.is_optional);
        result.optional_calls = optional.map(|call| call.name.clone()).collect();
        let is_judged = result.all_metrics().any(|(_, metric)| metric.pass.is_some()) || !result.expected.is_empty();
        result.verdict = match (verdict.passed(), is_judged) {
            (false, _) => Outcome::Failed,
            (true, true) => Outcome::Passed,
            (true, false) => Outcome::Unjudged,
        };
        result
    }

    /// A scenario that cannot be read or built, with the reasons.
    #[must_use]
    pub fn invalid(run: RunIdentity, reasons: Vec<String>) -> Self {
        Self { verdict: Outcome::Invalid, reasons, ..Self::of(run, None, &Metrics::default()) }
    }

    /// A run that could not be completed, with its recording and metrics until then, and the reasons.
    #[must_use]
    pub fn error(run: RunIdentity, until_then: Option<(&Recording, &Metrics)>, reasons: Vec<String>) -> Self {
        let nothing = Metrics::default();
        let (recording, metrics) =
            until_then.map_or((None, &nothing), |(recording, metrics)| (Some(recording), metrics));
        Self { reasons, ..Self::of(run, recording, metrics) }
    }

    /// Metrics of the run, or of one of its moves.
    fn metrics_of(&mut self, in_move: Option<usize>) -> Option<&mut IndexMap<String, MetricResult>> {
        match in_move {
            None => Some(&mut self.metrics),
            Some(index) => self.moves.get_mut(index).map(|made| &mut made.metrics),
        }
    }

    /// All metrics by name, those of the run before those of its moves.
    pub fn all_metrics(&self) -> impl Iterator<Item = (&str, &MetricResult)> {
        let all = self.metrics.iter().chain(self.moves.iter().flat_map(|made| made.metrics.iter()));
        all.map(|(name, metric)| (name.as_str(), metric))
    }

    /// Requirements with this standing, with the reasons.
    pub fn requirements_that_are(&self, standing: Standing) -> impl Iterator<Item = (&str, &[String])> {
        let all = self.requirements.iter().filter(move |(_, requirement)| requirement.standing == standing);
        all.map(|(name, requirement)| (name.as_str(), requirement.reasons.as_slice()))
    }

    /// Expected faults that may occur at any time from some time on: without an end of its window an expectation lifts `no_fault` for that
    /// fault for the rest of the run.
    pub fn open_expectations(&self) -> impl Iterator<Item = &ExpectedResult> {
        self.expected.iter().filter(|expected| expected.to.is_none())
    }

    /// True if a general obligation of runs is lifted: by a requirement, a call with `optional`, or an expected fault without an end of
    /// its window.
    #[must_use]
    pub fn lifts(&self) -> bool {
        self.requirements_that_are(Standing::Lifted).next().is_some()
            || !self.optional_calls.is_empty()
            || self.open_expectations().next().is_some()
    }

    /// True with warnings of the verdict or of `check`; `None` if the verdict has none and `check` was not run.
    #[must_use]
    pub fn warns(&self) -> Option<bool> {
        match (&self.check_warnings, self.warnings.is_empty()) {
            (_, false) => Some(true),
            (Some(found), true) => Some(!found.is_empty()),
            (None, true) => None,
        }
    }

    /// Unmet requirements, broken or lifted, with the reasons: with any of them the run cannot be compared with others.
    pub fn not_met(&self) -> impl Iterator<Item = (&str, &RequirementResult)> {
        let all = self.requirements.iter().filter(|(name, requirement)| requirement.is_not_met(name));
        all.map(|(name, requirement)| (name.as_str(), requirement))
    }

    fn of(run: RunIdentity, recording: Option<&Recording>, metrics: &Metrics) -> Self {
        let events = recording.map(|recording| recording.events.as_slice()).unwrap_or_default();
        let log = recording.map(|recording| recording.log.as_slice()).unwrap_or_default();
        Self {
            name: run.name,
            file: run.file,
            engine: run.engine,
            axis: run.axis,
            inputs: run.inputs,
            made_of: run.made_of,
            verdict: Outcome::Error,
            // N + 1 instants from tick 0 to tick N.
            duration: recording.map_or(0.0, |recording| recording.time_of(recording.len().saturating_sub(1))),
            reasons: Vec::new(),
            requirements: IndexMap::new(),
            expected: Vec::new(),
            optional_calls: Vec::new(),
            warnings: Vec::new(),
            check_warnings: run.check_warnings,
            parameters: run.parameters.into_iter().collect(),
            overrides: run.overrides,
            metrics: of_set(&metrics.run),
            absent: metrics
                .run
                .absences()
                .filter(|(_, why)| !why.is_of_rare_equipment())
                .map(|(name, why)| (name.to_string(), why.to_string()))
                .collect(),
            moves: metrics.moves.iter().map(MoveResult::from).collect(),
            events: events.to_vec(),
            log: log.to_vec(),
            recording: run.recording,
            recording_seal: run.recording_seal,
            files: run.files,
        }
    }

    /// Value (SI) and unit of a metric, if it was measured.
    #[must_use]
    pub fn metric(&self, name: Name) -> Option<(f64, &str)> {
        let metric = self.metrics.get(name.as_str())?;
        Some((metric.value?, metric.unit.as_str()))
    }
}
