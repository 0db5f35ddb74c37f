//! Names with texts, in two columns.
use crate::style::{Ink, Style};
use crate::text::{widest, wrapped};

/// Widest column of names: a longer name has a line to itself.
const WIDEST_NAMES: usize = 30;
/// Columns before a name, and between the two.
const INDENT: usize = 2;

/// `rows` below `heading`: names to the left, their texts to the right, wrapped. A line break in a text begins another line; without a
/// heading there is no line for it.
#[must_use]
pub fn two_columns<N: AsRef<str>, T: AsRef<str>>(heading: &str, rows: &[(N, T)], style: Style) -> String {
    let names = widest(rows.iter().map(|(name, _)| name.as_ref()).filter(|name| name.chars().count() <= WIDEST_NAMES));
    let (text_at, gap) = (INDENT + names + INDENT, " ".repeat(INDENT));
    let mut out = String::new();
    if !heading.is_empty() {
        out = style.paint(Ink::Heading, heading) + "\n";
    }
    for (name, text) in rows {
        let name = name.as_ref();
        let width = style.width.saturating_sub(text_at).max(1);
        let lines = text.as_ref().lines().flat_map(|line| wrapped(line, width)).flat_map(|line| cut(&line, width));
        let mut lead = format!("{:INDENT$}{name:names$}", "");
        if name.chars().count() > names {
            out.extend([lead.as_str(), "\n"]);
            lead = " ".repeat(INDENT + names);
        }
        for line in lines {
            out.extend([lead.as_str(), &gap, &line, "\n"]);
            lead = " ".repeat(INDENT + names);
        }
        if !lead.trim().is_empty() {
            out.extend([lead.trim_end(), "\n"]);
        }
    }
    out
}

/// A line in pieces of at most `width` characters: one word may be wider than its column.
fn cut(line: &str, width: usize) -> Vec<String> {
    let characters: Vec<char> = line.chars().collect();
    characters.chunks(width).map(|piece| piece.iter().collect()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const NARROW: Style = Style { width: 30, colour: false };

    #[test]
    fn texts_are_wrapped_beside_their_names() {
        let rows = [("lead", "travel per revolution of the screw\nlike 10 mm"), ("gear_ratio", "turns")];
        let expected = "axis\n  lead        travel per\n              revolution of\n              the screw\n              like 10 mm\n  gear_ratio  turns\n";
        assert_eq!(two_columns("axis", &rows, NARROW), expected);
    }

    #[test]
    fn a_long_name_has_a_line_to_itself() {
        let long = "n".repeat(31);
        let expected = format!("  {long}\n      text\n  ab  more\n");
        assert_eq!(two_columns("", &[(long.as_str(), "text"), ("ab", "more")], NARROW), expected);
        assert_eq!(two_columns("", &[("alone", "")], NARROW), "  alone\n");
        let word = "w".repeat(30);
        let pieces = format!("  a  {}\n     {}\n", &word[..25], &word[25..]);
        assert_eq!(two_columns("", &[("a", word)], NARROW), pieces);
    }
}
