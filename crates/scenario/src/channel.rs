//! A signal of the axis, by its name.
use crate::axis_name::{PATTERN, suggestion_on, within};
use crate::diagnostic::Report;
use crate::field::{Field, key, written};
use crate::tree::Node;
use serde_json::{Value as Json, json};
use servobench_signals::Signal;

impl Field for Signal {
    fn decode(path: &str, node: &Node, (): &(), report: &mut Report) -> Option<Self> {
        let names = || Self::ALL.iter().map(|signal| signal.name());
        let Some(text) = node.value.as_text() else {
            let list = names().map(|name| format!("\"{name}\"")).collect::<Vec<_>>().join(", ");
            let message = format!("`{}` must be one of {list}, got {}", key(path), written(node));
            report.error(node.span, message, "");
            return None;
        };
        let found = within(text, report.axis_name).parse().ok();
        if found.is_none() {
            let message = format!("\"{text}\" is not a value of `{}`", key(path));
            report.error(node.span, message, suggestion_on(text, report.axis_name, names()));
        }
        found
    }

    fn schema((): &()) -> Json {
        let description = |signal: &Self| format!("[{}] {}", signal.unit(), signal.meaning());
        let each = Self::ALL.iter().map(|signal| json!({ "const": signal.name(), "description": description(signal) }));
        // With the name of the axis in front; which axis that is, a schema cannot tell.
        let of_axis = format!("^{PATTERN}[.][a-z_]+([.][a-z_]+)+$");
        let of_axis = json!({ "type": "string", "pattern": of_axis });
        json!({ "anyOf": [{ "oneOf": each.collect::<Vec<_>>() }, of_axis] })
    }
}
