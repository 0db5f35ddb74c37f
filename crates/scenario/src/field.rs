//! Values of keys: how they are read, the messages for mistakes, and their JSON Schema.
use crate::diagnostic::Report;
use crate::quantity;
use crate::reading::{self, ReadError, names, proposals};
use crate::source::{At, Span};
use crate::tree::{Node, Number, Value};
use serde_json::{Value as Json, json};
use servobench_config::quantities::RATIO;
use servobench_config::{Bound, Kind, Measure, Parameter, Physical};
use std::ops::Range;

/// A type of the value of a key; `Spec` holds requirements beyond the type: a dimension, a bound.
pub(crate) trait Field<Spec = ()>: Sized {
    /// Reads `node`; `path` is `drive.velocity.rate`. Reports a mistake and returns `None`.
    fn decode(path: &str, node: &Node, spec: &Spec, report: &mut Report) -> Option<Self>;

    /// JSON Schema of the values that [`Self::decode`] accepts.
    fn schema(spec: &Spec) -> Json;

    /// Meaning of the parameter according to its owner; precedes the documentation of the key.
    fn meaning(_spec: &Spec) -> &'static str {
        ""
    }
}

/// The value of a key, if there is one.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Slot<T> {
    /// The key is not in the file.
    Absent,
    /// The value is wrong, which has been reported.
    Wrong(Span),
    /// Its value.
    Given(At<T>),
}

impl<T> Slot<T> {
    pub(crate) fn given(&self) -> Option<&T> {
        self.at().map(|at| &at.value)
    }

    pub(crate) fn at(&self) -> Option<&At<T>> {
        if let Self::Given(at) = self { Some(at) } else { None }
    }

    /// The value of a key that may be left out.
    ///
    /// # Errors
    /// [`Reported`] when the value is wrong.
    pub(crate) fn optional(&self) -> Result<Option<&T>, Reported> {
        match self {
            Self::Absent => Ok(None),
            Self::Wrong(_) => Err(Reported),
            Self::Given(at) => Ok(Some(&at.value)),
        }
    }

    /// Place of the value, right or wrong.
    pub(crate) fn span(&self) -> Option<Span> {
        match self {
            Self::Absent => None,
            Self::Wrong(span) | Self::Given(At { span, .. }) => Some(*span),
        }
    }
}

/// A mistake has been reported.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Reported;

/// Last part of a path.
pub(crate) fn key(path: &str) -> &str {
    path.rsplit('.').next().unwrap_or(path)
}

/// Number and unit; the unit itself is checked on reading.
const QUANTITY_PATTERN: &str = r"^ *[-+]?([0-9]+[.]?[0-9]*|[.][0-9]+)([eE][-+]?[0-9]+)? *(1/)?[A-Za-z%°µμΩΩ(].*$";

/// A physical quantity (SI).
impl Field<Measure> for f64 {
    fn decode(path: &str, node: &Node, spec: &Measure, report: &mut Report) -> Option<Self> {
        let candidates: Vec<_> = spec.kind.candidates(report.axis, report.motor).collect();
        let (_, value) = physical(path, node, &candidates, report)?;
        if spec.bound.holds(value) {
            return Some(value);
        }
        let message = format!("`{}` must be {}, got {}", key(path), spec.bound, written(node));
        report.error(node.span, message, "");
        None
    }

    fn schema(spec: &Measure) -> Json {
        if !spec.is_ratio() {
            return json!({
                "type": "string",
                "pattern": QUANTITY_PATTERN,
                "examples": [spec.example],
                "x-quantity": described(spec),
            });
        }
        let mut number = json!({ "type": "number" });
        match spec.bound {
            Bound::Positive => number["exclusiveMinimum"] = json!(0),
            Bound::NotNegative => number["minimum"] = json!(0),
            Bound::Within(low, high) => {
                number["minimum"] = json!(low);
                number["maximum"] = json!(high);
            }
            Bound::Any => {}
        }
        json!({ "anyOf": [number, { "type": "string", "pattern": "^ *[-+]?[0-9.]+ *%? *$" }] })
    }
}

/// Quantity, bound and coordinate, for the reference: `a mass or a moment of inertia, above zero (motor coordinate)`.
fn described(spec: &Measure) -> String {
    let quantity = names(&spec.kind.candidates(None, None).collect::<Vec<_>>());
    let bound = if spec.bound == Bound::Any { String::new() } else { format!(", {}", spec.bound) };
    let coordinate = match spec.kind {
        Kind::Plain(_) => "",
        Kind::Axis(_) => " (axis coordinate)",
        Kind::Motor(_) => " (motor coordinate)",
    };
    format!("{quantity}{bound}{coordinate}")
}

/// A parameter that its owner describes; the `title` is the name by which errors call it.
impl Field<Parameter> for f64 {
    fn decode(path: &str, node: &Node, spec: &Parameter, report: &mut Report) -> Option<Self> {
        <Self as Field<Measure>>::decode(path, node, &spec.measure, report)
    }

    fn schema(spec: &Parameter) -> Json {
        let mut schema = <Self as Field<Measure>>::schema(&spec.measure);
        schema["title"] = spec.name.into();
        schema
    }

    fn meaning(spec: &Parameter) -> &'static str {
        spec.meaning
    }
}

impl Field<&'static Parameter> for f64 {
    fn decode(path: &str, node: &Node, spec: &&'static Parameter, report: &mut Report) -> Option<Self> {
        <Self as Field<Parameter>>::decode(path, node, spec, report)
    }

    fn schema(spec: &&'static Parameter) -> Json {
        <Self as Field<Parameter>>::schema(spec)
    }

    fn meaning(spec: &&'static Parameter) -> &'static str {
        spec.meaning
    }
}

/// A quantity of one of two kinds: a gain per velocity or in volts per velocity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Either {
    First(f64),
    Second(f64),
}

/// Requirements on an [`Either`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct EitherMeasure {
    pub(crate) first: Kind,
    pub(crate) second: Kind,
    pub(crate) example: &'static str,
}

impl Field<EitherMeasure> for Either {
    fn decode(path: &str, node: &Node, spec: &EitherMeasure, report: &mut Report) -> Option<Self> {
        let mut candidates: Vec<_> = spec.first.candidates(report.axis, report.motor).collect();
        let firsts = candidates.len();
        candidates.extend(spec.second.candidates(report.axis, report.motor));
        let (which, value) = physical(path, node, &candidates, report)?;
        if value > 0.0 {
            return Some(if which < firsts { Self::First(value) } else { Self::Second(value) });
        }
        report.error(node.span, format!("`{}` must be above zero, got {}", key(path), written(node)), "");
        None
    }

    fn schema(spec: &EitherMeasure) -> Json {
        json!({ "type": "string", "pattern": QUANTITY_PATTERN, "examples": [spec.example] })
    }
}

/// Reads a quantity that is one of `candidates`; returns the index of the candidate, and the value in the candidate's unit.
pub(crate) fn physical(
    path: &str,
    node: &Node,
    candidates: &[&'static Physical],
    report: &mut Report,
) -> Option<(usize, f64)> {
    let key = key(path);
    let ratio = candidates.iter().position(|physical| **physical == RATIO);
    match (&node.value, ratio) {
        (Value::Number(number), Some(which)) => {
            if !number.value.is_finite() {
                report.error(node.span, format!("`{key}` must be finite, got {}", number.text), "");
            } else if let Some(why) = quantity::objection(number.value, number.value == 0.0) {
                report.error(node.span, format!("`{key}`: {why}"), "");
            } else {
                return Some((which, number.value));
            }
        }
        (Value::Number(number), None) => {
            let help = proposals(&number.text, candidates);
            report.error(node.span, format!("`{key}` needs a unit, got the bare number {}", number.text), help);
        }
        (Value::Quantity { number, unit, .. }, _) if let Some(read) = reading::amount(*number, unit, candidates) => {
            return Some(read);
        }
        (Value::Text(text) | Value::Quantity { text, .. }, _) => match reading::read(text, candidates) {
            Ok(read) => return Some(read),
            Err(ReadError::NoQuantity(e)) => {
                report.error(within(node.span, text, &e.at), format!("`{key}`: {}", e.message), e.help);
            }
            Err(ReadError::NoUnit) => {
                let number = text.trim();
                let message = format!("`{key}` needs a unit, got the bare number {number}");
                report.error(node.span, message, proposals(number, candidates));
            }
            Err(ReadError::OtherDimension { is, help }) => {
                let message = format!("`{key}` must be {}, but \"{text}\" is {is}", names(candidates));
                report.error(node.span, message, help);
            }
        },
        (other, _) => {
            let message = format!("`{key}` must be {}, got {}", names(candidates), other.kind());
            report.error(node.span, message, proposals("1", candidates));
        }
    }
    None
}

/// The value as written in the file.
pub(crate) fn written(node: &Node) -> String {
    match &node.value {
        Value::Text(text) | Value::Quantity { text, .. } => format!("\"{text}\""),
        Value::Number(Number { text, .. }) => text.clone(),
        Value::Bool(value) => value.to_string(),
        other => other.kind().to_owned(),
    }
}

/// The place of `part` of a text: exact if the file holds the text without escapes. On the command line it needs no quotes.
fn within(span: Span, text: &str, part: &Range<usize>) -> Span {
    let quotes = (span.end - span.start).checked_sub(text.len());
    if let Some(quotes @ (0 | 2)) = quotes {
        let quote = quotes / 2;
        let start = span.start + quote;
        // An empty part would mark nothing.
        let end = part.end.max(part.start + 1).min(text.len() + quote);
        Span { start: start + part.start, end: start + end, ..span }
    } else {
        span
    }
}
