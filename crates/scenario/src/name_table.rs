//! Tables whose keys are names from outside: the variables of an FMU, with their signals or start values.
use crate::argument::any_quantity;
use crate::diagnostic::Report;
use crate::field::{Field, written};

use crate::source::{At, Span};
use crate::tree::{Entry, Node, Value};
use serde_json::{Value as Json, json};
use servobench_fmu_file::Value as StartValue;

/// A name and its value.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Named<T> {
    pub(crate) name: String,
    pub(crate) name_span: Span,
    pub(crate) value: At<T>,
}

/// Signals by the names of variables: `{ tau = "effort.motor" }`.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct SignalTable(pub(crate) Vec<Named<String>>);

/// Values by the names of variables: `{ mass = "12 kg", stages = 3, label = "left", gains = [1.0, 2.0] }`.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct StartTable(pub(crate) Vec<Named<StartValue>>);

fn entries<'a>(path: &str, node: &'a Node, report: &mut Report) -> Option<&'a [Entry]> {
    if let Value::Table(table) = &node.value {
        return Some(&table.entries);
    }
    let message = format!("`{path}` must be a table, got {}", node.value.kind());
    report.error(node.span, message, format!("write `[{path}]`"));
    None
}

/// The entries with dotted keys joined again: in TOML `body.x = …` is a table `body`, here the variable `body.x`.
fn flat<'a>(entries: &'a [Entry], prefix: &str, all: &mut Vec<(String, &'a Entry)>) {
    for entry in entries {
        let name = if prefix.is_empty() { entry.key.clone() } else { format!("{prefix}.{}", entry.key) };
        match &entry.node.value {
            Value::Table(table) => flat(&table.entries, &name, all),
            _ => all.push((name, entry)),
        }
    }
}

fn decode<T>(
    path: &str,
    node: &Node,
    report: &mut Report,
    read: impl Fn(&Node, &mut Report) -> Option<T>,
) -> Option<Vec<Named<T>>> {
    let mut all = Vec::new();
    flat(entries(path, node, report)?, "", &mut all);
    let values = all.into_iter().map(|(name, entry)| {
        let value = At { value: read(&entry.node, report)?, span: entry.node.span };
        Some(Named { name, name_span: entry.key_span, value })
    });
    // All entries are read before the first error returns, so that every mistake is reported.
    values.collect::<Vec<_>>().into_iter().collect()
}

impl Field for SignalTable {
    fn decode(path: &str, node: &Node, (): &(), report: &mut Report) -> Option<Self> {
        let signal = |node: &Node, report: &mut Report| {
            let text = node.value.as_text().map(str::to_owned);
            if text.is_none() {
                let message = format!("a signal is a string, got {}", written(node));
                report.error(node.span, message, "write variable = \"load.position\"");
            }
            text
        };
        decode(path, node, report, signal).map(Self)
    }

    fn schema((): &()) -> Json {
        json!({
            "type": "object",
            "additionalProperties": { "anyOf": [{ "type": "string" }, { "type": "object" }] },
            "examples": ["{ tau = \"effort.motor\" }"],
        })
    }
}

impl Field for StartTable {
    fn decode(path: &str, node: &Node, (): &(), report: &mut Report) -> Option<Self> {
        decode(path, node, report, value).map(Self)
    }

    fn schema((): &()) -> Json {
        json!({
            "type": "object",
            "additionalProperties": true,
            "examples": ["{ mass = \"12 kg\", stages = 3 }"],
        })
    }
}

/// A start value: a bare number in the unit of its variable, TRUE or FALSE, a text (a quantity with a unit, the name of an
/// enumeration's item, or a string), or the elements of an array. Only the FMU knows the type and the unit of the variable.
fn value(node: &Node, report: &mut Report) -> Option<StartValue> {
    match &node.value {
        Value::Number(number) if number.value.is_finite() => Some(StartValue::Number(number.value)),
        Value::Bool(flag) => Some(StartValue::Boolean(*flag)),
        Value::Text(text) | Value::Quantity { text, .. } => Some(match any_quantity(text) {
            Some((si, exponents)) => StartValue::Quantity { text: text.clone(), si, exponents },
            None => StartValue::Text(text.clone()),
        }),
        Value::Array(items) => {
            let values: Vec<_> = items.iter().map(|item| value(item, report)).collect();
            values.into_iter().collect::<Option<_>>().map(StartValue::List)
        }
        Value::Number(_) | Value::Table(_) | Value::Date => {
            let message = format!(
                "a start value is a finite number, a quantity, a string or true or false, got {}",
                written(node)
            );
            report.error(node.span, message, "");
            None
        }
    }
}
