//! Runs side by side: a table, and the same in words.
//!
//! Differences that do not matter, cannot be seen, or come by chance count as none (`terms`). A run that failed takes no part in the
//! conclusion (`standing`). A ratio of vibrations never stands alone: with it come the frequency and damping at which it holds, the
//! effect of the set-points on neighbouring frequencies, and its cost in time and torque.
mod arrival;
mod by_run;
mod many;
mod relation;
mod standing;
mod table;
mod terms;
mod words;

use crate::bound_limits::bound_limits;
use crate::failures::lifted;
use crate::text::wrapped;
use relation::Relation;
use servobench_metrics::Name;
use servobench_results::RunResult;
use servobench_results::printable;
use servobench_trace::Move;
use standing::Standing;

/// A run and its name in the comparison.
#[derive(Debug, Clone, Copy)]
pub struct Compared<'a> {
    /// `jerk`, `snap`.
    pub label: &'a str,
    /// Results of the run.
    pub result: &'a RunResult,
    /// Moves of its set-point.
    pub moves: &'a [Move],
    /// Random numbers of the run.
    pub noise: Noise<'a>,
}

/// Random numbers of a run: sensor noise, jitter of a bus or a task.
#[derive(Debug, Clone, Copy, Default)]
pub enum Noise<'a> {
    /// None: the run is the same with any seed.
    #[default]
    None,
    /// Some, with the results for other seeds.
    Seeds(&'a [RunResult]),
}

/// Two or more runs.
#[derive(Debug, Clone)]
pub struct Comparison<'a> {
    runs: Vec<Compared<'a>>,
    /// True if only the set-points differ.
    is_of_set_points: bool,
    /// Largest difference of lengths that count as equal (axis unit).
    length: f64,
    /// The metric in which the runs were made equal.
    equal: Option<Name>,
}

/// Sizes below this (SI) are rounding: positions of the order of 1 m are known to 1e-16 m, and no machine shows a picometre.
const ROUNDING: f64 = 1e-12;

/// Value (SI) and unit.
type Value<'a> = (f64, &'a str);

impl<'a> Comparison<'a> {
    /// Compares `runs`, of which only the set-points differ; the first is the reference.
    #[must_use]
    pub const fn new(runs: Vec<Compared<'a>>) -> Self {
        Self { runs, is_of_set_points: true, length: 0.0, equal: None }
    }

    /// Counts lengths (axis unit) as equal when they differ by no more than `length`: a part of the window, or one increment of
    /// the encoder.
    #[must_use]
    pub fn with_equal_lengths(self, length: f64) -> Self {
        Self { length, ..self }
    }

    /// Marks the runs as made equal in `metric`, which is then the one reported.
    #[must_use]
    pub fn made_equal(self, metric: Option<Name>) -> Self {
        Self { equal: metric, ..self }
    }

    /// Marks the runs as differing in more than their set-points: no conclusion about the set-points alone.
    #[must_use]
    pub fn of_more_than_set_points(self) -> Self {
        Self { is_of_set_points: false, ..self }
    }

    /// True if at least two of the runs share a quantity that is compared.
    #[must_use]
    pub fn has_something_to_compare(&self) -> bool {
        let in_two = |name: Name| self.runs.iter().filter(|run| run.metric(name).is_some()).count() > 1;
        table::compared().any(in_two)
    }

    /// Runs that do not win, with the reasons, in lines that fit `width`; empty if all may win.
    #[must_use]
    pub fn out(&self, width: usize) -> String {
        let lines = self.runs.iter().flat_map(|run| {
            let reasons = run.why_out().into_iter();
            reasons.flat_map(|reason| wrapped(&printable(&format!("{} is out: {reason}", run.label)), width))
        });
        lines.map(|line| line + "\n").collect()
    }

    /// Lifted requirements and limits of the drive that bound, by run, in lines that fit `width`; empty without any.
    #[must_use]
    pub fn notes(&self, width: usize) -> String {
        let bound = self.runs.iter().flat_map(|run| {
            let limits = bound_limits(run.result);
            limits.into_iter().flat_map(|limit| wrapped(&format!("{}: {limit}", run.label), width))
        });
        let lifted = self.runs.iter().flat_map(|run| {
            let lifted = lifted(run.result);
            lifted.into_iter().flat_map(|words| wrapped(&printable(&format!("{}: {words}", run.label)), width))
        });
        lifted.chain(bound).map(|line| line + "\n").collect()
    }

    /// The runs that did what was requested, whether or not they kept their limits.
    fn sound(&self) -> Vec<Compared<'a>> {
        self.runs.iter().filter(|run| run.standing() < Standing::Broken).copied().collect()
    }

    /// True for a run that may win.
    fn is_in(run: &Compared<'_>) -> bool {
        run.standing() == Standing::In
    }

    /// The metric by which vibrations are compared: the one that was made equal; the amplitude of the mode when all ring in the same one;
    /// otherwise peak-to-peak, which includes the settling of the drive.
    fn vibration(&self, runs: &[Compared<'_>]) -> Name {
        match self.equal {
            Some(metric @ (Name::ResidualVibrationAmplitude | Name::ResidualVibrationPp)) => metric,
            _ => vibration_of(runs),
        }
    }
}

impl<'a> Compared<'a> {
    /// Value (SI) and unit of a metric; values within the rounding of the simulation are zero.
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

/// The amplitude of the mode when all ring in the same one, otherwise peak-to-peak.
fn vibration_of(runs: &[Compared<'_>]) -> Name {
    let value = |run: &Compared<'_>, name| run.metric(name).map(|(value, _)| value);
    let have_amplitudes = runs.iter().all(|run| value(run, Name::ResidualVibrationAmplitude).is_some());
    let frequencies: Vec<_> = runs.iter().map(|run| value(run, Name::ResidualVibrationFrequency)).collect();
    let first = frequencies.first().copied().flatten();
    let is_same = |two: &Option<f64>| first.zip(*two).map(|(one, two)| Relation::of(one, two));
    if have_amplitudes && frequencies.iter().all(|two| is_same(two) == Some(Relation::Same)) {
        Name::ResidualVibrationAmplitude
    } else {
        Name::ResidualVibrationPp
    }
}

/// Name of that metric in words.
fn in_words(vibration: Name) -> &'static str {
    if vibration == Name::ResidualVibrationPp { "peak-to-peak" } else { "amplitude of the mode" }
}

/// Name of an effort in `unit`.
fn force_or_torque(unit: &str) -> &'static str {
    if unit == "N" { "force" } else { "torque" }
}

#[cfg(test)]
mod tests {
    use super::*;
    use servobench_results::samples::{broken, jerk, short};

    #[test]
    fn what_failed_is_told_of_the_run_that_failed() {
        let (jerk, slow) = (jerk(), short());
        let runs = vec![
            Compared { label: "jerk", result: &jerk, moves: &[], noise: Noise::None },
            Compared { label: "slow", result: &slow, moves: &[], noise: Noise::None },
        ];
        let comparison = Comparison::new(runs);
        insta::assert_snapshot!(comparison.out(76), @r#"
        slow is out: arrives: the load ended 200 mm short of 200 mm (window ±5 µm);
        effort limit bound for 1.99 s
        slow is out: executed: `jog` was never executed: `home.Done` did not come
        slow is out: expected, but did not occur: 8611h of `drive` from 0.5 s on
        slow is out: stable: the velocity loop has a pole outside the unit circle
        (lifted)
        "#);
        assert_eq!(
            comparison.notes(76),
            "slow: lifted: stable: the velocity loop has a pole outside the unit circle\n\
             slow: lifted: 8611h of `drive` from 0.5 s on\n"
        );
        let kept = vec![Compared { label: "jerk", result: &jerk, moves: &[], noise: Noise::None }; 2];
        assert_eq!(Comparison::new(kept.clone()).out(76) + &Comparison::new(kept).notes(76), "");
    }

    #[test]
    fn runs_without_a_quantity_in_common_have_nothing_to_compare() {
        let (jerk, nothing) = (jerk(), broken());
        let of = |other| {
            let one = Compared { label: "one", result: &jerk, moves: &[], noise: Noise::None };
            Comparison::new(vec![one, Compared { label: "other", result: other, moves: &[], noise: Noise::None }])
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
            Compared { label: "one", result: &one, moves: &[], noise: Noise::None },
            Compared { label: "two", result: &two, moves: &[], noise: Noise::None },
        ];
        let table = Comparison::new(runs).table(crate::style::Style::default());
        let row = table.lines().find(|line| line.starts_with("peak following error")).unwrap();
        assert_eq!(row.split_whitespace().skip(4).collect::<Vec<_>>(), ["0", "m", "0", "m", "same"], "{table}");
    }
}
