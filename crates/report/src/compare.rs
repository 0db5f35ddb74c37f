//! Runs side by side: a table, and what it says in words.
//!
//! Differences within one per cent are none, nor are those of rounding. A ratio of vibrations never stands alone: at which frequency and damping it
//! holds, what the set-points make of the frequencies beside that one, and what it costs in time and torque.
mod closed_form;
mod relation;
mod table;
mod words;

use crate::bound_limits::bound_limits;
use crate::results::{Outcome, RunResult};
use crate::text::wrapped;
use relation::Relation;
use servobench_metrics::Name;
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

/// Two or more runs of the same axis.
#[derive(Debug, Clone)]
pub struct Comparison<'a> {
    runs: Vec<Compared<'a>>,
}

/// Sizes below this (SI) are rounding: positions of the order of 1 m are known to 1e-16 m, and a picometre is nothing that
/// a machine shows.
const ROUNDING: f64 = 1e-12;

/// Value (SI) and unit.
type Value<'a> = (f64, &'a str);

impl<'a> Comparison<'a> {
    /// Compares `runs`; the first is the one that the others are held against.
    #[must_use]
    pub const fn new(runs: Vec<Compared<'a>>) -> Self {
        Self { runs }
    }

    /// Which run missed which of its own limits, and which limit of the drive bound in which run, in lines that fit
    /// `width`; empty without either.
    #[must_use]
    pub fn missed(&self, width: usize) -> String {
        let failed = self.runs.iter().filter(|run| run.result.verdict == Outcome::Failed);
        let lines = failed.flat_map(|run| {
            let reasons = run.result.reasons.iter();
            reasons.flat_map(|reason| wrapped(&format!("{} missed a limit: {reason}", run.label), width))
        });
        let bound = self.runs.iter().flat_map(|run| {
            let limits = bound_limits(&run.result.events);
            limits.into_iter().flat_map(|limit| wrapped(&format!("{}: {limit}", run.label), width))
        });
        lines.chain(bound).map(|line| line + "\n").collect()
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
    use crate::samples::{jerk, missed};

    #[test]
    fn missed_limits_are_said_of_the_run_that_missed_them() {
        let (jerk, slow) = (jerk(), missed());
        let runs = vec![
            Compared { label: "jerk", result: &jerk, moves: &[] },
            Compared { label: "slow", result: &slow, moves: &[] },
        ];
        insta::assert_snapshot!(Comparison::new(runs).missed(76), @r#"
        slow missed a limit: settling_time 35.2 ms, limit 20.0 ms
        slow missed a limit: residual_vibration_pp 8.30 µm, limit 2.00 µm
        slow missed a limit: current_peak could not be measured: `current.d` is not
        recorded; only a PMSM has a current
        slow: effort limit bound for 100 ms
        "#);
        let kept = vec![Compared { label: "jerk", result: &jerk, moves: &[] }; 2];
        assert_eq!(Comparison::new(kept).missed(76), "");
    }

    #[test]
    fn rounding_is_no_improvement() {
        let [one, two] = [3.33e-16, 2.22e-16]
            .map(|error| crate::samples::of_numbers("one", [1.3, 0.0, error, 1e-6, 39.0, 1.4e-15, 170.0, 60.0]));
        let runs = vec![
            Compared { label: "one", result: &one, moves: &[] },
            Compared { label: "two", result: &two, moves: &[] },
        ];
        let table = Comparison::new(runs).table(crate::style::Style::default());
        let row = table.lines().find(|line| line.starts_with("peak following error")).unwrap();
        assert_eq!(row.split_whitespace().skip(4).collect::<Vec<_>>(), ["0", "m", "0", "m", "same"], "{table}");
    }
}
