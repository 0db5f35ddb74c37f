//! A table of runs as it is looked at: in which respects its groups differ, and what each of them gave.
use super::SweepOptions;
use super::dimension::{Dimension, dimensions};
use super::metric::{Metrics, at_least, percent};
use servobench_sweep::{Outcome, Proportion, Sample, Table};
use std::borrow::Cow;

/// Confidence of every bound that is said.
pub(super) const CONFIDENCE: f64 = 0.95;
/// The share that most machines are within.
pub(super) const MOST: f64 = 0.95;

/// A table as it is looked at.
#[derive(Debug)]
pub(super) struct Survey<'t, 'a> {
    pub(super) table: Cow<'t, Table<'a>>,
    pub(super) dimensions: Vec<Dimension>,
    pub(super) metrics: Metrics,
    /// Whether each group is several draws.
    pub(super) is_drawn: bool,
    /// Whether runs are judged by limits.
    pub(super) is_judged: bool,
}

/// What a metric is in a group: of a single run its value, of draws what half of them, and all but a twentieth on either side, are within.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Spread {
    pub(super) low: f64,
    pub(super) median: f64,
    pub(super) high: f64,
}

impl<'t, 'a> Survey<'t, 'a> {
    pub(super) fn of(table: &'t Table<'a>, options: &SweepOptions<'_>) -> Self {
        let table = judged_only(table);
        Self {
            dimensions: dimensions(&table),
            metrics: Metrics::of(&table, options),
            is_drawn: table.sweep.draws_of_each() > 1,
            is_judged: options.judged,
            table,
        }
    }

    /// What column `column` is in `group`; nothing where it was not measured.
    pub(super) fn spread(&self, column: usize, group: usize) -> Option<Spread> {
        let values = self.table.values(&self.table.columns[column], group);
        if let [value] = values {
            return value.is_finite().then_some(Spread { low: *value, median: *value, high: *value });
        }
        let sample = Sample::of(values.iter().copied())?;
        let [low, median, high] = [1.0 - MOST, 0.5, MOST].map(|share| sample.quantile(share));
        Some(Spread { low, median, high })
    }

    /// How many runs of `group` keep all limits. What has no verdict does not keep them.
    pub(super) fn kept(&self, group: usize) -> Proportion {
        let good = self.table.count_of(Outcome::Good, group);
        Proportion::new(good as u64, (self.table.rows(group).len() - good) as u64)
    }

    /// Whether `group` is to be marked, since a run of it, of draws more than a twentieth, does not keep all limits.
    pub(super) fn is_marked(&self, group: usize) -> bool {
        let kept = self.kept(group);
        self.is_judged && kept.trials() > 0 && kept.share() < if self.is_drawn { MOST } else { 1.0 }
    }

    /// What a mark means.
    pub(super) const fn meaning_of_mark(&self) -> &'static str {
        if self.is_drawn { "more than 5 % of the draws miss a limit" } else { "misses a limit" }
    }

    /// How many runs have no verdict.
    pub(super) fn without_verdict(&self) -> usize {
        self.table.outcomes.iter().filter(|outcome| **outcome == Outcome::NoVerdict).count()
    }

    /// What `group` is, in words: `jerk 50 m/s3, order 4`.
    pub(super) fn words(&self, group: usize) -> String {
        self.dimensions.iter().map(|dimension| dimension.words(group)).collect::<Vec<_>>().join(", ")
    }

    /// The groups that no other one beats in time and vibration, the fastest first; of draws by their medians. Those that are marked are not
    /// among them, unless all are.
    pub(super) fn front(&self) -> Vec<usize> {
        let median = |column, group| self.spread(column, group).map_or(f64::NAN, |spread| spread.median);
        let (Some(time), Some(vibration)) = (self.metrics.time, self.metrics.vibration) else { return Vec::new() };
        let groups = 0..self.table.groups();
        let only_good = self.is_front_of_good();
        let pair = |group| {
            let is_out = only_good && self.is_marked(group);
            if is_out { (f64::NAN, f64::NAN) } else { (median(time, group), median(vibration, group)) }
        };
        servobench_sweep::front(&groups.map(pair).collect::<Vec<_>>())
    }

    /// Whether some groups are left out of the front since they miss limits.
    pub(super) fn is_front_of_good(&self) -> bool {
        let marked = (0..self.table.groups()).filter(|group| self.is_marked(*group)).count();
        (1..self.table.groups()).contains(&marked)
    }

    /// What the front is of.
    pub(super) fn of_good(&self) -> &'static str {
        match (self.is_front_of_good(), self.is_drawn) {
            (false, _) => "",
            (true, false) => " that keeps all limits",
            (true, true) => " with which 95 % of the draws keep all limits",
        }
    }

    /// The share of `group` that keeps all limits with its bound: `98 %, at least 97.1 %`.
    pub(super) fn kept_words(&self, group: usize) -> String {
        let kept = self.kept(group);
        format!("{}, at least {}", percent(kept.share()), at_least(kept.at_least(CONFIDENCE)))
    }
}

/// The table without the numbers of runs that have no verdict: what a run that broke off has measured says nothing.
fn judged_only<'t, 'a>(table: &'t Table<'a>) -> Cow<'t, Table<'a>> {
    let is_out = |row: usize| table.outcomes.get(row).is_none_or(|outcome| *outcome == Outcome::NoVerdict);
    let is_measured = |values: &[f64]| values.iter().enumerate().any(|(row, value)| value.is_finite() && is_out(row));
    if !table.columns.iter().any(|column| is_measured(&column.values)) {
        return Cow::Borrowed(table);
    }
    let mut table = table.clone();
    let outcomes = &table.outcomes;
    for column in &mut table.columns {
        for (row, value) in column.values.iter_mut().enumerate() {
            if outcomes.get(row).is_none_or(|outcome| *outcome == Outcome::NoVerdict) {
                *value = f64::NAN;
            }
        }
    }
    Cow::Owned(table)
}
