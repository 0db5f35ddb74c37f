//! The value of an override: TOML if it parses, otherwise a string.
use crate::source::{SourceId, Span};
use crate::tree::{Node, Number, Value, parse_one};

/// The value that begins at `start` of `words`, with its place there.
///
/// # Errors
/// The mistake, in words.
pub(super) fn read(words: &str, start: usize) -> Result<Node, String> {
    let text = words[start..].trim();
    let at = words.len() - words[start..].trim_start().len();
    let span = Span::new(SourceId::SCENARIO, &(at..at + text.len()));
    let Some(first) = text.chars().next() else {
        return Err("missing value after `=`; an empty string is written ''".into());
    };
    // A document of one key whose value lies at the same bytes as on the command line.
    let document = format!("k{}={}{}", " ".repeat(start - 2), " ".repeat(at - start), text);
    match parse_one(SourceId::SCENARIO, &document) {
        // No scenario needs a date, and a comment after a value would be dropped.
        Ok(node) if node.value != Value::Date && node.span == span => Ok(node),
        found if matches!(first, '[' | '{' | '"' | '\'') => {
            let why = found.err().unwrap_or_else(|| "there is more after it".to_owned());
            Err(format!("the value begins like TOML, but: {why}"))
        }
        _ => Ok(Node { value: Value::Text(text.to_owned()), span }),
    }
}

/// `number` in `unit`, written as `text`, which begins at `start` of the words; the unit of a pure number is empty.
pub(super) fn number(text: String, number: f64, unit: &str, start: usize) -> Node {
    let span = Span::new(SourceId::SCENARIO, &(start..start + text.len()));
    let value = if unit.is_empty() {
        Value::Number(Number { whole: text.parse().ok(), text, value: number })
    } else {
        Value::Quantity { text, number, unit: unit.to_owned() }
    };
    Node { value, span }
}
