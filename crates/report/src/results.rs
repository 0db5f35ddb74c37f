//! `results.json`: what a run gave, for machines. The schema is in `docs/results.schema.json`.
use crate::error::ReportError;
use crate::ordered::Ordered;
use serde::{Deserialize, Serialize};
use servobench_base::Severity;
use servobench_metrics::{Limit, Metric, MetricSet, Metrics, MoveMetrics, Name, Quantity, Verdict};
use servobench_trace::{Event, LogEntry, Recording};

/// Name and version of the schema.
const SCHEMA_NAME: &str = "servobench-results/1";

/// The results of several runs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Results {
    /// Name and version of the schema.
    pub schema: String,
    /// Program and version that wrote them.
    pub generator: String,
    /// The runs in the order in which they were asked for.
    pub scenarios: Vec<RunResult>,
}

/// What came of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Outcome {
    /// Every limit is kept.
    Passed,
    /// The run came to its end, and there was no limit to keep.
    Unjudged,
    /// A limit is missed.
    Failed,
    /// The scenario asks for what cannot be built.
    Input,
    /// The run could not be carried out.
    Error,
}

impl Outcome {
    /// Whether the run came to its end without missing a limit.
    #[must_use]
    pub const fn is_good(self) -> bool {
        matches!(self, Self::Passed | Self::Unjudged)
    }

    /// Whether the run came to its end, so that its metrics mean what they say.
    pub(crate) const fn is_whole(self) -> bool {
        !matches!(self, Self::Input | Self::Error)
    }
}

/// One scenario on one engine.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RunResult {
    /// Name of the scenario.
    pub name: String,
    /// File of the scenario, as it was given; `null` for an embedded one.
    pub file: Option<String>,
    /// Engine that computed the mechanics.
    pub engine: String,
    /// What came of it.
    pub verdict: Outcome,
    /// Simulated time, from tick 0 to the last recorded instant (s).
    pub duration: f64,
    /// Missed limits or the error, in words; empty without either.
    pub reasons: Vec<String>,
    /// Metrics by name; with those that have a limit but could not be measured.
    pub(crate) metrics: Ordered<MetricResult>,
    /// Metrics that could not be measured, and why.
    pub(crate) absent: Ordered<String>,
    /// The moves.
    pub(crate) moves: Vec<MoveResult>,
    /// What happened: limits that bound, warnings.
    pub(crate) events: Vec<EventResult>,
    /// What FMUs said; left out where they said nothing.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(crate) log: Vec<LogResult>,
    /// File of the recording, beside the results; `null` when none was written.
    pub recording: Option<String>,
}

/// A metric.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct MetricResult {
    /// Value (SI); `null` when it could not be measured.
    pub(crate) value: Option<f64>,
    /// Unit symbol; empty for a pure number.
    pub(crate) unit: String,
    /// Largest allowed value; `null` without one.
    pub(crate) limit: Option<f64>,
    /// Smallest allowed value; left out without one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) limit_min: Option<f64>,
    /// Whether the limit is kept; `null` without a limit.
    pub(crate) pass: Option<bool>,
}

/// A move.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct MoveResult {
    /// What it is, in words.
    pub(crate) label: String,
    /// Start of the profile (s).
    pub(crate) start: f64,
    /// End of the profile (s).
    pub(crate) end: f64,
    /// Its metrics by name.
    pub(crate) metrics: Ordered<MetricResult>,
}

/// Something that happened.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct EventResult {
    /// When it began (s).
    pub(crate) start: f64,
    /// When it ended (s).
    pub(crate) end: f64,
    /// Stage of the loop that saw it.
    pub(crate) source: String,
    /// What it was, in words.
    pub(crate) message: String,
}

/// What an FMU said, or how often it said it again.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct LogResult {
    /// Who said it.
    pub(crate) source: String,
    /// How much it matters.
    pub(crate) severity: SeverityResult,
    /// When it was said (s), for the first time if it was more than once.
    pub(crate) start: f64,
    /// When it was said for the last time (s).
    pub(crate) end: f64,
    /// How often it was said between these.
    pub(crate) times: u64,
    /// The line.
    pub(crate) text: String,
}

/// How much a line matters.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum SeverityResult {
    Info,
    Warning,
    Error,
}

/// Which run it is.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct RunIdentity {
    /// Name of the scenario.
    pub name: String,
    /// File of the scenario.
    pub file: Option<String>,
    /// Engine.
    pub engine: String,
    /// File of the recording.
    pub recording: Option<String>,
}

impl Results {
    /// The results of these runs.
    #[must_use]
    pub fn new(scenarios: Vec<RunResult>) -> Self {
        let generator = concat!("servobench ", env!("CARGO_PKG_VERSION")).to_owned();
        Self { schema: SCHEMA_NAME.to_owned(), generator, scenarios }
    }

    /// As JSON, numbers in the shortest form that reads back to the same bits.
    ///
    /// # Errors
    /// [`ReportError::Json`].
    pub fn to_json(&self) -> Result<String, ReportError> {
        Ok(serde_json::to_string_pretty(self)? + "\n")
    }

    /// Reads what [`Results::to_json`] wrote.
    ///
    /// # Errors
    /// [`ReportError::Json`], [`ReportError::Schema`].
    pub fn from_json(text: &str) -> Result<Self, ReportError> {
        let results: Self = serde_json::from_str(text)?;
        if results.schema == SCHEMA_NAME {
            Ok(results)
        } else {
            Err(ReportError::Schema { found: results.schema, expected: SCHEMA_NAME })
        }
    }

    /// Number of runs with this outcome.
    pub(crate) fn count(&self, outcome: Outcome) -> usize {
        self.scenarios.iter().filter(|run| run.verdict == outcome).count()
    }
}

impl RunResult {
    /// A run that was judged.
    #[must_use]
    pub fn judged(run: RunIdentity, recording: &Recording, metrics: &Metrics, verdict: &Verdict) -> Self {
        let mut result = Self::of(run, Some(recording), metrics);
        result.reasons = verdict.reasons().collect();
        for miss in verdict.misses.iter().filter(|miss| miss.value.is_none()) {
            let missing = [(miss.limit.metric.to_string(), MetricResult::missing(&miss.limit))];
            let metrics = match miss.in_move {
                None => &mut result.metrics,
                Some(index) => match result.moves.get_mut(index) {
                    Some(made) => &mut made.metrics,
                    None => continue,
                },
            };
            *metrics = std::mem::take(metrics).into_iter().chain(missing).collect();
        }
        let of_moves = result.moves.iter().flat_map(|made| made.metrics.iter());
        let is_judged = result.metrics.iter().chain(of_moves).any(|(_, metric)| metric.pass.is_some());
        result.verdict = match (verdict.passed(), is_judged) {
            (false, _) => Outcome::Failed,
            (true, true) => Outcome::Passed,
            (true, false) => Outcome::Unjudged,
        };
        result
    }

    /// A run that could not be built, because the scenario asks for what there is not, and why.
    #[must_use]
    pub fn input(run: RunIdentity, reasons: Vec<String>) -> Self {
        Self { verdict: Outcome::Input, reasons, ..Self::of(run, None, &Metrics::default()) }
    }

    /// A run that could not be carried out and why, with what was recorded and measured until then.
    #[must_use]
    pub fn error(run: RunIdentity, until_then: Option<(&Recording, &Metrics)>, reasons: Vec<String>) -> Self {
        let nothing = Metrics::default();
        let (recording, metrics) =
            until_then.map_or((None, &nothing), |(recording, metrics)| (Some(recording), metrics));
        Self { reasons, ..Self::of(run, recording, metrics) }
    }

    fn of(run: RunIdentity, recording: Option<&Recording>, metrics: &Metrics) -> Self {
        let events = recording.map(|recording| recording.events.as_slice()).unwrap_or_default();
        let log = recording.map(|recording| recording.log.as_slice()).unwrap_or_default();
        Self {
            name: run.name,
            file: run.file,
            engine: run.engine,
            verdict: Outcome::Error,
            // N + 1 instants from tick 0 to tick N.
            duration: recording.map_or(0.0, |recording| recording.time_of(recording.len().saturating_sub(1))),
            reasons: Vec::new(),
            metrics: of_set(&metrics.run),
            absent: metrics.run.absences().map(|(name, why)| (name.to_string(), why.to_string())).collect(),
            moves: metrics.moves.iter().map(MoveResult::from).collect(),
            events: events.iter().map(EventResult::from).collect(),
            log: log.iter().map(LogResult::from).collect(),
            recording: run.recording,
        }
    }

    /// Value (SI) and unit of a metric, when it was measured.
    pub(crate) fn metric(&self, name: Name) -> Option<(f64, &str)> {
        let metric = self.metrics.get(name.as_str())?;
        Some((metric.value?, metric.unit.as_str()))
    }
}

impl MetricResult {
    /// Significant digits that show how `value` stands to the limits.
    pub(crate) fn digits(&self, value: f64) -> usize {
        let bounds = [self.limit_min, self.limit].into_iter().flatten();
        bounds.map(|bound| Quantity::digits_apart(value.abs(), bound.abs())).max().unwrap_or(3)
    }

    fn missing(limit: &Limit) -> Self {
        Self { value: None, unit: String::new(), limit: limit.max, limit_min: limit.min, pass: Some(false) }
    }
}

impl From<&Metric> for MetricResult {
    fn from(metric: &Metric) -> Self {
        Self {
            value: Some(metric.value),
            unit: metric.unit.clone(),
            limit: metric.limit.and_then(|limit| limit.max),
            limit_min: metric.limit.and_then(|limit| limit.min),
            pass: metric.pass,
        }
    }
}

impl From<&MoveMetrics> for MoveResult {
    fn from(made: &MoveMetrics) -> Self {
        Self { label: made.label.clone(), start: made.start, end: made.end, metrics: of_set(&made.metrics) }
    }
}

impl From<&Event> for EventResult {
    fn from(event: &Event) -> Self {
        Self { start: event.start, end: event.end, source: event.source.clone(), message: event.message.clone() }
    }
}

impl From<&LogEntry> for LogResult {
    fn from(entry: &LogEntry) -> Self {
        let LogEntry { source, severity, start, end, times, text } = entry.clone();
        Self { source, severity: severity.into(), start, end, times, text }
    }
}

impl From<Severity> for SeverityResult {
    fn from(severity: Severity) -> Self {
        match severity {
            Severity::Info => Self::Info,
            Severity::Warning => Self::Warning,
            Severity::Error => Self::Error,
        }
    }
}

impl From<SeverityResult> for Severity {
    fn from(severity: SeverityResult) -> Self {
        match severity {
            SeverityResult::Info => Self::Info,
            SeverityResult::Warning => Self::Warning,
            SeverityResult::Error => Self::Error,
        }
    }
}

fn of_set(set: &MetricSet) -> Ordered<MetricResult> {
    set.iter().map(|(name, metric)| (name.to_string(), metric.into())).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples;
    use serde_json::{Value, json};
    use servobench_base::Rate;
    use servobench_metrics::{Question, measure};
    use servobench_trace::{About, Channel, ChannelSpec, Ending, Move};

    /// What is wrong, and how to make it so.
    type Spoiled = (&'static str, fn(&mut Value));

    fn validator() -> jsonschema::Validator {
        let schema = serde_json::from_str(include_str!("../../../docs/results.schema.json")).unwrap();
        jsonschema::validator_for(&schema).unwrap()
    }

    fn value(results: &Results) -> Value {
        serde_json::from_str(&results.to_json().unwrap()).unwrap()
    }

    /// A recording of one move with a ramp as following error, judged by two limits of which one cannot be measured.
    fn judged() -> RunResult {
        let rate = Rate::new(1000).unwrap();
        let spec = ChannelSpec { name: "following_error.load".into(), unit: "m".into(), writer: "test".into(), rate };
        let recording = Recording {
            about: About {
                scenario: "ramp".into(),
                engine: "exact".into(),
                axis_unit: "m".into(),
                bodies: vec!["load".into()],
            },
            rate,
            channels: vec![Channel { spec, values: (0..=1000).map(|k| f64::from(k) * 0.1e-6).collect() }],
            moves: vec![Move {
                label: "move to 1 m".into(),
                start: 0.0,
                end: 0.5,
                from: 0.0,
                to: 1.0,
                peaks: [2.0, 8.0, f64::INFINITY, f64::INFINITY],
                limits: [Some(2.5), Some(8.0), None, None],
                cruise: (0.2, 0.0),
                ending: Ending::AtRest,
            }],
            events: vec![Event { start: 0.1, end: 0.1, source: "test".into(), message: "an event".into() }],
            signals: vec![],
            calls: vec![],
            limit_reversals: vec![],
            log: vec![LogEntry {
                source: "FMU load".into(),
                severity: Severity::Warning,
                start: 0.1,
                end: 0.1,
                times: 1,
                text: "stiff".into(),
            }],
        };
        let mut metrics = measure(&recording, &Question::default());
        let limits = [Limit::at_most(Name::FollowingErrorPeakLoad, 0.1e-3), Limit::at_most(Name::SettlingTime, 0.1)];
        let verdict = metrics.judge(&limits);
        let run = RunIdentity { name: "ramp".into(), engine: "exact".into(), ..RunIdentity::default() };
        RunResult::judged(run, &recording, &metrics, &verdict)
    }

    #[test]
    fn results_are_as_the_schema_says() {
        let mut results = samples::results();
        results.scenarios.push(judged());
        let errors: Vec<_> = validator().iter_errors(&value(&results)).map(|error| error.to_string()).collect();
        assert!(errors.is_empty(), "{errors:#?}");
    }

    #[test]
    fn the_schema_refuses_what_is_wrong() {
        let right = value(&samples::results());
        let wrong: [Spoiled; 7] = [
            ("another version", |v| v["schema"] = json!("servobench-results/2")),
            ("no verdict", |v| drop(v["scenarios"][0].as_object_mut().unwrap().remove("verdict"))),
            ("a verdict of its own", |v| v["scenarios"][0]["verdict"] = json!("maybe")),
            ("passed with a reason", |v| v["scenarios"][0]["reasons"] = json!(["why"])),
            ("failed without a reason", |v| v["scenarios"][1]["reasons"] = json!([])),
            ("a metric without unit", |v| {
                drop(v["scenarios"][0]["metrics"]["move_time"].as_object_mut().unwrap().remove("unit"));
            }),
            ("a field nobody knows", |v| v["scenarios"][0]["host"] = json!("here")),
        ];
        for (what, spoil) in wrong {
            let mut value = right.clone();
            spoil(&mut value);
            assert!(!validator().is_valid(&value), "{what}");
        }
        assert!(validator().is_valid(&right));
    }

    #[test]
    fn a_judged_run_holds_every_limit() {
        let run = judged();
        assert_eq!(run.verdict, Outcome::Failed);
        // Instants 0 to 1000 at 1 kHz.
        assert_eq!(run.duration.to_bits(), 1.0_f64.to_bits());
        let peak = run.metrics.get("following_error_peak_load").unwrap();
        assert_eq!((peak.limit, peak.pass), (Some(0.1e-3), Some(true)));
        let settling = run.metrics.get("settling_time").unwrap();
        assert_eq!((settling.value, settling.limit, settling.pass), (None, Some(0.1), Some(false)));
        let why = "settling_time could not be measured: `load.position` is not recorded";
        assert_eq!(run.reasons, [why]);
        assert_eq!(run.moves[0].metrics.get("setpoint_velocity_ratio").unwrap().value, Some(0.8));
        assert_eq!((run.events.len(), run.log.len()), (1, 1));
    }

    #[test]
    fn json_reads_back_to_the_same_bits_and_keeps_the_order() {
        let results = Results::new(vec![judged(), samples::snap()]);
        let text = results.to_json().unwrap();
        let back = Results::from_json(&text).unwrap();
        assert_eq!(back, results);
        assert_eq!(back.to_json().unwrap(), text);
        let names: Vec<_> = back.scenarios[1].metrics.iter().map(|(name, _)| name.to_owned()).collect();
        let order: Vec<_> = results.scenarios[1].metrics.iter().map(|(name, _)| name.to_owned()).collect();
        assert_eq!(names, order);
    }

    #[test]
    fn another_schema_is_refused() {
        let text = samples::results().to_json().unwrap().replace(SCHEMA_NAME, "servobench-results/2");
        let e = Results::from_json(&text).unwrap_err().to_string();
        assert_eq!(e, "the results have schema `servobench-results/2`; this version reads `servobench-results/1`");
        assert!(matches!(Results::from_json("{}"), Err(ReportError::Json(_))));
    }
}
