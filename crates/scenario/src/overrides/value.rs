//! The value of an override: TOML where it is such, otherwise a string.
use crate::source::{SourceId, Span};
use crate::tree::{Node, Value, parse_one};

/// The value that begins at `start` of `words`, with its places there.
///
/// # Errors
/// What is wrong with it, in words.
pub(super) fn read(source: SourceId, words: &str, start: usize) -> Result<Node, String> {
    let text = words[start..].trim();
    let at = words.len() - words[start..].trim_start().len();
    let span = Span::new(source, &(at..at + text.len()));
    let Some(first) = text.chars().next() else {
        return Err("there is no value behind `=`; an empty string is written ''".into());
    };
    // A document of one key whose value lies at the same bytes as on the command line.
    let document = format!("k{}={}{}", " ".repeat(start - 2), " ".repeat(at - start), text);
    match parse_one(source, &document) {
        // A date is nothing that a scenario needs, and a remark behind a value would be dropped.
        Ok(node) if node.value != Value::Date && node.span == span => Ok(node),
        found if matches!(first, '[' | '{' | '"' | '\'') => {
            let why = found.err().unwrap_or_else(|| "there is more behind it".to_owned());
            Err(format!("the value begins like TOML, but: {why}"))
        }
        _ => Ok(Node { value: Value::Text(text.to_owned()), span }),
    }
}
