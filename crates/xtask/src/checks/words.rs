//! Words that the project avoids, and doc comments that begin with a relative clause.
use std::ops::AddAssign;

/// Counts of a text.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct Words {
    /// Doc comments that begin with a relative clause in place of a name.
    pub(super) clauses: usize,
    pub(super) in_comments: usize,
    pub(super) in_strings: usize,
}

impl AddAssign for Words {
    fn add_assign(&mut self, other: Self) {
        self.clauses += other.clauses;
        self.in_comments += other.in_comments;
        self.in_strings += other.in_strings;
    }
}

/// Beginnings of a relative clause.
const CLAUSES: [&str; 11] = ["What", "Whether", "How", "It", "That", "Of", "Who", "Where", "Which", "When", "Somebody"];

/// Avoided words and phrases, each as it stands between other words, in lower case.
const WORDS: [&str; 17] = [
    "told",
    "said",
    "asked",
    "somebody",
    "boxes",
    "is no",
    "are no",
    "unless given",
    "held against",
    "goes on",
    "of its own",
    "its very",
    "on paper",
    "makes the way",
    "made sure of",
    "shakes",
    "broken off",
];

/// Counts `source`, a file of Rust.
pub(super) fn count(source: &str) -> Words {
    let mut found = Words::default();
    let mut is_inside = false;
    for part in parts(source) {
        match part {
            Part::Doc(text) => {
                let first = text.split(|c: char| !c.is_alphabetic()).next().unwrap_or_default();
                found.clauses += usize::from(!is_inside && CLAUSES.contains(&first));
                found.in_comments += in_text(text);
                is_inside = true;
            }
            Part::Comment(text) => found.in_comments += in_text(text),
            Part::String(text) => {
                is_inside = false;
                found.in_strings += in_text(text);
            }
            Part::Code => is_inside = false,
        }
    }
    found
}

fn in_text(text: &str) -> usize {
    let plain: String = text.chars().map(|c| if c.is_alphanumeric() { c.to_ascii_lowercase() } else { ' ' }).collect();
    let spaced = format!(" {} ", plain.split_whitespace().collect::<Vec<_>>().join(" "));
    WORDS.iter().map(|word| spaced.matches(&format!(" {word} ")).count()).sum()
}

/// A part of a line of Rust, or of several.
#[derive(Debug, PartialEq, Eq)]
enum Part<'a> {
    Doc(&'a str),
    Comment(&'a str),
    String(&'a str),
    Code,
}

/// The parts of `source` in their order, code without its text.
fn parts(source: &str) -> Vec<Part<'_>> {
    let mut parts = Vec::new();
    let mut rest = source;
    while let Some(at) = rest.find(['/', '"', '\'', 'r']) {
        if !rest[..at].trim().is_empty() {
            parts.push(Part::Code);
        }
        let before = rest[..at].chars().next_back();
        rest = &rest[at..];
        let (part, length) = next(rest, before);
        parts.extend(part);
        rest = &rest[length..];
    }
    parts
}

/// The part that begins `text`, behind the character `before`, and its length in bytes.
fn next(text: &str, before: Option<char>) -> (Option<Part<'_>>, usize) {
    if let Some(comment) = text.strip_prefix("//") {
        let line = comment.split('\n').next().unwrap_or_default();
        let doc = line.strip_prefix('/').or_else(|| line.strip_prefix('!'));
        let part = doc.map_or(Part::Comment(line), |doc| Part::Doc(doc.trim_start()));
        return (Some(part), 2 + line.len());
    }
    if let Some(inner) = text.strip_prefix('"') {
        let length = closed(inner);
        return (Some(Part::String(&inner[..length])), (length + 2).min(text.len()));
    }
    let hashes = text[1..].bytes().take_while(|byte| *byte == b'#').count();
    let is_raw = text.starts_with('r') && !before.is_some_and(|c| c.is_alphanumeric() || c == '_');
    if is_raw && text[1 + hashes..].starts_with('"') {
        let inner = &text[2 + hashes..];
        let end = format!("\"{}", "#".repeat(hashes));
        let length = inner.find(&end).unwrap_or(inner.len());
        return (Some(Part::String(&inner[..length])), (2 + hashes + length + end.len()).min(text.len()));
    }
    // A quotation mark as a character; a lifetime has no second mark.
    let character = ["'\"'", "'\\\"'", "'\\''"].into_iter().find(|literal| text.starts_with(literal));
    (Some(Part::Code), character.map_or_else(|| text.chars().next().map_or(1, char::len_utf8), str::len))
}

/// Bytes of a string up to the mark that closes it.
fn closed(text: &str) -> usize {
    let mut is_escaped = false;
    for (at, c) in text.char_indices() {
        match c {
            '"' if !is_escaped => return at,
            '\\' => is_escaped = !is_escaped,
            _ => is_escaped = false,
        }
    }
    text.len()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clauses_and_words_are_counted_where_they_stand() {
        let source = "/// What it is told.\n/// How it goes on.\nfn a() -> &'static str { \"this is no \\\" table\" }\n\n\
                      /// A name, whether told or not.\n// somebody\nfn b() { let _ = ('\"', r#\"told \"asked\"\"#); }\n\
                      /// Whether it is.\nconst C: bool = true;\n";
        assert_eq!(count(source), Words { clauses: 2, in_comments: 4, in_strings: 3 });
    }

    #[test]
    fn a_division_and_a_lifetime_are_code() {
        assert_eq!(
            count("fn a<'a>(x: &'a f64) -> f64 { x / 2.0 } // told"),
            Words { in_comments: 1, ..Words::default() }
        );
    }
}
