//! `[limits]`: metrics by name, each with its limit; those of an axis with a name also in `[limits.x]`.
use crate::axis_name::no_axis;
use crate::diagnostic::Report;
use crate::field::Field;
use crate::source::At;
use crate::table::object_schema;
use crate::tree::{Node, Value};
use serde_json::{Value as Json, json};
use servobench_base::AxisName;
use servobench_files::suggestion;
use servobench_metrics::{Limit, Name};

/// Limits in the order of the file.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct LimitTable(pub(crate) Vec<At<Limit>>);

impl Field for LimitTable {
    fn decode(path: &str, node: &Node, (): &(), report: &mut Report) -> Option<Self> {
        let limits = limits_in(path, node, report.axis_name, report)?;
        for (index, At { value, span }) in limits.iter().enumerate() {
            if limits[..index].iter().any(|before| before.value.metric == value.metric) {
                report.error(*span, format!("`{}` has two limits", value.metric), "leave one of them out");
            }
        }
        Some(Self(limits))
    }

    fn schema((): &()) -> Json {
        let mut schema = schema_of_metrics();
        // `[limits.x]` of the axis `x`, whose name a schema cannot know.
        let metrics: Vec<_> = Name::ALL.iter().map(|metric| metric.as_str()).collect();
        schema["additionalProperties"] =
            json!({ "type": "object", "minProperties": 1, "propertyNames": { "enum": metrics } });
        schema
    }
}

/// The limits in the table `node`; those of `axis` may be in a table of its name.
fn limits_in(path: &str, node: &Node, axis: Option<AxisName>, report: &mut Report) -> Option<Vec<At<Limit>>> {
    let Value::Table(table) = &node.value else {
        let message = format!("`{path}` must be a table, got {}", node.value.kind());
        report.error(node.span, message, format!("write `[{path}]`"));
        return None;
    };
    let mut limits = Vec::new();
    for entry in &table.entries {
        if axis.is_some_and(|axis| axis.as_str() == entry.key) {
            limits.extend(limits_in(&format!("{path}.{}", entry.key), &entry.node, None, report)?);
            continue;
        }
        let Ok(metric) = entry.key.parse::<Name>() else {
            let names = Name::ALL.iter().map(|metric| metric.as_str());
            let help = if has_metrics(&entry.node) {
                no_axis(&entry.key, report.axis_name)
            } else {
                suggestion(&entry.key, names)
            };
            report.error(entry.key_span, format!("unknown metric `{}`", entry.key), help);
            continue;
        };
        let limit = limit(&format!("{path}.{metric}"), metric, &entry.node, report);
        limits.extend(limit.map(|value| At { value, span: entry.key_span }));
    }
    Some(limits)
}

/// True of a table whose keys are metrics, as that of an axis.
fn has_metrics(node: &Node) -> bool {
    let is_metric = |key: &str| key.parse::<Name>().is_ok();
    node.value.as_table().is_some_and(|table| table.entries.iter().any(|entry| is_metric(&entry.key)))
}

fn schema_of_metrics() -> Json {
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
