//! Messages about files that a scenario names: quote at most a few characters of them.
//!
//! A message quotes the wrong key or value. In the scenario itself its author wrote that; a file it names may be anybody's. Any text
//! that a message has in common with the affected lines of such a file is cut to [`MOST_QUOTED`] characters, unless it is a word of
//! the format itself.
use crate::diagnostic::Diagnostic;
use crate::schema::json_schema;
use crate::source::Sources;
use serde_json::Value as Json;
use servobench_files::MOST_QUOTED;
use std::collections::HashSet;
use std::sync::OnceLock;

/// Bytes before and after the place of a mistake with which its message is compared.
const AROUND: usize = 4096;

/// Shortens the quotations in `all` from files whose lines may not be shown.
pub(crate) fn shorten(all: &mut [Diagnostic], sources: &Sources) {
    for one in all.iter_mut().filter(|one| !sources.may_be_shown(one.source)) {
        let lines = around(sources.text(one.source), one.span.start, one.span.end);
        one.message = short(&one.message, lines);
        one.help = one.help.take().map(|help| short(&help, lines));
    }
}

/// The text from [`AROUND`] bytes before `start` to [`AROUND`] bytes after `end`.
fn around(text: &str, start: usize, end: usize) -> &str {
    let from = text.floor_char_boundary(start.saturating_sub(AROUND));
    let to = text.ceil_char_boundary(end.min(start.saturating_add(AROUND)).saturating_add(AROUND));
    text.get(from..to).unwrap_or_default()
}

/// `message` with every passage of more than [`MOST_QUOTED`] characters that also occurs in `lines` cut.
fn short(message: &str, lines: &str) -> String {
    let starts: Vec<usize> = message.char_indices().map(|(at, _)| at).chain([message.len()]).collect();
    let (mut shown, mut at) = (String::new(), 0);
    while at + 1 < starts.len() {
        let common =
            |length: usize| starts.get(at + length).is_some_and(|end| lines.contains(&message[starts[at]..*end]));
        if !common(MOST_QUOTED + 1) {
            shown.push_str(&message[starts[at]..starts[at + 1]]);
            at += 1;
            continue;
        }
        let mut length = MOST_QUOTED + 1;
        while common(length + 1) {
            length += 1;
        }
        let words = &message[starts[at]..starts[at + length]];
        if words
            .split(|c: char| !(c.is_alphanumeric() || c == '_'))
            .all(|word| word.chars().count() <= 3 || is_of_the_format(word))
        {
            shown.push_str(words);
        } else {
            shown.push_str(&message[starts[at]..starts[at + MOST_QUOTED]]);
            shown.push('…');
        }
        at += length;
    }
    shown
}

/// True if `word` is a key or a name of the format.
fn is_of_the_format(word: &str) -> bool {
    static WORDS: OnceLock<HashSet<String>> = OnceLock::new();
    let words = WORDS.get_or_init(|| {
        let mut words = HashSet::new();
        collect(&json_schema(), &mut words);
        words
    });
    words.contains(word)
}

fn collect(schema: &Json, words: &mut HashSet<String>) {
    match schema {
        Json::Object(inner) => {
            for (key, value) in inner {
                if key == "properties" {
                    words.extend(value.as_object().into_iter().flat_map(|keys| keys.keys().cloned()));
                } else if key == "enum" {
                    words.extend(
                        value.as_array().into_iter().flatten().filter_map(|name| name.as_str().map(str::to_owned)),
                    );
                }
                collect(value, words);
            }
        }
        Json::Array(inner) => inner.iter().for_each(|value| collect(value, words)),
        _ => {}
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_a_foreign_line_a_few_characters_are_quoted() {
        let line = "AWS_SECRET_ACCESS_KEY=\"abcdefghijklmnop`qrstuvwxyz\"";
        let said = short("unknown key `AWS_SECRET_ACCESS_KEY` is `abcdefghijklmnop`qrstuvwxyz`", line);
        assert_eq!(said, "unknown key `AWS_SECRET_A…` is `abcdefghijkl…`");
        assert_eq!(short("`speed` must be positive", "speed = -1"), "`speed` must be positive");
    }

    #[test]
    fn words_of_the_format_stay() {
        assert!(is_of_the_format("following_error_peak_load") && !is_of_the_format("AWS_SECRET_ACCESS_KEY"));
        let said = short("`torque_constant` must be positive", "torque_constant = \"-1 Nm/Arms\"");
        assert_eq!(said, "`torque_constant` must be positive");
    }

    #[test]
    fn lines_around_a_place_end_between_characters() {
        let text = "ä".repeat(20_000);
        assert!(around(&text, 10_001, 10_003).len() > AROUND);
        assert_eq!(around("ab", 1, 9), "ab", "a place behind its end");
    }
}
