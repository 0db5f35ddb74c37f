//! `[limits]`: metrics by name, each with its limit.
use crate::diagnostic::Report;
use crate::field::Field;
use crate::source::At;
use crate::table::object_schema;
use crate::tree::{Node, Value};
use serde_json::{Value as Json, json};
use servobench_files::suggestion;
use servobench_metrics::{Limit, Name};

/// Limits in the order of the file.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct LimitTable(pub(crate) Vec<At<Limit>>);

impl Field for LimitTable {
    fn decode(path: &str, node: &Node, (): &(), report: &mut Report) -> Option<Self> {
        let Value::Table(table) = &node.value else {
            let message = format!("`{path}` must be a table, got {}", node.value.kind());
            report.error(node.span, message, format!("write `[{path}]`"));
            return None;
        };
        let mut limits = Vec::new();
        for entry in &table.entries {
            let Ok(metric) = entry.key.parse::<Name>() else {
                let names = Name::ALL.iter().map(|metric| metric.as_str());
                report.error(entry.key_span, format!("unknown metric `{}`", entry.key), suggestion(&entry.key, names));
                continue;
            };
            let limit = limit(&format!("{path}.{metric}"), metric, &entry.node, report);
            limits.extend(limit.map(|value| At { value, span: entry.key_span }));
        }
        Some(Self(limits))
    }

    fn schema((): &()) -> Json {
        let keys = Name::ALL.iter().map(|metric| {
            let end = f64::schema(&metric.end_of_range());
            let range = json!({
                "type": "object",
                "additionalProperties": false,
                "minProperties": 1,
                "properties": { "min": end, "max": end },
            });
            let schema = json!({ "anyOf": [f64::schema(&metric.largest()), range] });
            (metric.as_str(), vec![metric.meaning()], schema)
        });
        let keys: Vec<_> = keys.collect();
        let keys = keys.iter().map(|(name, doc, schema)| (*name, ("", doc.as_slice()), schema.clone())).collect();
        object_schema(&["Limits by metric."], &[], keys)
    }
}

fn limit(path: &str, metric: Name, node: &Node, report: &mut Report) -> Option<Limit> {
    let Value::Table(range) = &node.value else {
        let max = f64::decode(path, node, &metric.largest(), report)?;
        return Some(Limit { metric, min: None, max: Some(max) });
    };
    let mut bounds = [None, None];
    let mut is_right = true;
    for entry in &range.entries {
        let slot = match entry.key.as_str() {
            "min" => 0,
            "max" => 1,
            other => {
                report.error(
                    entry.key_span,
                    format!("unknown key `{other}` in `{path}`"),
                    suggestion(other, ["min", "max"]),
                );
                is_right = false;
                continue;
            }
        };
        bounds[slot] = f64::decode(&format!("{path}.{}", entry.key), &entry.node, &metric.end_of_range(), report);
        is_right &= bounds[slot].is_some();
    }
    match bounds {
        _ if !is_right => None,
        [None, None] => {
            report.error(node.span, format!("`{metric}` has no bound"), "give `min`, `max` or both");
            None
        }
        [Some(min), Some(max)] if min > max => {
            report.error(node.span, format!("`{metric}` has a `min` above its `max`"), "");
            None
        }
        [min, max] => Some(Limit { metric, min, max }),
    }
}
