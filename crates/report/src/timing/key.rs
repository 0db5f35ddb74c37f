//! Key to the lines of a diagram: symbols with words, in as many lines as needed.
use crate::drawing::{fitted, text_width};

/// Height of a line, and margin below the last (pixels).
const LINE: f64 = 17.0;
const BELOW: f64 = 8.0;
/// Length of a symbol, distance from it to its words, and from these to the next symbol (pixels).
const SIGN: f64 = 26.0;
const WORDS: f64 = 32.0;
const APART: f64 = 18.0;
/// Size of the letters.
const LETTERS: f64 = 11.0;

/// Symbols with words.
#[derive(Debug)]
pub(super) struct Key {
    left: f64,
    right: f64,
    entries: Vec<Entry>,
    /// End of the last entry (pixels).
    end: f64,
    lines: usize,
}

#[derive(Debug)]
struct Entry {
    x: f64,
    /// Index of its line, from 0.
    line: usize,
    class: &'static str,
    colour: Option<&'static str>,
    text: String,
}

impl Key {
    /// A key from `left` to `right` (pixels), without entries.
    pub(super) const fn new(left: f64, right: f64) -> Self {
        Self { left, right, entries: Vec::new(), end: left, lines: 0 }
    }

    /// Adds the entry that lines of `class`, in `colour` if their class has none, mean `text`.
    pub(super) fn add(&mut self, class: &'static str, colour: Option<&'static str>, text: &str) {
        let text = fitted(text, self.right - self.left - WORDS, LETTERS).unwrap_or_default();
        let width = WORDS + text_width(&text, LETTERS);
        if self.lines == 0 || self.end + width > self.right {
            (self.end, self.lines) = (self.left, self.lines + 1);
        }
        self.entries.push(Entry { x: self.end, line: self.lines - 1, class, colour, text });
        self.end += width + APART;
    }

    /// Height with the margin below; zero without entries.
    pub(super) const fn height(&self) -> f64 {
        if self.lines == 0 { 0.0 } else { LINE * self.lines as f64 + BELOW }
    }

    /// Draws the entries from `top` down.
    pub(super) fn draw(&self, svg: &mut Vec<String>, top: f64) {
        svg.extend(self.entries.iter().map(|Entry { x, line, class, colour, text }| {
            let y = top + LINE * *line as f64 + 8.0;
            let stroke = colour.map_or(String::new(), |colour| format!(" stroke=\"{colour}\""));
            format!(
                "<path class=\"{class}\"{stroke} d=\"M{x:.1},{y}h{SIGN}\"/>\n\
                 <text class=\"k\" x=\"{:.1}\" y=\"{}\">{text}</text>",
                x + WORDS,
                y + 4.0
            )
        }));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_does_not_fit_goes_to_the_next_line() {
        let mut key = Key::new(10.0, 200.0);
        for text in ["set-point", "load", "CommandAborted rises"] {
            key.add("c", None, text);
        }
        let places: Vec<_> = key.entries.iter().map(|entry| (entry.line, entry.x > 10.0)).collect();
        assert_eq!(places, [(0, false), (0, true), (1, false)]);
        assert!((key.height() - 2.0 * LINE - BELOW).abs() < 1e-9);
    }
}
