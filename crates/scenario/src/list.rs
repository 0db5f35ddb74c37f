//! Keys that hold several values, or one of several types.
use crate::diagnostic::Report;
use crate::field::{Field, key, written};

use crate::quantity;
use crate::source::At;
use crate::tree::{Node, Value};
use serde_json::{Value as Json, json};
use servobench_config::quantities::RATIO;
use servobench_config::{Bound, Kind, Measure};

/// One value or a list of them.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct OneOrMany<T>(pub(crate) Vec<At<T>>);

impl<Spec, T: Field<Spec>> Field<Spec> for OneOrMany<T> {
    fn decode(path: &str, node: &Node, spec: &Spec, report: &mut Report) -> Option<Self> {
        let Value::Array(items) = &node.value else {
            let value = T::decode(path, node, spec, report)?;
            return Some(Self(vec![At { value, span: node.span }]));
        };
        if items.is_empty() {
            report.error(node.span, format!("`{}` must not be empty", key(path)), "");
            return None;
        }
        decode_items(path, items, spec, report).map(Self)
    }

    fn schema(spec: &Spec) -> Json {
        let one = T::schema(spec);
        json!({ "anyOf": [one, { "type": "array", "minItems": 1, "items": one }] })
    }
}

/// A list; a list of tables is written `[[name]]`.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Many<T>(pub(crate) Vec<At<T>>);

impl<Spec, T: Field<Spec>> Field<Spec> for Many<T> {
    fn decode(path: &str, node: &Node, spec: &Spec, report: &mut Report) -> Option<Self> {
        match &node.value {
            Value::Array(items) => decode_items(path, items, spec, report).map(Self),
            other => {
                let help = match other {
                    Value::Table(_) => format!("write `[[{path}]]`"),
                    _ => String::new(),
                };
                report.error(node.span, format!("`{}` must be a list, got {}", key(path), other.kind()), help);
                None
            }
        }
    }

    fn schema(spec: &Spec) -> Json {
        json!({ "type": "array", "items": T::schema(spec) })
    }
}

/// Reads every item, so that the mistakes in all items are found.
fn decode_items<Spec, T: Field<Spec>>(
    path: &str,
    items: &[Node],
    spec: &Spec,
    report: &mut Report,
) -> Option<Vec<At<T>>> {
    let all: Vec<Option<At<T>>> = items
        .iter()
        .map(|item| T::decode(path, item, spec, report).map(|value| At { value, span: item.span }))
        .collect();
    all.into_iter().collect()
}

/// A share from 0 to 1; `true` is 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Share(pub(crate) f64);

const SHARE: Measure = Measure { kind: Kind::Plain(&RATIO), bound: Bound::Within(0.0, 1.0), example: "0.95" };

impl Field for Share {
    fn decode(path: &str, node: &Node, (): &(), report: &mut Report) -> Option<Self> {
        match &node.value {
            Value::Bool(all) => Some(Self(f64::from(u8::from(*all)))),
            Value::Text(text) if !quantity::begins_with_a_number(text) => {
                let message =
                    format!("`{}` must be true, false or a share from 0 to 1, got {}", key(path), written(node));
                report.error(node.span, message, "");
                None
            }
            _ => f64::decode(path, node, &SHARE, report).map(Self),
        }
    }

    fn schema((): &()) -> Json {
        json!({ "anyOf": [{ "type": "boolean" }, f64::schema(&SHARE)] })
    }
}

/// A value, or "auto" for the computed one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Automatic {
    Auto,
    Given(f64),
}

/// A bound, or "none".
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum BoundOrNone {
    None,
    Given(f64),
}

impl Field<Measure> for BoundOrNone {
    fn decode(path: &str, node: &Node, spec: &Measure, report: &mut Report) -> Option<Self> {
        match node.value.as_text() {
            Some("none") => Some(Self::None),
            Some(text) if !quantity::begins_with_a_number(text) => {
                let (key, example) = (key(path), spec.example);
                let message = format!("`{key}` must be \"none\" or a value like {example}, got {}", written(node));
                report.error(node.span, message, "");
                None
            }
            _ => f64::decode(path, node, spec, report).map(Self::Given),
        }
    }

    fn schema(spec: &Measure) -> Json {
        json!({ "anyOf": [{ "const": "none" }, f64::schema(spec)] })
    }
}

impl Field<Measure> for Automatic {
    fn decode(path: &str, node: &Node, spec: &Measure, report: &mut Report) -> Option<Self> {
        match node.value.as_text() {
            Some("auto") => Some(Self::Auto),
            Some(text) if !quantity::begins_with_a_number(text) => {
                let (key, example) = (key(path), spec.example);
                let message = format!("`{key}` must be \"auto\" or a value like {example}, got {}", written(node));
                report.error(node.span, message, "");
                None
            }
            _ => f64::decode(path, node, spec, report).map(Self::Given),
        }
    }

    fn schema(spec: &Measure) -> Json {
        json!({ "anyOf": [{ "const": "auto" }, f64::schema(spec)] })
    }
}
