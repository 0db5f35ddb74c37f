//! Numbers of a saved state: their names, and where they are among its words.
use crate::LinearError;
use servobench_base::state::{Part, Writer};

/// A number that varies continuously.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Number {
    /// Names of the parts that it belongs to, with dots between them.
    pub(crate) name: String,
    /// Its word.
    pub(crate) word: usize,
    /// True where it is computed from the rest.
    pub(crate) is_derived: bool,
}

/// A saved state with the names of its numbers.
#[derive(Debug, Default)]
pub struct Form {
    pub(crate) numbers: Vec<Number>,
    words: usize,
    parts: Vec<Part>,
}

impl Form {
    /// Puts `value` for the number `name` among the words of a saved state of this form.
    ///
    /// # Errors
    /// [`LinearError::NoSuchNumber`].
    pub fn put(&self, words: &mut [u64], name: &str, value: f64) -> Result<(), LinearError> {
        let number = self.numbers.iter().find(|number| number.name == name);
        let word = number.and_then(|number| words.get_mut(number.word));
        *word.ok_or_else(|| LinearError::NoSuchNumber(name.to_owned()))? = value.to_bits();
        Ok(())
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

/// The numbers alone.
pub(crate) struct Values<'a>(pub(crate) &'a mut Vec<f64>);

impl Writer for Values<'_> {
    fn number(&mut self, value: f64) {
        self.0.push(value);
    }

    fn word(&mut self, _: u64) {}

    fn enter(&mut self, _: Part) {}

    fn leave(&mut self) {}
}
