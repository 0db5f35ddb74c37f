//! The key of an override, part by part: `program[1].move_to`.
use std::ops::Range;

/// A part of a key.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Part {
    /// A key, or the digits of an index.
    pub(super) name: String,
    /// True if it is in brackets.
    pub(super) is_index: bool,
    /// Its byte range.
    pub(super) place: Range<usize>,
}

/// An example for messages about a missing key or value.
const EXAMPLE: &str = "write a key and its value, as in setpoint.jerk='200 m/s3' or program[0].move_to='100 mm'";

/// The key that begins at `start` of `words`, and the offset of its value, after `=`.
///
/// # Errors
/// The mistake, in words.
pub(super) fn read(words: &str, start: usize) -> Result<(Vec<Part>, usize), String> {
    let mut reader = Reader { words, at: start };
    let mut path = Vec::new();
    loop {
        path.push(reader.name()?);
        while reader.next_is('[') {
            path.push(reader.index()?);
        }
        reader.skip_spaces();
        match reader.take() {
            Some('.') => {}
            Some('=') => return Ok((path, reader.at)),
            None => return Err(format!("missing `=`: {EXAMPLE}")),
            Some(other) => {
                return Err(format!(
                    "`{other}` cannot be in a key: put a part with it in quotes, as in fmu[0].parameters.'a b'=1"
                ));
            }
        }
    }
}

/// A key in its usual notation.
pub(super) fn written(path: &[Part]) -> String {
    let mut text = String::new();
    for part in path {
        let is_bare = !part.name.is_empty() && part.name.chars().all(is_bare);
        let point = if text.is_empty() { "" } else { "." };
        let (before, after) = match (part.is_index, is_bare) {
            (true, _) => ("[", "]"),
            (false, true) => (point, ""),
            (false, false) if text.is_empty() => ("'", "'"),
            (false, false) => (".'", "'"),
        };
        text.extend([before, &part.name, after]);
    }
    text
}

/// True if a key with `c` needs no quotes.
const fn is_bare(c: char) -> bool {
    c.is_ascii_alphanumeric() || c == '_' || c == '-'
}

struct Reader<'a> {
    words: &'a str,
    at: usize,
}

impl Reader<'_> {
    fn rest(&self) -> &str {
        &self.words[self.at..]
    }

    fn next_is(&self, wanted: char) -> bool {
        self.rest().starts_with(wanted)
    }

    fn take(&mut self) -> Option<char> {
        let next = self.rest().chars().next()?;
        self.at += next.len_utf8();
        Some(next)
    }

    fn skip_spaces(&mut self) {
        self.at += self.rest().len() - self.rest().trim_start().len();
    }

    /// A bare or quoted name.
    fn name(&mut self) -> Result<Part, String> {
        self.skip_spaces();
        let start = self.at;
        let name = if let Some(quote @ ('"' | '\'')) = self.rest().chars().next() {
            self.take();
            let length = self.rest().find(quote).ok_or_else(|| format!("the quote {quote} of a key is not closed"))?;
            let name = self.rest()[..length].to_owned();
            self.at += length + 1;
            name
        } else {
            let length = self.rest().find(|c| !is_bare(c)).unwrap_or(self.rest().len());
            let name = self.rest()[..length].to_owned();
            self.at += length;
            name
        };
        if self.at == start {
            return Err(match self.rest().chars().next() {
                None | Some('.' | '=' | '[') => format!("a key is missing: {EXAMPLE}"),
                Some(other) => format!("`{other}` cannot begin a key: {EXAMPLE}"),
            });
        }
        Ok(Part { name, is_index: false, place: start..self.at })
    }

    /// `[1]`
    fn index(&mut self) -> Result<Part, String> {
        let start = self.at;
        self.take();
        let length = self.rest().find(|c: char| !c.is_ascii_digit()).unwrap_or(self.rest().len());
        let digits = self.rest()[..length].to_owned();
        self.at += length;
        if digits.is_empty() || self.take() != Some(']') {
            return Err(
                "an element of a list is named by its number from 0 on, as in program[0].move_to='100 mm'".into()
            );
        }
        // Without leading zeros, for comparison with other keys.
        let digits = digits.trim_start_matches('0');
        let name = if digits.is_empty() { "0" } else { digits }.to_owned();
        Ok(Part { name, is_index: true, place: start..self.at })
    }
}
