//! Quotes of a foreign file in messages: enough to find the word, too little to read the file.
//!
//! A scenario may name any file. A mistake in it is reported with its place; a message that quoted whole lines would print any file that a
//! user names into the log of a build that everyone can read.
use std::fmt;

/// Largest number of characters of a foreign word in a message.
pub const MOST_QUOTED: usize = 12;
/// Largest number of characters of a name.
const LONGEST_NAME: usize = 40;

/// The beginning of a text, with `…` for the omitted part, and without control characters.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Quoted<'a> {
    text: &'a str,
    most: usize,
}

/// The beginning of `text`, as messages quote it.
#[must_use]
pub const fn quoted(text: &str) -> Quoted<'_> {
    Quoted { text, most: MOST_QUOTED }
}

/// The beginning of a name that identifies a part of a file, of a joint or a variable: as few characters as of other words would not
/// distinguish two of them.
#[must_use]
pub const fn named(name: &str) -> Quoted<'_> {
    Quoted { text: name, most: LONGEST_NAME }
}

impl fmt::Display for Quoted<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut letters = self.text.chars();
        for letter in letters.by_ref().take(self.most) {
            let shown = if letter.is_control() { char::REPLACEMENT_CHARACTER } else { letter };
            fmt::Write::write_char(f, shown)?;
        }
        if letters.next().is_some() { f.write_str("…") } else { Ok(()) }
    }
}

/// Marks around words of a file in the messages of other parsers.
const MARKS: [char; 3] = ['`', '"', '\''];

/// A message of a foreign parser, in which each word of the file between quotation marks is shortened as by [`quoted`], and so is every
/// word longer than those of messages.
#[must_use]
pub fn with_short_quotes(message: &str) -> String {
    let mut short = String::new();
    let mut rest = message;
    while let Some(at) = rest.find(MARKS) {
        let (before, from_mark) = rest.split_at(at);
        push_words(before, &mut short);
        let mut letters = from_mark.chars();
        let Some(mark) = letters.next() else { break };
        let inner = letters.as_str();
        // An apostrophe within a word is not a quotation mark.
        let is_within = mark == '\'' && before.chars().next_back().is_some_and(char::is_alphanumeric);
        short.push(mark);
        // A word of the file may contain the mark: its end is the last one that is not followed by a letter.
        let closing = inner.match_indices(mark).map(|(end, _)| end);
        let end = closing.into_iter().find(|end| !inner[end + mark.len_utf8()..].starts_with(char::is_alphanumeric));
        rest = match end.filter(|_| !is_within) {
            Some(end) => {
                short.push_str(&quoted(&inner[..end]).to_string());
                short.push(mark);
                &inner[end + mark.len_utf8()..]
            }
            None => inner,
        };
    }
    push_words(rest, &mut short);
    short
}

/// The longest word of a message: a longer one is from the file.
const LONGEST_WORD: usize = 40;

fn push_words(text: &str, to: &mut String) {
    for word in text.split_inclusive(char::is_whitespace) {
        if word.chars().count() > LONGEST_WORD {
            to.push_str(&quoted(word).to_string());
            to.extend(word.chars().next_back().filter(|end| end.is_whitespace()));
        } else {
            to.push_str(word);
        }
    }
}

/// Largest number of names in a list.
const MOST_LISTED: usize = 20;

/// Names of a file to choose from, as a message lists them; `none` where there are none.
#[must_use]
pub fn listed<'a>(names: impl IntoIterator<Item = &'a str>, none: &str) -> String {
    let mut names = names.into_iter();
    let all: Vec<String> = names.by_ref().take(MOST_LISTED).map(|name| format!("`{}`", named(name))).collect();
    match (all.is_empty(), names.count()) {
        (true, _) => none.to_owned(),
        (false, 0) => all.join(", "),
        (false, more) => format!("{} and {more} more", all.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_word_is_quoted_up_to_twelve_characters() {
        assert_eq!(quoted("12,5 mm").to_string(), "12,5 mm");
        assert_eq!(quoted("twelve chars").to_string(), "twelve chars");
        assert_eq!(quoted("root:x:0:0:root:/root:/bin/bash").to_string(), "root:x:0:0:r…");
        assert_eq!(quoted("ä\u{1b}[31m").to_string(), "ä\u{fffd}[31m");
    }

    #[test]
    fn messages_of_other_parsers_keep_their_own_words() {
        let short = with_short_quotes;
        assert_eq!(
            short("invalid type: string \"SECRET=0123456789\", expected u64"),
            "invalid type: string \"SECRET=01234…\", expected u64"
        );
        assert_eq!(short("expected 'mujoco' tag, not 'a' at 1:4"), "expected 'mujoco' tag, not 'a' at 1:4");
        assert_eq!(short("it's `one` that isn't `another_one_of_all`"), "it's `one` that isn't `another_one_…`");
        assert_eq!(short(&format!("unknown {}\nend", "x".repeat(99))), "unknown xxxxxxxxxxxx…\nend");
        assert_eq!(short("an open ' mark"), "an open ' mark");
    }

    #[test]
    fn names_to_choose_from_are_listed_up_to_a_bound() {
        assert_eq!(listed(["a", "b"], "none"), "`a`, `b`");
        assert_eq!(listed([], "none"), "none");
        let many: Vec<String> = (0..30).map(|k| format!("joint{k}")).collect();
        let list = listed(many.iter().map(String::as_str), "none");
        assert!(list.starts_with("`joint0`, ") && list.ends_with("`joint19` and 10 more"), "{list}");
        assert_eq!(listed([&*"x".repeat(50)], "none").chars().count(), 43);
    }

    /// Whatever marks a file has in it.
    #[test]
    fn no_more_than_a_long_word_of_a_file_is_shown() {
        let secret = "abcdefghijklmnopqrstuvwxyz".repeat(4);
        for word in [secret.clone(), format!("'{secret}'"), format!("a`{secret}"), format!("\"{secret}`")] {
            for mark in MARKS {
                let short =
                    with_short_quotes(&format!("unknown field {mark}{word}{mark}, expected one of {mark}a{mark}"));
                assert!(!short.contains(&secret[..30]), "{short}");
            }
        }
    }
}
