//! Runs side by side: a table, and what it says in words.
//!
//! Differences within one per cent are none, nor are those of rounding. A ratio of vibrations never stands alone: at which frequency and damping it
//! holds, what the set-points make of the frequencies beside that one, and what it costs in time and torque.
mod by_run;
mod many;
mod relation;
mod table;
mod words;

use crate::bound_limits::bound_limits;
use crate::failures::lifted;
use crate::text::wrapped;
use relation::Relation;
use servobench_metrics::Name;
use servobench_results::printable;
use servobench_results::{Outcome, RunResult};
use servobench_trace::Move;

/// A run under the name that it has in the comparison.
#[derive(Debug, Clone, Copy)]
pub struct Compared<'a> {
    /// `jerk`, `snap`.
    pub label: &'a str,
    /// Its results.
    pub result: &'a RunResult,
    /// The moves of its set-point.
    pub moves: &'a [Move],
}

/// Two or more runs.
#[derive(Debug, Clone)]
pub struct Comparison<'a> {
    runs: Vec<Compared<'a>>,
    /// Whether only their set-points differ.
    is_of_set_points: bool,
}

/// Sizes below this (SI) are rounding: positions of the order of 1 m are known to 1e-16 m, and a picometre is nothing that
/// a machine shows.
const ROUNDING: f64 = 1e-12;

/// Value (SI) and unit.
type Value<'a> = (f64, &'a str);

impl<'a> Comparison<'a> {
    /// Compares `runs`, of which only the set-points differ; the first is the one that the others are held against.
    #[must_use]
    pub const fn new(runs: Vec<Compared<'a>>) -> Self {
        Self { runs, is_of_set_points: true }
    }

    /// The same of runs that differ in more than their set-points: nothing is said of what those would make alone.
    #[must_use]
    pub fn of_more_than_set_points(self) -> Self {
        Self { is_of_set_points: false, ..self }
    }

    /// Whether two of the runs have a quantity in common that is compared.
    #[must_use]
    pub fn has_something_to_compare(&self) -> bool {
        let in_two = |name: Name| self.runs.iter().filter(|run| run.metric(name).is_some()).count() > 1;
        table::compared().any(in_two)
    }

    /// What failed in which run, what is lifted there, and which limit of the drive bound in which run, in lines that fit
    /// `width`; empty without any.
    #[must_use]
    pub fn failed(&self, width: usize) -> String {
        let failed = self.runs.iter().filter(|run| run.result.verdict == Outcome::Failed);
        let lines = failed.flat_map(|run| {
            let reasons = run.result.reasons.iter();
            reasons.flat_map(|reason| wrapped(&printable(&format!("{} failed: {reason}", run.label)), width))
        });
        let bound = self.runs.iter().flat_map(|run| {
            let limits = bound_limits(run.result);
            limits.into_iter().flat_map(|limit| wrapped(&format!("{}: {limit}", run.label), width))
        });
        let lifted = self.runs.iter().flat_map(|run| {
            let lifted = lifted(run.result);
            lifted.into_iter().flat_map(|words| wrapped(&printable(&format!("{}: {words}", run.label)), width))
        });
        lines.chain(lifted).chain(bound).map(|line| line + "\n").collect()
    }
}

impl<'a> Compared<'a> {
    /// Value (SI) and unit of a metric; what is within the rounding of the simulation is zero.
    fn metric(&self, name: Name) -> Option<Value<'a>> {
        let (value, unit) = self.result.metric(name)?;
        Some((if value.abs() < ROUNDING { 0.0 } else { value }, unit))
    }

    /// The limit of derivative `k` (0: velocity) that all moves share (SI).
    fn limit(&self, k: usize) -> Option<f64> {
        let (first, others) = self.moves.split_first()?;
        first.limits[k].filter(|limit| others.iter().all(|other| other.limits[k] == Some(*limit)))
    }
}

/// By which metric vibrations are held against each other: the amplitude of the mode when all ring in the same one,
/// otherwise peak-to-peak, which has the settling of the drive in it.
fn vibration_of(runs: &[Compared<'_>]) -> Name {
    let value = |run: &Compared<'_>, name| run.metric(name).map(|(value, _)| value);
    let have_amplitudes = runs.iter().all(|run| value(run, Name::ResidualVibrationAmplitude).is_some());
    let frequencies: Vec<_> = runs.iter().map(|run| value(run, Name::ResidualVibrationFrequency)).collect();
    let is_same = |two: &Option<f64>| frequencies[0].zip(*two).map(|(one, two)| Relation::of(one, two));
    if have_amplitudes && frequencies.iter().all(|two| is_same(two) == Some(Relation::Same)) {
        Name::ResidualVibrationAmplitude
    } else {
        Name::ResidualVibrationPp
    }
}

/// What that metric is, in words.
fn in_words(vibration: Name) -> &'static str {
    if vibration == Name::ResidualVibrationPp { "peak-to-peak" } else { "amplitude of the mode" }
}

/// What an effort in `unit` is called.
fn force_or_torque(unit: &str) -> &'static str {
    if unit == "N" { "force" } else { "torque" }
}

#[cfg(test)]
mod tests {
    use super::*;
    use servobench_results::samples::{broken, jerk, short};

    #[test]
    fn what_failed_is_said_of_the_run_that_failed() {
        let (jerk, slow) = (jerk(), short());
        let runs = vec![
            Compared { label: "jerk", result: &jerk, moves: &[] },
            Compared { label: "slow", result: &slow, moves: &[] },
        ];
        insta::assert_snapshot!(Comparison::new(runs).failed(76), @r#"
        slow failed: arrives: the load ended 200 mm short of 200 mm (window ±5 µm);
        effort limit bound for 1.99 s
        slow failed: executed: `jog` was never executed: `home.Done` did not come
        slow failed: expected, but did not come: 8611h of `drive` from 0.5 s on
        slow: lifted: stable: the velocity loop has a pole outside the unit circle
        slow: lifted: 8611h of `drive` from 0.5 s on
        "#);
        let kept = vec![Compared { label: "jerk", result: &jerk, moves: &[] }; 2];
        assert_eq!(Comparison::new(kept).failed(76), "");
    }

    #[test]
    fn runs_without_a_quantity_in_common_have_nothing_to_compare() {
        let (jerk, nothing) = (jerk(), broken());
        let of = |other| {
            let one = Compared { label: "one", result: &jerk, moves: &[] };
            Comparison::new(vec![one, Compared { label: "other", result: other, moves: &[] }])
                .has_something_to_compare()
        };
        assert!(of(&jerk) && !of(&nothing));
    }

    #[test]
    fn rounding_is_no_improvement() {
        let [one, two] = [3.33e-16, 2.22e-16].map(|error| {
            servobench_results::samples::of_numbers("one", [1.3, 0.0, error, 1e-6, 39.0, 1.4e-15, 170.0, 60.0])
        });
        let runs = vec![
            Compared { label: "one", result: &one, moves: &[] },
            Compared { label: "two", result: &two, moves: &[] },
        ];
        let table = Comparison::new(runs).table(crate::style::Style::default());
        let row = table.lines().find(|line| line.starts_with("peak following error")).unwrap();
        assert_eq!(row.split_whitespace().skip(4).collect::<Vec<_>>(), ["0", "m", "0", "m", "same"], "{table}");
    }
}
