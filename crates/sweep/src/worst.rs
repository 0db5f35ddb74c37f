//! Chosen keys at the worst of the given ones: an engineer does not choose the frequency of a load.
use crate::axis::Axis;
use crate::quantile::Sample;
use crate::sweep::{Arrangement, Sweep};
use crate::table::{Column, Outcome, Table};

/// Share of the quantile used as the worst value, with draws.
const MOST: f64 = 0.95;

impl Sweep {
    /// Marks the axis `key` as given: a property of the machine, over whose values choices are compared at their worst. Only an axis of a
    /// grid has an effect: draws are given anyway.
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

    /// Marks the axis `key` as belonging to the machine: it is shown as an axis, but given when the best combinations are chosen.
    #[must_use]
    pub fn of_the_machine(mut self, key: &str) -> Self {
        if self.axes().iter().any(|axis| axis.key == key) && !self.given.iter().any(|given| given == key) {
            self.machine.push(key.to_owned());
        }
        self
    }

    /// The axes of the machine that are not given anyway.
    #[must_use]
    pub fn machine_keys(&self) -> &[String] {
        &self.machine
    }

    /// The sweep of the chosen axes, without given axes and draws; `None` if no axis is given, or all are.
    #[must_use]
    pub fn chosen(&self) -> Option<Self> {
        if self.given.is_empty() {
            return None;
        }
        let mut chosen = self.without(&self.given)?;
        chosen.machine.clone_from(&self.machine);
        Some(chosen)
    }

    /// The sweep of the chosen axes with those of the machine also given; `None` if no axis is left, or for parallel axes.
    #[must_use]
    pub fn chosen_for_a_machine(&self) -> Option<Self> {
        self.without(&[&self.given[..], &self.machine[..]].concat())
    }

    /// The sweep without these axes and without draws.
    fn without(&self, keys: &[String]) -> Option<Self> {
        let axes: Vec<_> = self.axes().iter().filter(|axis| !keys.contains(&axis.key)).cloned().collect();
        let parts = self.arrangement() == Arrangement::Zip && !keys.is_empty();
        if axes.is_empty() || parts {
            return None;
        }
        // The remainder of a grid is a grid.
        Self::new(axes, self.arrangement(), None).ok()
    }
}

impl<'a> Table<'a> {
    /// A row for each engine and combination of `chosen`, which is [`Sweep::chosen`] of this table's sweep: the largest value of each
    /// metric over the given axes, or with draws the largest of their 95 % quantiles. A row is good if all its runs are, with draws if 95 %
    /// of each group are. A value is missing if one of those compared is missing; infinity exceeds every time.
    #[must_use]
    pub fn at_worst(&self, chosen: &'a Sweep) -> Self {
        self.worst_of(chosen, self.engines)
    }

    /// The same with a row for each combination of `chosen`, also at its worst over the engines.
    #[must_use]
    pub fn at_worst_on_all_engines(&self, chosen: &'a Sweep) -> Self {
        self.worst_of(chosen, &[])
    }

    fn worst_of(&self, chosen: &'a Sweep, engines: &'a [String]) -> Self {
        let rows = engines.len().max(1) * chosen.combinations();
        let mut groups: Vec<Vec<usize>> = vec![Vec::new(); rows];
        for group in 0..self.groups() {
            let engine = if engines.is_empty() { 0 } else { group / self.sweep.combinations() };
            groups[engine * chosen.combinations() + self.choice(chosen, group)].push(group);
        }
        let counted = self.counted();
        let columns = counted.columns.iter().map(|column| {
            let worst = |groups: &Vec<usize>| {
                let values = groups.iter().map(|group| largest(self.values(column, *group)));
                values.reduce(larger)
            };
            let values = groups.iter().map(|groups| worst(groups).unwrap_or(f64::NAN)).collect();
            Column { name: column.name.clone(), unit: column.unit.clone(), values }
        });
        let outcomes = groups.iter().map(|groups| self.worst_outcome(groups));
        Table { sweep: chosen, engines, columns: columns.collect(), outcomes: outcomes.collect() }
    }

    /// Index of the combination of `chosen` in group `group`.
    fn choice(&self, chosen: &Sweep, group: usize) -> usize {
        let places = self.sweep.places(self.combination(group));
        let is_chosen = |axis: &Axis| chosen.axes().iter().any(|other| other.key == axis.key);
        let mut all = self.sweep.axes().iter().zip(places).filter(|(axis, _)| is_chosen(axis));
        match chosen.arrangement() {
            Arrangement::Zip => all.next().map_or(0, |(_, place)| place),
            Arrangement::Grid => {
                all.zip(chosen.axes()).fold(0, |index, ((_, place), axis)| index * axis.values.len() + place)
            }
        }
    }

    fn worst_outcome(&self, groups: &[usize]) -> Outcome {
        let all = groups.iter().map(|group| {
            let runs = self.rows(*group).len() as f64;
            let share = |outcome| self.count_of(outcome, *group) as f64 / runs;
            let needed = if runs > 1.0 { MOST } else { 1.0 };
            match () {
                () if share(Outcome::NoVerdict) > 1.0 - needed => Outcome::NoVerdict,
                () if share(Outcome::Broken) > 1.0 - needed => Outcome::Broken,
                () if share(Outcome::Good) < needed => Outcome::Failed,
                () => Outcome::Good,
            }
        });
        let rank = |outcome: &Outcome| match outcome {
            Outcome::Good => 0,
            Outcome::Failed => 1,
            Outcome::Broken => 2,
            Outcome::NoVerdict => 3,
        };
        all.max_by_key(rank).unwrap_or(Outcome::NoVerdict)
    }
}

/// The value of a run, or the 95 % quantile of draws; NaN if one is missing.
fn largest(values: &[f64]) -> f64 {
    match values {
        [value] => *value,
        values if values.iter().any(|value| value.is_nan()) => f64::NAN,
        values => Sample::of_times(values.iter().copied()).map_or(f64::NAN, |sample| sample.quantile(MOST)),
    }
}

/// The larger of two numbers; NaN if one is NaN.
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

    /// The axis in the middle is given: the rows of a choice are not consecutive.
    #[test]
    fn a_choice_is_as_good_as_its_worst_machine() {
        let axes = vec![axis("a", &[1.0, 2.0]), axis("given", &[1.0, 2.0, 3.0]), axis("b", &[1.0, 2.0])];
        let sweep = Sweep::new(axes, Arrangement::Grid, None).unwrap().given("given");
        let chosen = sweep.chosen().unwrap();
        assert_eq!(chosen.axes().iter().map(|axis| axis.key.as_str()).collect::<Vec<_>>(), ["a", "b"]);
        // Rows: a, given, b; for both engines.
        let mut values: Vec<f64> = (0..24).map(f64::from).collect();
        values[2] = 100.0;
        values[23] = f64::NAN;
        let mut outcomes = vec![Outcome::Good; 24];
        outcomes[8] = Outcome::Failed;
        outcomes[13] = Outcome::NoVerdict;
        outcomes[22] = Outcome::Broken;
        let engines = ["exact".to_owned(), "rapier".to_owned()];
        let columns = vec![Column { name: "move_time".into(), unit: "s".into(), values }];
        let table = Table { sweep: &sweep, engines: &engines, columns, outcomes };
        let worst = table.at_worst(&chosen);
        assert_eq!(worst.groups(), 8);
        let found: Vec<f64> = worst.columns[0].values.clone();
        let finite = [100.0, 5.0, 10.0, 11.0, 16.0].map(f64::to_bits);
        assert_eq!(found[..5].iter().map(|x| x.to_bits()).collect::<Vec<_>>(), finite);
        // A run without a verdict has no number, one that broke a requirement never arrives.
        assert!(found[5].is_nan() && found[6].is_infinite() && found[7].is_nan(), "{found:?}");
        let good = Outcome::Good;
        assert_eq!(
            worst.outcomes,
            [good, good, Outcome::Failed, good, good, Outcome::NoVerdict, Outcome::Broken, good]
        );
    }

    #[test]
    fn where_nothing_is_given_nothing_is_chosen_apart() {
        let sweep = Sweep::new(vec![axis("a", &[1.0, 2.0])], Arrangement::Grid, None).unwrap();
        assert!(sweep.chosen().is_none() && sweep.clone().given("b").chosen().is_none());
        assert!(sweep.given("a").chosen().is_none(), "all of it");
    }
}
