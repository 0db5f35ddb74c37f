//! Contents of an FMU, as a table.
//!
//! All its texts are foreign: characters that would control the terminal are removed.
mod head;
mod value;
mod variables;

use crate::style::{Ink, Style};
use crate::text::wrapped;
use servobench_fmi::{Enumeration, ModelDescription};
use servobench_results::printable;

/// Most items shown of a list; the others are counted.
const MOST: usize = 40;

/// Table of `description` of an FMU with these `files`: kind and capabilities, variables by causality, enumerations,
/// and departures from the standard. Long lists are cut and the rest counted. Names of variables are
/// complete. No line is wider than a terminal of 80 columns or more.
#[must_use]
pub fn fmu_table(description: &ModelDescription, files: &[String], style: Style) -> String {
    let mut table = head::head(description, files, style);
    table += &variables::variables(description, style);
    table += &enumerations(&description.enumerations, style);
    table += &remarks(&description.remarks, style);
    table
}

/// The items of each enumeration.
fn enumerations(all: &[Enumeration], style: Style) -> String {
    let mut text = String::new();
    for enumeration in all.iter().take(MOST) {
        let heading = format!("ENUMERATION {}", plain(&enumeration.name));
        text.push('\n');
        text += &heading_lines(&heading, style);
        for item in enumeration.items.iter().take(MOST) {
            let (mut words, meaning) = (plain(&item.name), plain(&item.description));
            if !meaning.is_empty() {
                words = words + ": " + &meaning;
            }
            text += &hanging(&format!("{:>4} ", item.value), &words, style.width);
        }
        text += &others(enumeration.items.len(), style);
    }
    text + &others(all.len(), style)
}

/// Departures of the file from the standard.
fn remarks(all: &[String], style: Style) -> String {
    if all.is_empty() {
        return String::new();
    }
    let mut text = format!("\n{}\n", style.paint(Ink::Warning, "DEPARTS FROM THE STANDARD, WITHOUT HARM"));
    for remark in all.iter().take(MOST) {
        text += &hanging("- ", &plain(remark), style.width);
    }
    text + &others(all.len(), style)
}

/// Number of items not shown, and the command that shows them.
fn others(count: usize, style: Style) -> String {
    if count <= MOST {
        return String::new();
    }
    let line = format!("… and {} more; all: `unzip -p FILE modelDescription.xml`", count - MOST);
    fitted(&line, style.width).iter().map(|part| style.paint(Ink::Faint, part) + "\n").collect()
}

fn heading_lines(text: &str, style: Style) -> String {
    fitted(text, style.width).iter().map(|line| style.paint(Ink::Heading, line) + "\n").collect()
}

/// `text` behind `mark`, in lines of at most `width` characters.
fn hanging(mark: &str, text: &str, width: usize) -> String {
    let indent = mark.chars().count();
    let mut lines = fitted(text, width.saturating_sub(indent)).into_iter();
    let first = format!("{mark}{}", lines.next().unwrap_or_default());
    let rest = lines.map(|line| format!("{:indent$}{line}\n", ""));
    std::iter::once(first.trim_end().to_owned() + "\n").chain(rest).collect()
}

/// `text` broken between words, and within words that are longer, into lines of at most `width` characters.
fn fitted(text: &str, width: usize) -> Vec<String> {
    let broken = |line: String| {
        let characters: Vec<char> = line.chars().collect();
        characters
            .chunks(width.max(1))
            .map(|part| part.iter().collect::<String>().trim().to_owned())
            .collect::<Vec<_>>()
    };
    wrapped(text, width).into_iter().flat_map(broken).collect()
}

/// `text` without characters that control a terminal or turn the direction of writing.
fn plain(text: &str) -> String {
    printable(text.trim())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_longer_than_a_line_are_broken() {
        assert_eq!(fitted("ab cdefgh i", 3), ["ab", "cde", "fgh", "i"]);
        // Numbers in a row stay together at any width.
        assert_eq!(fitted("1 2 3 4", 3), ["1 2", "3", "4"]);
        assert!(fitted("", 3).is_empty());
    }

    #[test]
    fn what_steers_a_terminal_is_taken_out() {
        assert_eq!(plain("a\u{9b}31mb\nc\u{202e}d "), "a\u{fffd}31mb c\u{fffd}d");
    }
}
