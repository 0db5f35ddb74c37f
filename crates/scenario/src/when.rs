//! Conditions: the name of an output, or a table.
use crate::diagnostic::Report;
use crate::field::{Field, key, written};

use crate::file::Condition;
use crate::source::At;
use crate::tree::{Node, Value};
use serde_json::{Value as Json, json};

/// A condition as written in a file.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum When {
    /// An output becomes TRUE: "first.Done".
    Output(At<String>),
    /// The table.
    Condition(Box<Condition>),
}

impl Field for When {
    fn decode(path: &str, node: &Node, (): &(), report: &mut Report) -> Option<Self> {
        match &node.value {
            Value::Text(text) => Some(Self::Output(At { value: text.clone(), span: node.span })),
            Value::Table(_) => Condition::decode(path, node, &(), report).map(Box::new).map(Self::Condition),
            _ => {
                let message = format!("`{}` must be an output or a table, got {}", key(path), written(node));
                report.error(node.span, message, "write \"first.Done\" or { at = \"0.2 s\" }");
                None
            }
        }
    }

    fn schema((): &()) -> Json {
        json!({
            "title": "condition",
            "anyOf": [{ "type": "string", "examples": ["first.Done"] }, Condition::schema(&())],
        })
    }
}
