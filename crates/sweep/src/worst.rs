//! What is chosen, at the worst of what is given: the frequency of a load is not for the engineer to choose.
use crate::axis::Axis;
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

    /// The same where the axis `key` is of the machine: it is shown as it is, and given where the best combinations are chosen from.
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

    /// What is chosen alone: the axes that are not given, without draws; `None` where nothing is given, or all of it.
    #[must_use]
    pub fn chosen(&self) -> Option<Self> {
        if self.given.is_empty() {
            return None;
        }
        let mut chosen = self.without(&self.given)?;
        chosen.machine.clone_from(&self.machine);
        Some(chosen)
    }

    /// The chosen axes alone where those of the machine are given, too; `None` where nothing is left, or where both go side by side.
    #[must_use]
    pub fn chosen_for_a_machine(&self) -> Option<Self> {
        self.without(&[&self.given[..], &self.machine[..]].concat())
    }

    /// Without these axes and without draws.
    fn without(&self, keys: &[String]) -> Option<Self> {
        let axes: Vec<_> = self.axes().iter().filter(|axis| !keys.contains(&axis.key)).cloned().collect();
        let parts = self.arrangement() == Arrangement::Zip && !keys.is_empty();
        if axes.is_empty() || parts {
            return None;
        }
        // What is left of a grid is one.
        Self::new(axes, self.arrangement(), None).ok()
    }
}

impl<'a> Table<'a> {
    /// A row for each engine and combination of `chosen`, which is [`Sweep::chosen`] of this table's sweep: of each metric the largest
    /// value over what is given, or of draws the largest of their 95 % quantiles. A row is good when all its runs are, of draws when 95 % of
    /// each group are. A value is missing where one of those that it is the largest of is, and never is larger than every time.
    #[must_use]
    pub fn at_worst(&self, chosen: &'a Sweep) -> Self {
        self.worst_of(chosen, self.engines)
    }

    /// The same with a row for each combination of `chosen`, at its worst over the engines, too.
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

    /// Which combination of `chosen` group `group` is of.
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

/// The value of a run, or of draws their 95 % quantile; not a number where one is missing.
fn largest(values: &[f64]) -> f64 {
    match values {
        [value] => *value,
        values if values.iter().any(|value| value.is_nan()) => f64::NAN,
        values => Sample::of_times(values.iter().copied()).map_or(f64::NAN, |sample| sample.quantile(MOST)),
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
