//! Results of the runs of a sweep.
use crate::sweep::{Setting, Sweep};
use std::borrow::Cow;
use std::ops::Range;

/// Results of a sweep: a row for each run, engines slowest, then combinations of the axes, then draws.
///
/// The rows of an engine with a combination are a *group*: the draws of one machine, which are consecutive.
#[derive(Debug, Clone, PartialEq)]
pub struct Table<'a> {
    /// The sweep.
    pub sweep: &'a Sweep,
    /// Names of the engines, in the order of the rows; empty for a single one without a name.
    pub engines: &'a [String],
    /// Metrics.
    pub columns: Vec<Column>,
    /// Outcome of each run.
    pub outcomes: Vec<Outcome>,
}

/// A metric of every run.
#[derive(Debug, Clone, PartialEq)]
pub struct Column {
    /// Name of the metric: `settling_time`.
    pub name: String,
    /// Its unit (SI); empty for a pure number.
    pub unit: String,
    /// Its value in each row (SI); NaN if it was not measured.
    pub values: Vec<f64>,
}

/// Outcome of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outcome {
    /// All limits are met, or there are none.
    Good,
    /// A limit is not met.
    Failed,
    /// A requirement is not met: the run did not do what was requested, and its metrics do not describe the task.
    Broken,
    /// No verdict: the run was invalid, ended in an error, or did not take place.
    NoVerdict,
}

/// Metrics that are times to reach a state.
const TIMES: [&str; 4] = ["program_time", "move_and_settling_time", "settling_time", "move_time"];
/// Number of those, from the first, that are missing in a run that never reaches the state.
const SETTLED: usize = 3;

impl<'a> Table<'a> {
    /// The table restricted to numbers that count. Those of a run without a verdict do not. A run that broke a requirement never arrives,
    /// and its other metrics do not count: an axis at standstill has no vibration. A missing settling time that other runs have counts as
    /// infinite: later than all others.
    #[must_use]
    pub fn counted(&self) -> Cow<'_, Self> {
        let outcome = |row: usize| self.outcomes.get(row).copied().unwrap_or(Outcome::NoVerdict);
        let columns = self.columns.iter().map(|column| {
            let place = TIMES.iter().position(|name| *name == column.name);
            let is_measured = |(row, value): (usize, &f64)| !value.is_nan() && outcome(row) != Outcome::NoVerdict;
            let is_wanted = column.values.iter().enumerate().any(is_measured);
            let values = column.values.iter().enumerate().map(|(row, value)| match (outcome(row), place) {
                (Outcome::NoVerdict, _) | (Outcome::Broken, None) => f64::NAN,
                (Outcome::Broken, Some(_)) if is_wanted => f64::INFINITY,
                (Outcome::Good | Outcome::Failed, Some(place)) if place < SETTLED && is_wanted && value.is_nan() => {
                    f64::INFINITY
                }
                _ => *value,
            });
            Column { name: column.name.clone(), unit: column.unit.clone(), values: values.collect() }
        });
        if self.outcomes.iter().all(|outcome| *outcome == Outcome::Good)
            && !self.columns.iter().any(|column| column.values.iter().any(|value| value.is_nan()))
        {
            return Cow::Borrowed(self);
        }
        Cow::Owned(Self { columns: columns.collect(), outcomes: self.outcomes.clone(), ..*self })
    }

    /// Number of groups: engines times combinations of the axes.
    #[must_use]
    pub fn groups(&self) -> usize {
        self.engines.len().max(1) * self.sweep.combinations()
    }

    /// The existing rows of group `group`: its draws.
    #[must_use]
    pub fn rows(&self, group: usize) -> Range<usize> {
        let draws = self.sweep.draws_of_each();
        let end = self.outcomes.len();
        (group * draws).min(end)..((group + 1) * draws).min(end)
    }

    /// The engine of group `group`; empty if it has no name.
    #[must_use]
    pub fn engine(&self, group: usize) -> &'a str {
        self.engines.get(group / self.sweep.combinations()).map_or("", String::as_str)
    }

    /// Index, from 0, of the combination of the axes in group `group`.
    #[must_use]
    pub fn combination(&self, group: usize) -> usize {
        group % self.sweep.combinations()
    }

    /// The engine of group `group` and the values of its axes, without draws.
    #[must_use]
    pub fn settings(&self, group: usize) -> (&'a str, Vec<Setting<'a>>) {
        let sweep: &'a Sweep = self.sweep;
        (self.engine(group), sweep.combination(self.combination(group)))
    }

    /// The column of the metric `name`.
    #[must_use]
    pub fn column(&self, name: &str) -> Option<&Column> {
        self.columns.iter().find(|column| column.name == name)
    }

    /// Values of `column` in the rows of group `group`.
    #[must_use]
    pub fn values<'c>(&self, column: &'c Column, group: usize) -> &'c [f64] {
        let (rows, end) = (self.rows(group), column.values.len());
        &column.values[rows.start.min(end)..rows.end.min(end)]
    }

    /// Number of rows of group `group` with the outcome `outcome`.
    #[must_use]
    pub fn count_of(&self, outcome: Outcome, group: usize) -> usize {
        self.outcomes[self.rows(group)].iter().filter(|one| **one == outcome).count()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Arrangement, Axis, Distribution, Drawn, Draws, Method, Value};

    #[test]
    fn what_never_arrives_is_later_than_everything() {
        let values = (0..4).map(|k| Value::Number(k.into(), String::new())).collect();
        let sweep = Sweep::new(vec![Axis { key: "a".into(), values }], Arrangement::Grid, None).unwrap();
        let column =
            |name: &str, values: [f64; 4]| Column { name: name.into(), unit: String::new(), values: values.into() };
        let outcomes = vec![Outcome::Good, Outcome::Failed, Outcome::Broken, Outcome::NoVerdict];
        let columns = vec![
            column("settling_time", [1.0, f64::NAN, 0.0, 0.0]),
            column("move_time", [1.0, 2.0, 1.0, 1.0]),
            column("residual_vibration_pp", [1.0, 2.0, 0.0, 0.0]),
            column("program_time", [f64::NAN; 4]),
        ];
        let table = Table { sweep: &sweep, engines: &[], columns, outcomes };
        let counted = table.counted();
        let shown =
            |k: usize| counted.columns[k].values.iter().map(|value| format!("{value}")).collect::<Vec<_>>().join(" ");
        assert_eq!(shown(0), "1 inf inf NaN");
        assert_eq!(shown(1), "1 2 inf NaN");
        assert_eq!(shown(2), "1 2 NaN NaN");
        assert_eq!(shown(3), "NaN NaN NaN NaN", "nothing is known of it");
    }

    #[test]
    fn rows_are_engines_then_combinations_then_draws() {
        let axis = |key: &str, count: u32| {
            let values = (0..count).map(|k| Value::Number(k.into(), String::new())).collect();
            Axis { key: key.into(), values }
        };
        let drawn = Drawn {
            key: "mass".into(),
            unit: "kg".into(),
            distribution: Distribution::Uniform { low: 0.0, high: 1.0 },
        };
        let draws = Draws::new(4, 1, Method::Random, vec![drawn]).unwrap();
        let sweep = Sweep::new(vec![axis("a", 2), axis("b", 3)], Arrangement::Grid, Some(draws)).unwrap();
        let engines = ["exact".to_owned(), "mujoco".to_owned()];
        let rows = engines.len() * sweep.points();
        let mut outcomes = vec![Outcome::Good; rows];
        outcomes[29] = Outcome::Failed;
        let values = (0..rows).map(|row| row as f64).collect();
        let column = Column { name: "move_time".into(), unit: "s".into(), values };
        let table = Table { sweep: &sweep, engines: &engines, columns: vec![column], outcomes };
        assert_eq!((table.groups(), table.rows(7), table.engine(7)), (12, 28..32, "mujoco"));
        let (engine, settings) = table.settings(7);
        let written: Vec<String> = settings.iter().map(Setting::written).collect();
        assert_eq!((engine, written), ("mujoco", vec!["a=0".to_owned(), "b=1".to_owned()]));
        let column = table.column("move_time").unwrap();
        assert_eq!(table.values(column, 7), [28.0, 29.0, 30.0, 31.0]);
        assert_eq!((table.count_of(Outcome::Failed, 7), table.count_of(Outcome::Good, 7)), (1, 3));
        assert!(table.column("speed").is_none());
        // The settings of each row are those of its point.
        for row in table.rows(7) {
            assert_eq!(sweep.point(row % sweep.points())[..2], settings);
        }
    }
}
