//! Metrics with their units, limits and verdicts.
use crate::absence::Absence;
use crate::name::Name;
use crate::verdict::{Limit, Miss, Verdict};
use std::collections::BTreeMap;

/// A number with its unit, limit and verdict.
#[derive(Debug, Clone, PartialEq)]
pub struct Metric {
    /// Value (SI); always finite.
    pub value: f64,
    /// Unit symbol; empty for a pure number. `Apk` is a peak value, `Arms` an effective one.
    pub unit: String,
    /// Limit by which it was judged.
    pub limit: Option<Limit>,
    /// True if within its limit; `None` before judgement or without a limit.
    pub pass: Option<bool>,
}

/// Metrics by name, and the reasons why others are absent.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct MetricSet {
    present: BTreeMap<Name, Metric>,
    absent: BTreeMap<Name, Absence>,
}

/// The metrics of one move.
#[derive(Debug, Clone, PartialEq)]
pub struct MoveMetrics {
    /// Description of the move, in words.
    pub label: String,
    /// Start of the profile (s).
    pub start: f64,
    /// End of the profile (s).
    pub end: f64,
    /// Its metrics, under the same names as for the run.
    pub metrics: MetricSet,
}

/// All metrics of a run.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Metrics {
    /// Metrics of the run as a whole.
    pub run: MetricSet,
    /// Metrics of each move, in the order of the moves.
    pub moves: Vec<MoveMetrics>,
}

impl MetricSet {
    /// The metric, if it could be measured.
    #[must_use]
    pub fn get(&self, name: Name) -> Option<&Metric> {
        self.present.get(&name)
    }

    /// Value of the metric (SI), if it could be measured.
    #[must_use]
    pub fn value(&self, name: Name) -> Option<f64> {
        self.get(name).map(|metric| metric.value)
    }

    /// Reason why the metric is absent; `None` when it is present or is not measured here at all.
    #[must_use]
    pub fn absence(&self, name: Name) -> Option<&Absence> {
        self.absent.get(&name)
    }

    /// Measured metrics, in the order of [`Name`].
    pub fn iter(&self) -> impl Iterator<Item = (Name, &Metric)> {
        self.present.iter().map(|(name, metric)| (*name, metric))
    }

    /// Absent metrics with their reasons, in the order of [`Name`].
    pub fn absences(&self) -> impl Iterator<Item = (Name, &Absence)> {
        self.absent.iter().map(|(name, absence)| (*name, absence))
    }

    fn judge(&mut self, limits: &[Limit], in_move: Option<usize>) -> Vec<Miss> {
        for metric in self.present.values_mut() {
            (metric.limit, metric.pass) = (None, None);
        }
        let mut misses = Vec::new();
        for limit in limits {
            let Some(metric) = self.present.get_mut(&limit.metric) else {
                let absence = self.absent.get(&limit.metric).cloned();
                misses.push(Miss { limit: *limit, in_move, value: None, unit: String::new(), absence });
                continue;
            };
            let within = limit.holds(metric.value);
            metric.limit = Some(metric.limit.map_or(*limit, |other| other.and(limit)));
            metric.pass = Some(metric.pass.unwrap_or(true) && within);
            if !within {
                let (value, unit) = (Some(metric.value), metric.unit.clone());
                misses.push(Miss { limit: *limit, in_move, value, unit, absence: None });
            }
        }
        misses
    }

    /// Drops metrics that are not `wanted`.
    pub(crate) fn retain(&mut self, wanted: impl Fn(Name) -> bool) {
        self.present.retain(|name, _| wanted(*name));
        self.absent.retain(|name, _| wanted(*name));
    }

    /// Withdraws a metric, with the reason.
    pub(crate) fn withhold(&mut self, name: Name, why: Absence) {
        self.present.remove(&name);
        self.absent.insert(name, why);
    }

    /// Sets a metric to zero if its magnitude is not above `floor`.
    pub(crate) fn clear(&mut self, name: Name, floor: f64) {
        if let Some(metric) = self.present.get_mut(&name)
            && metric.value.abs() <= floor
        {
            metric.value = 0.0;
        }
    }

    /// Notes a metric, or the reason why there is none.
    pub(crate) fn note(&mut self, name: Name, unit: &str, result: Result<f64, Absence>) {
        match result {
            Ok(value) if !value.is_finite() => {
                self.absent.insert(name, Absence::Overflow);
            }
            Ok(value) => {
                let metric = Metric { value, unit: unit.to_owned(), limit: None, pass: None };
                self.present.insert(name, metric);
            }
            Err(absence) => {
                self.absent.insert(name, absence);
            }
        }
    }
}

impl Metrics {
    /// The metric of the run, if it could be measured.
    #[must_use]
    pub fn get(&self, name: Name) -> Option<&Metric> {
        self.run.get(name)
    }

    /// Judges the metrics of the run by `limits`, and notes limit and result at each of them. A limit on a metric
    /// that is absent is missed.
    pub fn judge(&mut self, limits: &[Limit]) -> Verdict {
        Verdict { misses: self.run.judge(limits, None), ..Verdict::default() }
    }

    /// Judges the metrics of each move by its own limits, as [`Metrics::judge`] judges those of the run. Limits of moves that
    /// were not made are missed.
    pub fn judge_moves(&mut self, limits: &[impl AsRef<[Limit]>]) -> Verdict {
        let mut misses = Vec::new();
        for (index, limits) in limits.iter().enumerate() {
            match self.moves.get_mut(index) {
                Some(made) => misses.extend(made.metrics.judge(limits.as_ref(), Some(index))),
                None => misses.extend(MetricSet::default().judge(limits.as_ref(), Some(index))),
            }
        }
        Verdict { misses, ..Verdict::default() }
    }
}
