//! What is chosen, at the worst of what is given: the frequency of a load is not for the engineer to choose.
use crate::quantile::Sample;
use crate::sweep::{Arrangement, Sweep};
use crate::table::{Column, Outcome, Table};

/// The share of the draws that a value is not above, where there are draws.
const MOST: f64 = 0.95;

impl Sweep {
    /// The same where the axis `key` is given: a property of the machine, over which what is chosen is compared at its worst. A key that is
    /// no axis of a grid changes nothing: draws are given anyway.
    #[must_use]
    pub fn given(mut self, key: &str) -> Self {
        if self.arrangement() == Arrangement::Grid && self.axes().iter().any(|axis| axis.key == key) {
            self.given.push(key.to_owned());
        }
        self
    }

    /// The axes that are given.
    #[must_use]
    pub fn given_keys(&self) -> &[String] {
        &self.given
    }

    /// What is chosen alone: the axes that are not given, without draws; `None` where nothing is given, or all of it.
    #[must_use]
    pub fn chosen(&self) -> Option<Self> {
        let is_given = |key: &String| self.given.contains(key);
        let axes: Vec<_> = self.axes().iter().filter(|axis| !is_given(&axis.key)).cloned().collect();
        if self.given.is_empty() || axes.is_empty() {
            return None;
        }
        // What is left of a grid is one.
        Self::new(axes, Arrangement::Grid, None).ok()
    }
}

impl<'a> Table<'a> {
    /// A row for each engine and combination of `chosen`, which is [`Sweep::chosen`] of this table's sweep: of each metric the largest
    /// value over what is given, or of draws the largest of their 95 % quantiles. A row is good when all its runs are, of draws when 95 % of
    /// each group are. A value is missing where one of those that it is the largest of is.
    #[must_use]
    pub fn at_worst(&self, chosen: &'a Sweep) -> Self {
        let engines = self.engines.len().max(1);
        let rows = engines * chosen.combinations();
        let mut groups: Vec<Vec<usize>> = vec![Vec::new(); rows];
        for group in 0..self.groups() {
            let engine = group / self.sweep.combinations();
            groups[engine * chosen.combinations() + self.choice(chosen, group)].push(group);
        }
        let columns = self.columns.iter().map(|column| {
            let worst = |groups: &Vec<usize>| {
                let values = groups.iter().map(|group| largest(self.values(column, *group)));
                values.reduce(larger)
            };
            let values = groups.iter().map(|groups| worst(groups).unwrap_or(f64::NAN)).collect();
            Column { name: column.name.clone(), unit: column.unit.clone(), values }
        });
        let outcomes = groups.iter().map(|groups| self.worst_outcome(groups));
        Table { sweep: chosen, engines: self.engines, columns: columns.collect(), outcomes: outcomes.collect() }
    }

    /// Which combination of `chosen` group `group` is of.
    fn choice(&self, chosen: &Sweep, group: usize) -> usize {
        let places = self.sweep.places(self.combination(group));
        let all = self.sweep.axes().iter().zip(places).filter(|(axis, _)| !self.sweep.given_keys().contains(&axis.key));
        all.zip(chosen.axes()).fold(0, |index, ((_, place), axis)| index * axis.values.len() + place)
    }

    fn worst_outcome(&self, groups: &[usize]) -> Outcome {
        let all = groups.iter().map(|group| {
            let runs = self.rows(*group).len() as f64;
            let share = |outcome| self.count_of(outcome, *group) as f64 / runs;
            let needed = if runs > 1.0 { MOST } else { 1.0 };
            match () {
                () if share(Outcome::NoVerdict) > 1.0 - needed => Outcome::NoVerdict,
                () if share(Outcome::Good) < needed => Outcome::Failed,
                () => Outcome::Good,
            }
        });
        let rank = |outcome: &Outcome| match outcome {
            Outcome::Good => 0,
            Outcome::Failed => 1,
            Outcome::NoVerdict => 2,
        };
        all.max_by_key(rank).unwrap_or(Outcome::NoVerdict)
    }
}

/// The value of a run, or of draws their 95 % quantile; not a number where one is missing.
fn largest(values: &[f64]) -> f64 {
    match values {
        [value] => *value,
        values if values.iter().any(|value| value.is_nan()) => f64::NAN,
        values => Sample::of(values.iter().copied()).map_or(f64::NAN, |sample| sample.quantile(MOST)),
    }
}

/// The larger of two numbers; none where one is none.
fn larger(one: f64, other: f64) -> f64 {
    if one.is_nan() || other.is_nan() { f64::NAN } else { one.max(other) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Axis, Value};

    fn axis(key: &str, values: &[f64]) -> Axis {
        let values = values.iter().map(|value| Value::Number(*value, "m".into())).collect();
        Axis { key: key.into(), values }
    }

    /// Given is the axis in the middle: the rows of a choice do not follow each other.
    #[test]
    fn a_choice_is_as_good_as_its_worst_machine() {
        let axes = vec![axis("a", &[1.0, 2.0]), axis("given", &[1.0, 2.0, 3.0]), axis("b", &[1.0, 2.0])];
        let sweep = Sweep::new(axes, Arrangement::Grid, None).unwrap().given("given");
        let chosen = sweep.chosen().unwrap();
        assert_eq!(chosen.axes().iter().map(|axis| axis.key.as_str()).collect::<Vec<_>>(), ["a", "b"]);
        // Rows: a, given, b; of both engines.
        let mut values: Vec<f64> = (0..24).map(f64::from).collect();
        values[2] = 100.0;
        values[23] = f64::NAN;
        let mut outcomes = vec![Outcome::Good; 24];
        outcomes[8] = Outcome::Failed;
        outcomes[13] = Outcome::NoVerdict;
        let engines = ["exact".to_owned(), "rapier".to_owned()];
        let columns = vec![Column { name: "time".into(), unit: "s".into(), values }];
        let table = Table { sweep: &sweep, engines: &engines, columns, outcomes };
        let worst = table.at_worst(&chosen);
        assert_eq!(worst.groups(), 8);
        let found: Vec<f64> = worst.columns[0].values.clone();
        assert_eq!(
            found[..7].iter().map(|x| x.to_bits()).collect::<Vec<_>>(),
            [100.0, 5.0, 10.0, 11.0, 16.0, 17.0, 22.0].map(f64::to_bits)
        );
        assert!(found[7].is_nan());
        let good = Outcome::Good;
        assert_eq!(worst.outcomes, [good, good, Outcome::Failed, good, good, Outcome::NoVerdict, good, good]);
    }

    #[test]
    fn where_nothing_is_given_nothing_is_chosen_apart() {
        let sweep = Sweep::new(vec![axis("a", &[1.0, 2.0])], Arrangement::Grid, None).unwrap();
        assert!(sweep.chosen().is_none() && sweep.clone().given("b").chosen().is_none());
        assert!(sweep.given("a").chosen().is_none(), "all of it");
    }
}
