//! Numbers of a saved state: their names, and their positions among its words.
use super::{Part, Writer};
use std::string::String;
use std::vec::Vec;

/// A number that varies continuously.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Number {
    /// Names of its parts, joined by dots.
    pub name: String,
    /// Index of its word.
    pub word: usize,
    /// True if it is computed from the rest.
    pub is_derived: bool,
}

/// A writer that records the names of the numbers of a saved state.
#[derive(Debug, Default)]
pub struct Form {
    /// The numbers in their order.
    pub numbers: Vec<Number>,
    words: usize,
    parts: Vec<Part>,
}

impl Form {
    /// The index of the word of the first number `name`.
    #[must_use]
    pub fn word(&self, name: &str) -> Option<usize> {
        self.numbers.iter().find(|number| number.name == name).map(|number| number.word)
    }
}

impl Writer for Form {
    fn number(&mut self, _: f64) {
        let names: Vec<&str> = self.parts.iter().map(|part| part.name).collect();
        let is_derived = self.parts.iter().any(|part| part.is_derived);
        self.numbers.push(Number { name: names.join("."), word: self.words, is_derived });
        self.words += 1;
    }

    fn word(&mut self, _: u64) {
        self.words += 1;
    }

    fn enter(&mut self, part: Part) {
        self.parts.push(part);
    }

    fn leave(&mut self) {
        self.parts.pop();
    }
}
