//! Output of text: its width, its colours, and the filter through which it reaches a terminal or a log.
use servobench_results::printable;

/// Style of text. The caller knows if the terminal takes colours.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Style {
    /// Columns of the terminal.
    pub width: usize,
    /// True if colours may be used.
    pub colour: bool,
}

impl Default for Style {
    /// 80 columns, no colours.
    fn default() -> Self {
        Self { width: 80, colour: false }
    }
}

/// Colours by meaning.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Ink {
    Heading,
    Good,
    Bad,
    Warning,
    Faint,
}

impl Style {
    /// `text` in colour, if colours are on: between marks, which [`shown`] turns into escape sequences.
    pub(crate) fn paint(self, ink: Ink, text: &str) -> String {
        let code = match ink {
            Ink::Heading => "1",
            Ink::Good => "32",
            Ink::Bad => "1;31",
            Ink::Warning => "33",
            Ink::Faint => "2",
        };
        match (mark(code), mark(PLAIN)) {
            (Some(start), Some(end)) if self.colour && !text.trim().is_empty() => {
                format!("{start}{}{end}", printable(text))
            }
            _ => text.to_owned(),
        }
    }
}

/// Ends all colours.
const PLAIN: &str = "0";
/// All colours and styles in use, as escape codes (ECMA-48, SGR).
const CODES: [&str; 20] = [
    PLAIN, "1", "2", "3", "4", "31", "32", "33", "34", "35", "36", "1;31", "31;1", "32;1", "33;1", "34;1", "35;1",
    "36;1", "36;4;1", "36;1;4",
];
/// The first mark. The marks are noncharacters of Unicode, reserved for internal use by programs, and
/// [`printable`] lets none of them through: all marks in a text were painted here. If a foreign text
/// gets here past it, it can at worst be coloured.
const FIRST: char = '\u{fdd0}';

/// The mark that stands for `code`.
fn mark(code: &str) -> Option<char> {
    let index = (0..).zip(CODES).find_map(|(index, one)| (one == code).then_some(index))?;
    char::from_u32(u32::from(FIRST) + index)
}

/// The code that `mark` stands for.
fn code(mark: char) -> Option<&'static str> {
    let index = u32::from(mark).checked_sub(u32::from(FIRST))?;
    CODES.get(usize::try_from(index).ok()?).copied()
}

/// `text`, which may hold anything, made safe for a terminal or a log: each line filtered by [`printable`], painted parts in
/// their colours if `colour` is set. No other control sequence reaches the terminal.
#[must_use]
pub fn shown(text: &str, colour: bool) -> String {
    let mut out = String::with_capacity(text.len());
    for (k, line) in text.split('\n').enumerate() {
        if k > 0 {
            out.push('\n');
        }
        shown_line(&mut out, line, colour);
    }
    out
}

/// One line: its marks are taken out, so that [`printable`] sees one text, and put back at their places.
fn shown_line(out: &mut String, line: &str, colour: bool) {
    let marks: Vec<(usize, &str)> = line
        .chars()
        .map(code)
        .scan(0, |before, code| {
            let at = *before;
            *before += usize::from(code.is_none());
            Some((at, code))
        })
        .filter_map(|(at, code)| Some((at, code?)))
        .collect();
    let bare: String = line.chars().filter(|c| code(*c).is_none()).collect();
    let clean = printable(&bare);
    // A command was broken up: the places of the marks no longer hold.
    if !colour || marks.is_empty() || clean.chars().count() != bare.chars().count() {
        out.push_str(&clean);
        return;
    }
    let mut marks = marks.into_iter().peekable();
    let mut paint = |out: &mut String, at: usize| {
        while let Some((_, code)) = marks.next_if(|(place, _)| *place == at) {
            out.push_str("\x1b[");
            out.push_str(code);
            out.push('m');
        }
    };
    let mut count = 0;
    for c in clean.chars() {
        paint(out, count);
        out.push(c);
        count += 1;
    }
    paint(out, count);
}

/// Converts a text painted by another renderer of ours, replacing its escape sequences by marks. For texts whose
/// only escape sequences are those of the renderer; unknown ones stay as they are, and [`shown`] removes them.
#[must_use]
pub fn painted(text: &str) -> String {
    let mut parts = text.split("\x1b[");
    let mut marked = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let known = part.split_once('m').and_then(|(code, rest)| Some((mark(code)?, rest)));
        if let Some((mark, rest)) = known {
            marked.push(mark);
            marked.push_str(rest);
        } else {
            marked.push_str("\x1b[");
            marked.push_str(part);
        }
    }
    marked
}

#[cfg(test)]
mod tests {
    use super::*;

    const COLOURED: Style = Style { width: 80, colour: true };

    #[test]
    fn what_is_painted_is_in_colour_and_nothing_else() {
        let text = format!("a {} b\n{}", COLOURED.paint(Ink::Bad, "FAILED"), COLOURED.paint(Ink::Good, "x"));
        assert_eq!(shown(&text, true), "a \x1b[1;31mFAILED\x1b[0m b\n\x1b[32mx\x1b[0m");
        assert_eq!(shown(&text, false), "a FAILED b\nx");
        assert_eq!(shown("\x1b[31mred\x1b[0m\n::error::x", true), "\u{fffd}[31mred\u{fffd}[0m\n: :error::x");
    }

    /// Foreign marks are as good as foreign escape sequences.
    #[test]
    fn a_foreign_text_paints_nothing() {
        let foreign = "\u{fdd1}a\u{fdef}\x1b[2J";
        assert_eq!(shown(&COLOURED.paint(Ink::Good, foreign), true), "\x1b[32m\u{fffd}a\u{fffd}\u{fffd}[2J\x1b[0m");
        assert_eq!(shown(&printable(foreign), true), "\u{fffd}a\u{fffd}\u{fffd}[2J");
    }

    /// Colours before it do not hide a command from the filter.
    #[test]
    fn a_painted_command_is_none() {
        let text = COLOURED.paint(Ink::Warning, "  ::error::x");
        for colour in [true, false] {
            let bare = shown(&text, colour).replace("\x1b[33m", "").replace("\x1b[0m", "");
            assert_eq!(bare, "  : :error::x");
        }
        let apart = format!("{}:error::x", COLOURED.paint(Ink::Warning, ":"));
        assert_eq!(shown(&apart, true), ": :error::x");
    }

    #[test]
    fn the_colours_of_another_renderer_become_marks() {
        let text = "\x1b[1m\x1b[31merror:\x1b[0m no \x1b[99mx";
        assert_eq!(shown(&painted(text), true), "\x1b[1m\x1b[31merror:\x1b[0m no \u{fffd}[99mx");
        assert_eq!(shown(&painted(text), false), "error: no \u{fffd}[99mx");
    }
}
