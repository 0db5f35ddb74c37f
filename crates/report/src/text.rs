//! Text in columns.

/// `text` in at most `width` characters, with the middle left out when it is longer: names of runs differ at both ends.
#[must_use]
pub fn elided(text: &str, width: usize) -> String {
    let count = text.chars().count();
    if count <= width {
        return text.to_owned();
    }
    let kept = width.saturating_sub(1);
    let (head, tail) = (kept.div_ceil(2), kept / 2);
    let start: String = text.chars().take(head).collect();
    let end: String = text.chars().skip(count - tail).collect();
    format!("{start}…{end}")
}

/// `text` broken between words into lines of at most `width` characters. A longer word stays whole, and a number keeps
/// its unit: no line ends in a digit or in `×`.
#[must_use]
pub fn wrapped(text: &str, width: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    let mut words = text.split_whitespace();
    while let Some(first) = words.next() {
        let mut word = first.to_owned();
        while word.ends_with(|last: char| last.is_ascii_digit() || last == '×') {
            let Some(next) = words.next() else { break };
            word.push(' ');
            word.push_str(next);
        }
        match lines.last_mut() {
            Some(line) if line.chars().count() + 1 + word.chars().count() <= width => {
                line.push(' ');
                line.push_str(&word);
            }
            _ => lines.push(word),
        }
    }
    lines
}

/// Width of the widest of `texts`.
pub(crate) fn widest<'a>(texts: impl IntoIterator<Item = &'a str>) -> usize {
    texts.into_iter().map(|text| text.chars().count()).max().unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_ends_stay() {
        assert_eq!(elided("feed-axis-reversal-slow", 12), "feed-a…-slow");
        assert_eq!(elided("µµµµ", 4), "µµµµ");
        assert_eq!(elided("abc", 1), "…");
    }

    #[test]
    fn lines_break_between_words() {
        assert_eq!(wrapped("one two  three", 7), ["one two", "three"]);
        assert_eq!(wrapped("unbreakable", 3), ["unbreakable"]);
        assert_eq!(wrapped("about 16 × less", 9), ["about", "16 × less"]);
        assert_eq!(wrapped("it takes 50 ms", 12), ["it takes", "50 ms"]);
        assert!(wrapped(" ", 3).is_empty());
    }
}
