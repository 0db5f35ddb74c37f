//! Keys and values of a scenario file as written, with models merged in: they distinguish two runs.
use crate::diagnostic::Report;
use crate::quantity;
use crate::source::{Authority, SourceId, Sources};
use crate::tree::{self, Node, Table, Value};
use std::collections::BTreeMap;

/// A key of a scenario file and its value.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Parameter {
    /// Path of the key: `drive.velocity.bandwidth`, `program.0.move_to`.
    pub key: String,
    /// The value as written: `60 Hz`.
    pub value: String,
    /// Line of the scenario file, from 1; `None` for a value from a model or an override.
    pub line: Option<usize>,
    /// True if the value comes from a model.
    pub is_of_model: bool,
}

/// A key at which two scenarios differ.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Difference {
    /// Path of the key.
    pub key: String,
    /// Value in the first; `None` if it omits the key.
    pub one: Option<String>,
    /// Value in the second.
    pub other: Option<String>,
}

/// Keys at the top level that do not affect a run.
const WORDS: [&str; 3] = ["name", "description", "format"];
/// Key that describes the source of a model's values.
const PROVENANCE: &str = ".source";

/// The parameters of a file, in its order.
pub(crate) fn parameters(root: &Table, sources: &Sources) -> Vec<Parameter> {
    let mut all = Vec::new();
    for entry in root.entries.iter().filter(|entry| !WORDS.contains(&entry.key.as_str())) {
        flatten(&entry.key, &entry.node, sources, &mut all);
    }
    all
}

fn flatten(path: &str, node: &Node, sources: &Sources, all: &mut Vec<Parameter>) {
    let below = |key: &dyn std::fmt::Display| format!("{path}.{key}");
    match &node.value {
        Value::Table(table) => {
            table.entries.iter().for_each(|entry| flatten(&below(&entry.key), &entry.node, sources, all));
        }
        Value::Array(items) if items.iter().any(|item| matches!(item.value, Value::Table(_))) => {
            items.iter().enumerate().for_each(|(index, item)| flatten(&below(&index), item, sources, all));
        }
        value if !path.ends_with(PROVENANCE) => {
            let authority = node.span.source.authority();
            let is_own = authority == Authority::Scenario;
            let line = is_own.then(|| sources.line_and_column(node.span.source, node.span.start).0);
            let is_of_model = authority == Authority::Model;
            all.push(Parameter { key: path.to_owned(), value: written(value), line, is_of_model });
        }
        _ => {}
    }
}

/// Every key of a TOML text with its value as it is written, in the order of the text; mistakes in the text are left out.
#[must_use]
pub fn written_values(text: &str) -> Vec<(String, String)> {
    fn list(path: &str, node: &Node, all: &mut Vec<(String, String)>) {
        match &node.value {
            Value::Table(table) => {
                table.entries.iter().for_each(|entry| list(&format!("{path}.{}", entry.key), &entry.node, all));
            }
            Value::Array(items) if items.iter().any(|item| matches!(item.value, Value::Table(_))) => {
                items.iter().enumerate().for_each(|(index, item)| list(&format!("{path}.{index}"), item, all));
            }
            value => all.push((path.to_owned(), written(value))),
        }
    }
    let parsed = tree::parse(SourceId::SCENARIO, text, &mut Report::default());
    let mut all = Vec::new();
    parsed.table.entries.iter().for_each(|entry| list(&entry.key, &entry.node, &mut all));
    all
}

/// A value as the file has it, texts without their quotes.
fn written(value: &Value) -> String {
    match value {
        Value::Text(text) | Value::Quantity { text, .. } => text.clone(),
        Value::Number(number) => number.text.clone(),
        Value::Bool(value) => value.to_string(),
        Value::Array(items) => {
            let items: Vec<_> = items.iter().map(|item| written(&item.value)).collect();
            format!("[{}]", items.join(", "))
        }
        Value::Table(_) | Value::Date => String::new(),
    }
}

/// Differences between two scenarios, in the order of the first. Equal quantities in different notation, `250 mm` and `0.25 m`, do not
/// differ; where the models differ, the values from them are not listed in addition to their names.
#[must_use]
pub fn differences(one: &[Parameter], other: &[Parameter]) -> Vec<Difference> {
    let by_key = |all: &[Parameter]| -> BTreeMap<String, Parameter> {
        all.iter().map(|parameter| (parameter.key.clone(), parameter.clone())).collect()
    };
    let (ones, others) = (by_key(one), by_key(other));
    let value = |all: &BTreeMap<String, Parameter>, key: &str| all.get(key).map(|found| found.value.clone());
    let of_another_model = |key: &str| {
        let table = key.split('.').next().unwrap_or(key);
        let model = format!("{table}.model");
        let is_models = |all: &BTreeMap<String, Parameter>| all.get(key).is_none_or(|found| found.is_of_model);
        key != model && value(&ones, &model) != value(&others, &model) && is_models(&ones) && is_models(&others)
    };
    let added = other.iter().filter(|parameter| !ones.contains_key(&parameter.key));
    let keys = one.iter().chain(added).map(|parameter| parameter.key.as_str());
    let differing = keys.filter(|key| !of_another_model(key)).filter_map(|key| {
        let (one, other) = (value(&ones, key), value(&others, key));
        let is_same = match (&one, &other) {
            (Some(one), Some(other)) => is_same(one, other),
            _ => false,
        };
        (!is_same).then(|| Difference { key: key.to_owned(), one, other })
    });
    differing.collect()
}

/// True if two texts are equal, or are equal quantities.
fn is_same(one: &str, other: &str) -> bool {
    let read = |text: &str| quantity::parse(text).ok();
    one == other
        || read(one).zip(read(other)).is_some_and(|(one, other)| {
            one.dimension == other.dimension && one.value.to_bits() == other.value.to_bits()
        })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parse;

    const TEXT: &str = r#"
description = "no parameter"
engine = ["exact", "rapier"]
run.base_rate = "12 kHz"
[axis]
motion = "linear"
motor_side.mass = "21 kg"
[motor]
kind = "prescribed"
[setpoint]
order = 2
velocity = "250 mm/s"
acceleration = "1 m/s2"
[[program]]
move_to = "10 mm"
[[program]]
wait = "1 s"
[limits]
move_time = "1 s"
"#;

    fn of(text: &str) -> Vec<Parameter> {
        parse("a.toml", text, None).unwrap_or_else(|error| panic!("{error}")).scenario.parameters
    }

    fn said(one: &str, other: &str) -> Vec<String> {
        let text = |value: Option<String>| value.unwrap_or_else(|| "–".into());
        let all = differences(&of(one), &of(other)).into_iter();
        all.map(|Difference { key, one, other }| format!("{key}: {}, {}", text(one), text(other))).collect()
    }

    #[test]
    fn keys_are_flat_with_values_as_written_and_their_lines() {
        let found = of(TEXT);
        let found: Vec<_> = found.iter().map(|p| (p.key.as_str(), p.value.as_str(), p.line)).collect();
        assert_eq!(found[0], ("engine", "[exact, rapier]", Some(3)));
        assert_eq!(found[1], ("run.base_rate", "12 kHz", Some(4)));
        assert!(found.contains(&("axis.motor_side.mass", "21 kg", Some(7))));
        assert!(found.contains(&("setpoint.order", "2", Some(11))));
        assert!(found.contains(&("program.1.wait", "1 s", Some(17))));
        assert!(found.contains(&("limits.move_time", "1 s", Some(19))));
        assert_eq!(found.len(), 11, "{found:?}");
    }

    #[test]
    fn every_value_of_a_text_is_listed_as_it_is_written() {
        let found = written_values("a = 'x'\n[b]\nc = [1, 2]\n[[d]]\ne.f = true\n[[d]]\ne = 1.50\n");
        let found: Vec<_> = found.iter().map(|(key, value)| (key.as_str(), value.as_str())).collect();
        assert_eq!(found, [("a", "x"), ("b.c", "[1, 2]"), ("d.0.e.f", "true"), ("d.1.e", "1.50")]);
    }

    #[test]
    fn what_a_model_says_has_no_line() {
        assert!(TEXT.contains("kind = \"prescribed\""));
        let text = TEXT.replace("kind = \"prescribed\"", "model = \"emps\"");
        let drive = "[drive]\nvelocity = { rate = \"12 kHz\", bandwidth = \"30 Hz\" }\nposition = { rate = \"12 kHz\", bandwidth = \"10 Hz\" }\n";
        let found = of(&text.replace("[setpoint]", &format!("{drive}[setpoint]")));
        let of_key = |key: &str| found.iter().find(|p| p.key == key).unwrap_or_else(|| panic!("{key}"));
        assert_eq!(of_key("motor.gain").line, None);
        assert_eq!(of_key("motor.gain").value, "35.1507 N/V");
        assert!(of_key("motor.model").line.is_some());
        assert!(found.iter().all(|p| p.key != "motor.source"), "a reference is no parameter");
    }

    #[test]
    fn differences_are_those_of_values_not_of_words() {
        assert_eq!(said(TEXT, &TEXT.replace("250 mm/s", "0.25 m/s").replace("no parameter", "none")), [""; 0]);
        let other = TEXT.replace("21 kg", "22 kg").replace("move_time = \"1 s\"", "overshoot = \"1 um\"");
        assert_eq!(
            said(TEXT, &other),
            ["axis.motor_side.mass: 21 kg, 22 kg", "limits.move_time: 1 s, –", "limits.overshoot: –, 1 um"]
        );
    }
}
