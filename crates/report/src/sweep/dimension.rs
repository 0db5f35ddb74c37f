//! Dimensions in which the groups of a sweep differ.
use servobench_results::printable;
use servobench_sweep::{Arrangement, Table, Value};
use std::collections::HashSet;

/// A dimension with more than one value among the groups: an axis, axes that go side by side, the engines.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Dimension {
    /// The key, or the keys.
    pub(super) name: String,
    /// Shortest end of the name that is unique.
    pub(super) short: String,
    /// The unit of all its numbers; empty without one.
    pub(super) unit: String,
    /// Its values, if all of them are finite numbers in one unit and no two are the same.
    pub(super) numbers: Option<Vec<f64>>,
    /// Its values as text, each different from the others as far as the values are.
    pub(super) labels: Vec<String>,
    /// The labels with the keys: `jerk 50 m/s3`.
    words: Vec<String>,
    /// With several keys, the one whose numbers it has, and the others.
    along: Option<(String, String)>,
    /// Index of its value in each group.
    of_group: Vec<usize>,
}

impl Dimension {
    /// Number of its values.
    pub(super) const fn count(&self) -> usize {
        self.labels.len()
    }

    /// Index of its value in `group`.
    pub(super) fn place(&self, group: usize) -> usize {
        self.of_group[group]
    }

    /// Its value in `group`, as text.
    pub(super) fn label(&self, group: usize) -> &str {
        &self.labels[self.of_group[group]]
    }

    /// Its value in `group` with the key: `jerk 50 m/s3`.
    pub(super) fn words(&self, group: usize) -> &str {
        &self.words[self.of_group[group]]
    }

    /// Title of an axis of its numbers in `unit`.
    pub(super) fn axis_title(&self, unit: &str) -> String {
        let (name, others) = self.along.as_ref().map_or((&self.name, None), |(along, others)| (along, Some(others)));
        let with_unit = if unit.is_empty() { name.clone() } else { format!("{name} ({unit})") };
        others.map_or(with_unit.clone(), |others| format!("{with_unit}, and with it {others}"))
    }

    /// Its value without the unit, if that is the same for all.
    pub(super) fn bare(&self, place: usize) -> String {
        let label = &self.labels[place];
        let bare = label.strip_suffix(self.unit.as_str()).map(str::trim_end).filter(|_| !self.unit.is_empty());
        bare.unwrap_or(label).to_owned()
    }
}

/// The dimensions of `table`, in the order of its keys; the engines first.
pub(super) fn dimensions(table: &Table<'_>) -> Vec<Dimension> {
    let (sweep, groups) = (table.sweep, table.groups());
    let places: Vec<Vec<usize>> = (0..sweep.combinations()).map(|combination| sweep.places(combination)).collect();
    let engines = Dimension {
        name: "engine".to_owned(),
        short: "engine".to_owned(),
        unit: String::new(),
        numbers: None,
        labels: table.engines.iter().map(|name| printable(name)).collect(),
        words: table.engines.iter().map(|name| format!("engine {}", printable(name))).collect(),
        along: None,
        of_group: (0..groups).map(|group| group / sweep.combinations()).collect(),
    };
    let keys: Vec<String> = sweep.axes().iter().map(|axis| printable(&axis.key)).collect();
    let axes = sweep.axes().iter().enumerate().map(|(axis, of)| {
        let (numbers, labels, short) = (numbers(&of.values), texts(&of.values), short(&keys, axis));
        Dimension {
            name: keys[axis].clone(),
            words: labels.iter().map(|label| format!("{short} {label}")).collect(),
            short,
            along: None,
            unit: numbers.as_ref().and(of.values.first()).map_or(String::new(), |value| printable(value.unit())),
            numbers: numbers.filter(|numbers| are_different(numbers)),
            labels,
            of_group: (0..groups).map(|group| places[table.combination(group)][axis]).collect(),
        }
    });
    let axes: Vec<Dimension> = axes.collect();
    let axes = if sweep.arrangement() == Arrangement::Zip { side_by_side(axes) } else { axes };
    std::iter::once(engines).chain(axes).filter(|dimension| dimension.count() > 1).collect()
}

/// Axes that go side by side as one dimension, along the first one with numbers.
fn side_by_side(axes: Vec<Dimension>) -> Vec<Dimension> {
    if axes.len() < 2 {
        return axes;
    }
    let joined = |text: fn(&Dimension) -> &str| axes.iter().map(text).collect::<Vec<_>>().join(", ");
    let of_places = |texts: fn(&Dimension) -> &[String]| -> Vec<String> {
        let of = |place: usize| axes.iter().map(|axis| texts(axis)[place].as_str()).collect::<Vec<_>>().join(", ");
        (0..axes[0].count()).map(of).collect()
    };
    let along = axes.iter().find(|axis| axis.numbers.is_some());
    vec![Dimension {
        name: joined(|axis| &axis.name),
        short: joined(|axis| &axis.short),
        unit: along.map_or(String::new(), |axis| axis.unit.clone()),
        numbers: along.and_then(|axis| axis.numbers.clone()),
        labels: of_places(|axis| &axis.labels),
        words: of_places(|axis| &axis.words),
        along: along.map(|along| {
            let others = axes.iter().filter(|axis| axis.name != along.name).map(|axis| axis.name.as_str());
            (along.name.clone(), others.collect::<Vec<_>>().join(", "))
        }),
        of_group: axes[0].of_group.clone(),
    }]
}

/// The numbers among `values`, if all are finite and in one unit.
fn numbers(values: &[Value]) -> Option<Vec<f64>> {
    let unit = values.first()?.unit();
    let is_alike = |value: &&Value| value.unit() == unit && value.number().is_some_and(f64::is_finite);
    values.iter().all(|value| is_alike(&value)).then(|| values.iter().filter_map(Value::number).collect())
}

fn are_different(numbers: &[f64]) -> bool {
    let mut seen = HashSet::new();
    numbers.iter().all(|number| seen.insert((number + 0.0).to_bits()))
}

/// Shortest end of key `which` that is unique among the keys.
fn short(keys: &[String], which: usize) -> String {
    let key = &keys[which];
    let starts = key.char_indices().rev().filter(|(_, c)| *c == '.').map(|(at, _)| at + 1);
    let is_shared = |end: &str| {
        let others = keys.iter().enumerate().filter(|(other, _)| *other != which);
        others.clone().any(|(_, other)| other == end || other.ends_with(&format!(".{end}")))
    };
    let end = starts.map(|at| &key[at..]).find(|end| !end.is_empty() && !is_shared(end));
    end.unwrap_or(key).to_owned()
}

/// `values` as text with enough digits that no two different numbers look the same, at least four.
fn texts(values: &[Value]) -> Vec<String> {
    let numbers: Vec<f64> = values.iter().filter_map(Value::number).collect();
    let mut different: Vec<u64> = numbers.iter().map(|number| number.to_bits()).collect();
    different.sort_unstable();
    different.dedup();
    let tells_apart = |digits: &usize| {
        let shown: HashSet<String> = numbers.iter().map(|number| rounded(*number, *digits)).collect();
        shown.len() >= different.len()
    };
    let digits = (4..17).find(tells_apart).unwrap_or(17);
    let text = |value: &Value| match value {
        Value::Number(number, unit) if unit.is_empty() => rounded(*number, digits),
        Value::Number(number, unit) => format!("{} {}", rounded(*number, digits), printable(unit)),
        Value::Text(text) => printable(text),
    };
    values.iter().map(text).collect()
}

/// `number` with at most `digits` significant digits, without trailing zeros.
pub(super) fn rounded(number: f64, digits: usize) -> String {
    let text = format!("{number:.*e}", digits.saturating_sub(1));
    let rounded: f64 = text.parse().unwrap_or(number);
    let magnitude = rounded.abs();
    if rounded == 0.0 || (1e-4..1e7).contains(&magnitude) || !rounded.is_finite() {
        // A minus sign before zero looks like a mistake.
        format!("{}", rounded + 0.0)
    } else {
        format!("{rounded:e}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_short_and_differ() {
        let number = |number: f64| Value::Number(number, "m/s3".into());
        assert_eq!(texts(&[number(0.1 + 0.2), number(1000.0 / 3.0)]), ["0.3 m/s3", "333.3 m/s3"]);
        assert_eq!(texts(&[number(1.00001), number(1.00002)]), ["1.00001 m/s3", "1.00002 m/s3"]);
        assert_eq!(texts(&[number(1e300), number(-2e-9)]), ["1e300 m/s3", "-2e-9 m/s3"]);
        assert_eq!(texts(&[Value::Text("zvd\u{1b}".into()), Value::Number(3.0, String::new())]), ["zvd\u{fffd}", "3"]);
    }

    #[test]
    fn keys_are_told_apart_by_their_ends() {
        let keys = ["axis.load.mass", "axis.motor.mass", "setpoint.jerk", "mass"].map(str::to_owned);
        let found: Vec<String> = (0..keys.len()).map(|key| short(&keys, key)).collect();
        assert_eq!(found, ["load.mass", "motor.mass", "jerk", "mass"]);
        assert_eq!(short(&["odd.".to_owned()], 0), "odd.");
    }
}
