//! Foreign text (names, messages, logs of FMUs) made safe for terminals, logs, XML and drawings.
//!
//! Three kinds of characters can do harm there. Invisible ones: control characters and escape sequences, which control a
//! terminal; characters that turn the direction of writing, or have no width, which make a text look like another one; characters that
//! Unicode reserves and XML does not allow. Line ends: a text with one can forge the next line of a log. And the beginnings of
//! commands to a CI runner, which reads them from the log.

use std::fmt::Write as _;

/// `text` as one line: invisible characters become a question mark in a diamond, line ends and tabs a blank.
#[must_use]
pub fn printable(text: &str) -> String {
    let shown: String = text.chars().map(visible).collect();
    without_commands(&shown)
}

/// `text` with each line treated like that.
#[must_use]
pub fn printable_lines(text: &str) -> String {
    text.split('\n').map(printable).collect::<Vec<_>>().join("\n")
}

/// The JSON `text` with invisible characters escaped: its meaning stays the same.
#[must_use]
pub fn printable_json(text: &str) -> String {
    let mut shown = String::with_capacity(text.len());
    for c in text.chars() {
        // Between its strings JSON has only line feeds and blanks.
        if c == '\n' || c == visible(c) {
            shown.push(c);
        } else {
            for unit in c.encode_utf16(&mut [0; 2]) {
                // Writing to a string cannot fail.
                write!(shown, "\\u{unit:04x}").ok();
            }
        }
    }
    shown
}

/// Visible replacement of a character.
const fn visible(c: char) -> char {
    match c {
        '\t'..='\r' | '\u{85}' | '\u{2028}' | '\u{2029}' => ' ',
        c if is_hidden(c) => char::REPLACEMENT_CHARACTER,
        c => c,
    }
}

/// True if a character is invisible, or makes a text look like another one.
const fn is_hidden(c: char) -> bool {
    matches!(c,
        // C0, delete, C1.
        '\0'..='\u{1f}' | '\u{7f}'..='\u{9f}'
        // Marks, embeddings, overrides and isolates of the direction of writing (UAX #9).
        | '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}'
        // Without width, or a false blank: joiners, soft hyphen, Hangul fillers, mathematical operators.
        | '\u{ad}' | '\u{34f}' | '\u{115f}' | '\u{1160}' | '\u{17b4}' | '\u{17b5}' | '\u{180b}'..='\u{180f}'
        | '\u{200b}'..='\u{200d}' | '\u{2060}'..='\u{2065}' | '\u{206a}'..='\u{206f}' | '\u{3164}' | '\u{feff}' | '\u{ffa0}'
        | '\u{1bca0}'..='\u{1bca3}' | '\u{1d173}'..='\u{1d17a}'
        // Interlinear annotations, tags, variation selectors.
        | '\u{fff9}'..='\u{fffb}' | '\u{e0000}'..='\u{e0fff}')
        // Noncharacters, which painters of text use as marks.
        || matches!(c, '\u{fdd0}'..='\u{fdef}')
        || c as u32 & 0xfffe == 0xfffe
}

/// Beginnings of commands that a CI runner accepts anywhere in a line.
const COMMANDS: [&str; 3] = ["##[", "##vso[", "##teamcity["];

/// `line` without commands to a CI runner: `::` at its beginning, with or without blanks before it, and
/// [`COMMANDS`].
fn without_commands(line: &str) -> String {
    let mut line = line.to_owned();
    for command in COMMANDS {
        if line.contains(command) {
            line = line.replace(command, &command.replacen("##", "# #", 1));
        }
    }
    let start = line.len() - line.trim_start().len();
    if line[start..].starts_with("::") {
        line.insert(start + 1, ' ');
    }
    line
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_terminal_gets_neither_control_characters_nor_commands() {
        assert_eq!(printable("x\n::error file=a.rs::merged"), "x ::error file=a.rs::merged");
        assert_eq!(printable_lines("x\n \t::error::m\n"), "x\n  : :error::m\n");
        assert_eq!(printable("::stop-commands::t"), ": :stop-commands::t");
        assert_eq!(printable("std::vector ##[error] ##vso[x]"), "std::vector # #[error] # #vso[x]");
        assert_eq!(
            printable("\u{1b}[2J\u{202e}a\u{7}µ\t\u{9b}b\u{200b}\u{2028}"),
            "\u{fffd}[2J\u{fffd}a\u{fffd}µ \u{fffd}b\u{fffd} "
        );
    }

    /// All characters.
    #[test]
    fn what_is_shown_has_a_width_and_a_direction() {
        for c in (0..=0x10_ffff).filter_map(char::from_u32) {
            let shown = printable(&c.to_string());
            let is_harmless =
                !shown.contains(char::is_control) && !shown.contains(['\u{2028}', '\u{2029}', '\u{202e}']);
            assert!(is_harmless && shown.chars().count() == 1, "{c:?}");
            assert_eq!(printable(&shown), shown, "{c:?}");
        }
        for plain in ["feed axis", "Größe µm/s² × ≥ – …", "位置", "🦀", "a::b", "°C", "│ ╭─▶"] {
            assert_eq!(printable(plain), plain);
        }
    }

    #[test]
    fn json_means_the_same() {
        let text = "{\n \"a\": \"\u{7f}\u{202e}µ\u{e0041}\u{85}\"}";
        let shown = printable_json(text);
        assert_eq!(shown, "{\n \"a\": \"\\u007f\\u202eµ\\udb40\\udc41\\u0085\"}");
        let read = |text: &str| serde_json::from_str::<serde_json::Value>(text).unwrap();
        assert_eq!(read(&shown), read(text));
    }
}
