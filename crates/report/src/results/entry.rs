//! The parts of a run's result.
use crate::ordered::Ordered;
use serde::{Deserialize, Serialize};
use servobench_base::Severity;
use servobench_metrics::{Expectation, Expected, Limit, Metric, MetricSet, MoveMetrics, Quantity, Standing};
use servobench_trace::{Event, LogEntry};

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
    /// Line of the scenario file, from 1, that has the limit; left out where nobody knows.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) line: Option<usize>,
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

/// How the run stands to a requirement.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum StandingResult {
    Met,
    Broken,
    Lifted,
    NotAsked,
}

/// A requirement.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct RequirementResult {
    /// How the run stands to it.
    pub(crate) standing: StandingResult,
    /// Why it is broken, or would be if it were not lifted, in words.
    pub(crate) reasons: Vec<String>,
}

/// A fault that was expected.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct ExpectedResult {
    /// State or error code.
    pub(crate) fault: String,
    /// Whose.
    pub(crate) who: String,
    /// From when on it may come (s).
    pub(crate) from: f64,
    /// Until when it must have come (s); `null`: by the end of the run.
    pub(crate) to: Option<f64>,
    /// When it came (s); `null`: it did not.
    pub(crate) met_at: Option<f64>,
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

impl MetricResult {
    /// Whether it has a limit that is missed.
    pub(crate) fn is_missed(&self) -> bool {
        self.pass == Some(false)
    }

    /// Significant digits that show how `value` stands to the limits.
    pub(crate) fn digits(&self, value: f64) -> usize {
        let bounds = [self.limit_min, self.limit].into_iter().flatten();
        bounds.map(|bound| Quantity::digits_apart(value.abs(), bound.abs())).max().unwrap_or(3)
    }

    pub(crate) fn missing(limit: &Limit) -> Self {
        Self { value: None, unit: String::new(), limit: limit.max, limit_min: limit.min, pass: Some(false), line: None }
    }
}

impl From<&Standing> for RequirementResult {
    fn from(standing: &Standing) -> Self {
        let (standing, reasons) = match standing {
            Standing::Met => (StandingResult::Met, Vec::new()),
            Standing::Broken(reasons) => (StandingResult::Broken, reasons.clone()),
            Standing::Lifted(reasons) => (StandingResult::Lifted, reasons.clone()),
            Standing::NotAsked => (StandingResult::NotAsked, Vec::new()),
        };
        Self { standing, reasons }
    }
}

impl From<&Expected> for ExpectedResult {
    fn from(expected: &Expected) -> Self {
        let Expected { expectation: Expectation { fault, who, from, to }, met } = expected.clone();
        Self { fault, who, from, to: Some(to).filter(|to| to.is_finite()), met_at: met }
    }
}

impl ExpectedResult {
    /// What was expected, in words.
    pub(crate) fn words(&self) -> String {
        let Self { fault, who, from, to, .. } = self.clone();
        Expectation { fault, who, from, to: to.unwrap_or(f64::INFINITY) }.to_string()
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
            line: None,
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

pub(crate) fn of_set(set: &MetricSet) -> Ordered<MetricResult> {
    set.iter().map(|(name, metric)| (name.to_string(), metric.into())).collect()
}
