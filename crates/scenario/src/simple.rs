//! Keys whose values are not physical quantities but a rate, a count, a text or one of a few names.
use crate::diagnostic::Report;
use crate::field::{Field, key, physical, written};

use crate::tree::{Node, Value};
use serde_json::{Value as Json, json};
use servobench_base::Rate;
use servobench_config::Choice;
use servobench_config::quantities::FREQUENCY;
use servobench_files::suggestion;
use std::iter;
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
        json!({
            "type": "string",
            "pattern": "^ *[0-9.eE+-]+ *[kM]?Hz *$",
            "examples": [example],
            "x-quantity": "a frequency in whole hertz",
        })
    }
}

/// Highest rate (Hz): ten ticks in a microsecond; no servo loop is faster.
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
        if let Some(text) = node.value.as_text() {
            return Some(text.to_owned());
        }
        report.error(node.span, format!("`{}` must be a string, got {}", key(path), written(node)), "");
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
        one_of(path, node, Self::ALL.iter().map(|(name, value, _)| (*name, *value)), report)
    }

    fn schema(OneOf: &OneOf) -> Json {
        schema_of(Self::ALL.iter().map(|(name, _, meaning)| (*name, *meaning)))
    }
}

/// One of a few names.
pub(crate) struct Name(pub(crate) &'static str);

/// Names and meanings.
type Names = &'static [(&'static str, &'static str)];

impl Field<Names> for Name {
    fn decode(path: &str, node: &Node, names: &Names, report: &mut Report) -> Option<Self> {
        one_of(path, node, names.iter().map(|(name, _)| (*name, Self(name))), report)
    }

    fn schema(names: &Names) -> Json {
        schema_of(names.iter().copied())
    }
}

/// One of the named values of the type, or "none" with the given meaning.
pub(crate) struct OneOfOrNone(pub(crate) &'static str);

const NONE: &str = "none";

impl<T: Choice> Field<OneOfOrNone> for Option<T> {
    fn decode(path: &str, node: &Node, _: &OneOfOrNone, report: &mut Report) -> Option<Self> {
        let named = T::ALL.iter().map(|(name, value, _)| (*name, Some(*value)));
        one_of(path, node, iter::once((NONE, None)).chain(named), report)
    }

    fn schema(OneOfOrNone(none): &OneOfOrNone) -> Json {
        let named = T::ALL.iter().map(|(name, _, meaning)| (*name, *meaning));
        schema_of(iter::once((NONE, *none)).chain(named))
    }
}

/// The one of `values` that `node` names.
fn one_of<T>(
    path: &str,
    node: &Node,
    values: impl Iterator<Item = (&'static str, T)> + Clone,
    report: &mut Report,
) -> Option<T> {
    let names = values.clone().map(|(name, _)| name);
    let Some(text) = node.value.as_text() else {
        let list = names.map(|name| format!("\"{name}\"")).collect::<Vec<_>>().join(", ");
        let message = format!("`{}` must be one of {list}, got {}", key(path), written(node));
        report.error(node.span, message, "");
        return None;
    };
    let found = values.into_iter().find(|(name, _)| *name == text);
    if found.is_none() {
        let message = format!("\"{text}\" is not a value of `{}`", key(path));
        report.error(node.span, message, suggestion(text, names));
    }
    found.map(|(_, value)| value)
}

/// The schema of `values`: names and meanings.
fn schema_of(values: impl Iterator<Item = (&'static str, &'static str)>) -> Json {
    let each = values.map(|(name, meaning)| json!({ "const": name, "description": meaning }));
    json!({ "oneOf": each.collect::<Vec<_>>() })
}
