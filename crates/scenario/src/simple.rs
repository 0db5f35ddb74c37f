//! Keys that hold no physical quantity but a rate, a count, a text or one of a few names.
use crate::diagnostic::Report;
use crate::field::{Field, key, physical, written};

use crate::nearest::suggestion;
use crate::tree::{Node, Value};
use serde_json::{Value as Json, json};
use servobench_base::Rate;
use servobench_config::Choice;
use servobench_config::quantities::FREQUENCY;
use std::ops::RangeInclusive;

/// A task rate in whole hertz.
impl Field<&'static str> for Rate {
    fn decode(path: &str, node: &Node, _: &&'static str, report: &mut Report) -> Option<Self> {
        let (_, hertz) = physical(path, node, &[&FREQUENCY], report)?;
        let whole = Self::from_hertz(hertz).map_err(|e| e.to_string());
        match whole {
            Ok(rate) if rate.hertz() <= MAX_RATE => Some(rate),
            Ok(_) => {
                let message = format!("`{}` must be at most {MAX_RATE} Hz, got {}", key(path), written(node));
                report.error(node.span, message, "");
                None
            }
            Err(why) => {
                report.error(node.span, format!("`{}`: {why}", key(path)), "");
                None
            }
        }
    }

    fn schema(example: &&'static str) -> Json {
        json!({ "type": "string", "pattern": "^ *[0-9.eE+-]+ *[kM]?Hz *$", "examples": [example] })
    }
}

/// Ten ticks in a microsecond; no servo loop is faster.
pub(crate) const MAX_RATE: u32 = 10_000_000;

/// A count.
impl Field<RangeInclusive<u32>> for u32 {
    fn decode(path: &str, node: &Node, spec: &RangeInclusive<Self>, report: &mut Report) -> Option<Self> {
        let whole = match &node.value {
            Value::Number(number) => number.whole.and_then(|whole| Self::try_from(whole).ok()),
            _ => None,
        };
        let value = whole.filter(|value| spec.contains(value));
        if value.is_none() {
            let (low, high) = (spec.start(), spec.end());
            let message = format!("`{}` must be a whole number from {low} to {high}, got {}", key(path), written(node));
            report.error(node.span, message, "");
        }
        value
    }

    fn schema(spec: &RangeInclusive<Self>) -> Json {
        json!({ "type": "integer", "minimum": spec.start(), "maximum": spec.end() })
    }
}

impl Field for bool {
    fn decode(path: &str, node: &Node, (): &(), report: &mut Report) -> Option<Self> {
        if let Value::Bool(value) = node.value {
            return Some(value);
        }
        report.error(node.span, format!("`{}` must be true or false, got {}", key(path), written(node)), "");
        None
    }

    fn schema((): &()) -> Json {
        json!({ "type": "boolean" })
    }
}

impl Field for String {
    fn decode(path: &str, node: &Node, (): &(), report: &mut Report) -> Option<Self> {
        if let Value::Text(text) = &node.value {
            return Some(text.clone());
        }
        report.error(node.span, format!("`{}` must be a text, got {}", key(path), written(node)), "");
        None
    }

    fn schema((): &()) -> Json {
        json!({ "type": "string" })
    }
}

/// One of the named values of the type.
pub(crate) struct OneOf;

impl<T: Choice> Field<OneOf> for T {
    fn decode(path: &str, node: &Node, OneOf: &OneOf, report: &mut Report) -> Option<Self> {
        let names = || Self::ALL.iter().map(|(name, ..)| *name);
        let Some(text) = node.value.as_text() else {
            let list = names().map(|name| format!("\"{name}\"")).collect::<Vec<_>>().join(", ");
            let message = format!("`{}` must be one of {list}, got {}", key(path), written(node));
            report.error(node.span, message, "");
            return None;
        };
        let found = Self::from_name(text);
        if found.is_none() {
            let message = format!("`{}` has no value \"{text}\"", key(path));
            report.error(node.span, message, suggestion(text, names()));
        }
        found
    }

    fn schema(OneOf: &OneOf) -> Json {
        let each = Self::ALL.iter().map(|(name, _, meaning)| json!({ "const": name, "description": meaning }));
        json!({ "oneOf": each.collect::<Vec<_>>() })
    }
}
