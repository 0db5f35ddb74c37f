//! What the TOML parser finds wrong.
use std::ops::Range;

/// An error of syntax and its bytes.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct SyntaxError {
    pub(super) span: Range<usize>,
    pub(super) kind: Kind,
    pub(super) message: String,
}

/// The errors that are more than their message here.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    /// A key or table is there already.
    Duplicate,
    /// The parser gives up at a key without a value.
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
    /// The crate `toml` has one type of error for everything, whose message is all that tells them apart: this is the one place that
    /// reads it, and tests of the tree fail when a release words it otherwise.
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
