//! The parts of a run's result.
use indexmap::IndexMap;
use serde::{Deserialize, Serialize};
use servobench_metrics::{Expectation, Expected, Incident, Limit, Metric, MetricSet, MoveMetrics, Occasion, Quantity};

/// A metric.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MetricResult {
    /// Value (SI); `null` when it could not be measured.
    pub value: Option<f64>,
    /// Unit symbol; empty for a pure number.
    pub unit: String,
    /// Largest allowed value; `null` without one.
    pub limit: Option<f64>,
    /// Smallest allowed value; left out without one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub limit_min: Option<f64>,
    /// True if the limit is kept; `null` without a limit.
    pub pass: Option<bool>,
    /// Line of the limit in the scenario file, from 1; left out if unknown.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub line: Option<usize>,
}

/// A move.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MoveResult {
    /// Description in words.
    pub label: String,
    /// Start of the profile (s).
    pub start: f64,
    /// End of the profile (s).
    pub end: f64,
    /// Its metrics by name.
    pub metrics: IndexMap<String, MetricResult>,
}

/// An expected fault or incident.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ExpectedResult {
    /// State or error code of a fault; left out for an incident.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fault: Option<String>,
    /// Source of the fault; left out for an incident.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub who: Option<String>,
    /// Name of the incident; left out for a fault.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub event: Option<String>,
    /// Earliest time at which it may occur (s).
    pub from: f64,
    /// Latest time by which it must have occurred (s); `null`: the end of the run.
    pub to: Option<f64>,
    /// Time at which it occurred (s); `null`: it did not.
    pub met_at: Option<f64>,
}

impl MetricResult {
    /// True if it misses a limit.
    #[must_use]
    pub fn is_missed(&self) -> bool {
        self.pass == Some(false)
    }

    /// Significant digits needed to show `value` against the limits.
    #[must_use]
    pub fn digits(&self, value: f64) -> usize {
        let bounds = [self.limit_min, self.limit].into_iter().flatten();
        bounds.map(|bound| Quantity::digits_apart(value.abs(), bound.abs())).max().unwrap_or(3)
    }

    /// A metric with this limit that could not be measured.
    pub(crate) fn missing(limit: &Limit) -> Self {
        Self { value: None, unit: String::new(), limit: limit.max, limit_min: limit.min, pass: Some(false), line: None }
    }
}

impl From<&Expected> for ExpectedResult {
    fn from(expected: &Expected) -> Self {
        let Expected { expectation: Expectation { on, from, to }, met } = expected.clone();
        let (fault, who, event) = match on {
            Occasion::Fault { fault, who } => (Some(fault), Some(who), None),
            Occasion::Event(incident) => (None, None, Some(incident.name().to_owned())),
        };
        Self { fault, who, event, from, to: Some(to).filter(|to| to.is_finite()), met_at: met }
    }
}

impl ExpectedResult {
    /// The expectation in words.
    #[must_use]
    pub fn words(&self) -> String {
        let Self { fault, who, event, from, to, .. } = self.clone();
        let incident = event.and_then(|name| Incident::from_name(&name));
        let on = match incident {
            Some(incident) => Occasion::Event(incident),
            None => Occasion::Fault { fault: fault.unwrap_or_default(), who: who.unwrap_or_default() },
        };
        Expectation { on, from, to: to.unwrap_or(f64::INFINITY) }.to_string()
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

/// Metrics of a set by name.
pub(crate) fn of_set(set: &MetricSet) -> IndexMap<String, MetricResult> {
    set.iter().map(|(name, metric)| (name.to_string(), metric.into())).collect()
}
