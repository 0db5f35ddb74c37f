//! Text that somebody else wrote, made fit for terminals and XML.

/// What a terminal, or a file of XML, may get of a text that somebody else wrote: no control characters, nothing that turns the
/// direction of writing, nothing that is no character, and no commands to a runner of continuous integration, which are lines that begin with `::`.
#[must_use]
pub fn printable(text: &str) -> String {
    let shown = |c: char| match c {
        '\u{fffe}' | '\u{ffff}' | '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}' => {
            '\u{fffd}'
        }
        c if c.is_control() => ' ',
        c => c,
    };
    text.replace("::", ": :").chars().map(shown).collect()
}

/// The same of each line of `text`.
#[must_use]
pub fn printable_lines(text: &str) -> String {
    text.split('\n').map(printable).collect::<Vec<_>>().join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_terminal_gets_neither_control_characters_nor_commands() {
        assert_eq!(printable("x\n::error file=a.rs::merged"), "x : :error file=a.rs: :merged");
        assert_eq!(printable("\u{1b}[2J\u{202e}a\u{7}µ"), " [2J\u{fffd}a µ");
    }
}
