//! Errors of the TOML parser.
use std::ops::Range;

/// A syntax error with its byte range.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct SyntaxError {
    pub(super) span: Range<usize>,
    pub(super) kind: Kind,
    pub(super) message: String,
}

/// Errors that are treated separately.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    /// A duplicate key or table.
    Duplicate,
    /// A key without a value, at which the parser stops.
    KeyWithoutValue,
    /// A text without quotes.
    Unquoted,
    /// A list or an inline table without its closing bracket.
    Unclosed,
    Other,
}

impl SyntaxError {
    pub(super) fn of(error: &toml::de::Error) -> Self {
        let message = error.message().to_owned();
        Self { span: error.span().unwrap_or_default(), kind: Kind::of(&message), message }
    }
}

impl Kind {
    /// The crate `toml` has a single error type, and only the message distinguishes the errors: this is the only place that reads it, and
    /// tests of the tree fail when a release changes the wording.
    fn of(message: &str) -> Self {
        const KINDS: [(&str, Kind); 5] = [
            ("duplicate key", Kind::Duplicate),
            ("key with no value", Kind::KeyWithoutValue),
            ("string values must be quoted", Kind::Unquoted),
            ("unclosed array,", Kind::Unclosed),
            ("unclosed inline table", Kind::Unclosed),
        ];
        KINDS.iter().find(|(start, _)| message.starts_with(start)).map_or(Self::Other, |(_, kind)| *kind)
    }
}
