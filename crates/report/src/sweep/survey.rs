//! A table of runs prepared for a report: the dimensions in which its groups differ, and the results of each.
use super::SweepOptions;
use super::dimension::{Dimension, dimensions};
use super::metric::{Metrics, at_least, percent};
use servobench_sweep::{Outcome, Proportion, Sample, Table};
use std::borrow::Cow;

/// Confidence of every bound reported.
pub(super) const CONFIDENCE: f64 = 0.95;
/// Values that differ by a smaller fraction of the smaller one are equal.
const SAME: f64 = 0.01;
/// Share of the machines that counts as most.
pub(super) const MOST: f64 = 0.95;

/// A table prepared for a report.
#[derive(Debug)]
pub(super) struct Survey<'t, 'a> {
    pub(super) table: Cow<'t, Table<'a>>,
    pub(super) dimensions: Vec<Dimension>,
    pub(super) metrics: Metrics,
    /// True if each group consists of several draws.
    pub(super) is_drawn: bool,
    /// True if runs are judged: they have limits, or one of them broke a requirement.
    pub(super) is_judged: bool,
    /// Largest difference of lengths that count as equal.
    length: f64,
}

/// Spread of a metric in a group: the value of a single run; for draws the median, and the bounds that leave out a twentieth on either
/// side.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Spread {
    pub(super) low: f64,
    pub(super) median: f64,
    pub(super) high: f64,
}

impl<'t, 'a> Survey<'t, 'a> {
    pub(super) fn of(table: &'t Table<'a>, options: &SweepOptions<'_>) -> Self {
        let table = table.counted();
        let is_broken = table.outcomes.contains(&Outcome::Broken);
        Self {
            dimensions: dimensions(&table),
            metrics: Metrics::of(&table, options),
            is_drawn: table.sweep.draws_of_each() > 1,
            is_judged: options.judged || is_broken,
            length: options.equal_length,
            table,
        }
    }

    /// Column `column` in `group`, as far as it can be drawn; `None` if it was not measured or is never reached.
    pub(super) fn spread(&self, column: usize, group: usize) -> Option<Spread> {
        let spread = self.with_never(column, group)?;
        let finite = self.table.values(&self.table.columns[column], group).iter().copied().filter(|x| x.is_finite());
        let high = if spread.high.is_finite() { spread.high } else { finite.fold(spread.median, f64::max) };
        spread.median.is_finite().then_some(Spread { high, ..spread })
    }

    /// The spread including infinite times of targets that are never reached.
    pub(super) fn with_never(&self, column: usize, group: usize) -> Option<Spread> {
        let values = self.table.values(&self.table.columns[column], group);
        if let [value] = values {
            return (!value.is_nan()).then_some(Spread { low: *value, median: *value, high: *value });
        }
        let sample = Sample::of_times(values.iter().copied())?;
        let [low, median, high] = [1.0 - MOST, 0.5, MOST].map(|share| sample.quantile(share));
        Some(Spread { low, median, high })
    }

    /// Share of the runs of `group` that keep all limits. A run without a verdict counts as not keeping them.
    pub(super) fn kept(&self, group: usize) -> Proportion {
        let good = self.table.count_of(Outcome::Good, group);
        Proportion::new(good as u64, (self.table.rows(group).len() - good) as u64)
    }

    /// True if `group` is marked, because a run of it, or more than a twentieth of its draws, does not keep all limits.
    pub(super) fn is_marked(&self, group: usize) -> bool {
        let kept = self.kept(group);
        kept.trials() > 0 && kept.share() < if self.is_drawn { MOST } else { 1.0 }
    }

    /// Meaning of a mark.
    pub(super) fn meaning_of_mark(&self) -> &'static str {
        match (self.is_drawn, self.count_of(Outcome::Broken) > 0) {
            (true, false) => "more than 5 % of the draws miss a limit",
            (true, true) => "more than 5 % of the draws failed",
            (false, false) => "misses a limit",
            (false, true) => "failed",
        }
    }

    /// Number of runs with this outcome.
    pub(super) fn count_of(&self, of: Outcome) -> usize {
        self.table.outcomes.iter().filter(|outcome| **outcome == of).count()
    }

    /// Keys and values of `group`, as text: `jerk 50 m/s3, order 4`.
    pub(super) fn words(&self, group: usize) -> String {
        self.dimensions.iter().map(|dimension| dimension.words(group)).collect::<Vec<_>>().join(", ")
    }

    /// The groups that no other one beats in time and vibration, the fastest first; for draws by their medians. Marked groups are
    /// left out. Nearly equal values count as equal.
    pub(super) fn front(&self) -> Vec<usize> {
        let median = |column, group| self.with_never(column, group).map_or(f64::NAN, |spread| spread.median);
        let (Some(time), Some(vibration)) = (self.metrics.time, self.metrics.vibration) else { return Vec::new() };
        let pair = |group| {
            let is_out = self.is_marked(group);
            if is_out { (f64::NAN, f64::NAN) } else { (median(time, group), median(vibration, group)) }
        };
        let pairs: Vec<(f64, f64)> = (0..self.table.groups()).map(pair).collect();
        let equal = |length: f64| {
            move |one: f64, other: f64| (one - other).abs() <= length.max(SAME * one.abs().min(other.abs()))
        };
        servobench_sweep::front_apart(&pairs, &[equal(0.0), equal(self.length)])
    }

    /// True if groups are left out of the front because they failed.
    pub(super) fn is_front_of_good(&self) -> bool {
        (0..self.table.groups()).any(|group| self.is_marked(group))
    }

    /// Condition on the groups of the front.
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
