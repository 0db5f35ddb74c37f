//! Estimated width of a text, without a renderer to measure it.

/// Width of `text` (pixels) in letters of `size` pixels: at least that of DejaVu Sans, the widest of the requested fonts.
pub(crate) fn text_width(text: &str, size: f64) -> f64 {
    size * text.chars().map(advance).sum::<f64>()
}

/// `text`, or as much of its beginning as fits into `room` pixels in letters of `size`, with an ellipsis; `None` where less
/// than two letters fit.
pub(crate) fn fitted(text: &str, room: f64, size: f64) -> Option<String> {
    if text_width(text, size) <= room {
        return Some(text.to_owned());
    }
    let mut width = size * advance('…');
    let fits = |c: &char| {
        width += size * advance(*c);
        width <= room
    };
    let kept: String = text.chars().take_while(fits).collect();
    let kept = kept.trim_end();
    (kept.chars().count() >= 2).then(|| format!("{kept}…"))
}

/// Advance of a letter, relative to the size.
fn advance(c: char) -> f64 {
    match c {
        'i' | 'j' | 'l' => 0.28,
        ' ' | '.' | ',' | ':' | ';' | '\'' | '|' | '/' | '\\' | 'I' | 'J' => 0.34,
        'f' | 't' | 'r' | '(' | ')' | '[' | ']' | '-' | '!' => 0.42,
        'c' | 'k' | 's' | 'v' | 'x' | 'y' | 'z' | '_' | 'L' => 0.6,
        'w' | 'M' | '+' | '<' | '=' | '>' | '#' | '~' => 0.87,
        'm' | 'W' | '%' | '@' | '…' => 1.0,
        'a'..='z' | '0'..='9' | 'E' | 'F' | 'P' | 'S' | 'T' | 'Y' => 0.64,
        'A'..='Z' => 0.79,
        _ => 1.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: the advances of DejaVu Sans 2.37, in 2048ths of the size.
    #[test]
    fn no_text_is_narrower_than_it_is_drawn() {
        let drawn = |advances: &[u32]| f64::from(advances.iter().sum::<u32>()) / 2048.0;
        // Standstill: S t a n d s t i l l; Done: D o n e; MMM.
        for (text, advances) in [
            ("Standstill", &[1300, 803, 1255, 1298, 1300, 1067, 803, 569, 569, 569][..]),
            ("Done", &[1577, 1253, 1298, 1260]),
            ("MMM", &[1767, 1767, 1767]),
        ] {
            let (guessed, exact) = (text_width(text, 1.0), drawn(advances));
            assert!(guessed >= exact && guessed < 1.25 * exact, "{text}: {guessed}, drawn {exact}");
        }
    }

    #[test]
    fn a_text_is_cut_where_it_does_not_fit() {
        assert_eq!(fitted("Done", 40.0, 11.0).as_deref(), Some("Done"));
        let cut = fitted("Discrete Motion", 60.0, 11.0).unwrap();
        assert!(cut.ends_with('…') && "Discrete Motion".starts_with(cut.trim_end_matches('…')), "{cut}");
        assert!(text_width(&cut, 11.0) <= 60.0 && text_width(&cut, 11.0) > 45.0, "{cut}");
        assert_eq!(fitted("Discrete Motion", 20.0, 11.0), None);
        assert_eq!(fitted("", 0.0, 11.0).as_deref(), Some(""));
    }
}
