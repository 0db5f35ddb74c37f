//! Data for display that a recording does not contain.
use crate::motor::MotorLimits;
use serde::{Deserialize, Serialize};
use servobench_metrics::Name;

/// Data shown beside the recorded channels.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ViewOptions {
    /// Verdicts of the runs, in their order; runs beyond the last have none.
    pub verdicts: Vec<Verdict>,
    /// Channel name and largest magnitude (SI) that motor and drive allow it: drawn as lines at ± the value, or at + the
    /// value only where the channel is never negative.
    pub limits: Vec<(String, f64)>,
    /// Metric and the largest value of it (SI) that passes. Drawn where it bounds a curve: the following errors, torque,
    /// current and voltage as [`ViewOptions::limits`]; vibration, overshoot and settling time in the plot of the residual
    /// vibration. Others are left out.
    #[serde(with = "by_name")]
    pub allowed: Vec<(Name, f64)>,
    /// Settling window, ± (axis unit): drawn around the residual vibration, with the instant from which on the load stays in it.
    pub window: Option<f64>,
    /// Start of the residual vibration without a move (s).
    pub residual_from: Option<f64>,
    /// Largest number of instants per curve. A longer channel is thinned to a minimum/maximum envelope: every extreme stays, at
    /// its own instant.
    pub max_instants: usize,
    /// Factor by which the deflection of the load relative to the motor is enlarged in the 3D view; `None` chooses one at which the largest
    /// deflection is visible.
    pub exaggeration: Option<f64>,
    /// The motor and its bounds, for the page of its operating point; `None` without a synchronous motor.
    pub motor: Option<MotorLimits>,
}

/// Verdict of a run in words: the head of every page.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Verdict {
    /// Outcome.
    pub outcome: Outcome,
    /// Failures, a sentence each.
    pub reasons: Vec<String>,
    /// Warnings, a sentence each.
    pub warnings: Vec<String>,
}

/// Outcome of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Outcome {
    /// All limits were kept.
    Passed,
    /// At least one limit was exceeded.
    Failed,
    /// The run has no limits.
    #[default]
    Unjudged,
}

impl Default for ViewOptions {
    fn default() -> Self {
        Self {
            verdicts: Vec::new(),
            limits: Vec::new(),
            allowed: Vec::new(),
            window: None,
            residual_from: None,
            max_instants: 20_000,
            exaggeration: None,
            motor: None,
        }
    }
}

/// Metrics by their names.
mod by_name {
    use serde::de::Error as _;
    use serde::{Deserialize, Deserializer, Serialize, Serializer};
    use servobench_metrics::Name;

    pub(super) fn serialize<S: Serializer>(allowed: &[(Name, f64)], to: S) -> Result<S::Ok, S::Error> {
        let named: Vec<(&str, f64)> = allowed.iter().map(|(name, value)| (name.as_str(), *value)).collect();
        named.serialize(to)
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<Vec<(Name, f64)>, D::Error> {
        let named = Vec::<(String, f64)>::deserialize(from)?;
        let metric = |(name, value): (String, f64)| Ok((name.parse().map_err(D::Error::custom)?, value));
        named.into_iter().map(metric).collect()
    }
}
