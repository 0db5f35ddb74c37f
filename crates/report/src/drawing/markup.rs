//! Text and style of an SVG.
use servobench_results::printable;

/// One colour each for position and its derivatives; without colour vision their panels distinguish them.
pub(crate) const COLOURS: [&str; 5] = ["#1f5fa8", "#0f7f72", "#9a5b00", "#8a2f78", "#4a4fb0"];

/// Title, subtitle, name, label, time of an instant; grid and zero. Fonts that are common on some system, dark on white.
pub(crate) const STYLE: &str = "text{font-family:'DejaVu Sans','Segoe UI',Helvetica,Arial,sans-serif;fill:#1c2330}\
.t{font-size:17px;font-weight:600}.s{font-size:12.5px;fill:#5b6472}.n{font-size:13px;font-weight:600}\
.k{font-size:11px;fill:#5b6472}.e{font-size:11px;font-weight:600}.g{stroke:#e4e8ee;stroke-width:1}\
.z{stroke:#9aa3b0;stroke-width:1}";

/// `text` escaped for XML, and printable for anyone who reads the file in a terminal.
pub(crate) fn escaped(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for c in printable(text).chars() {
        match c {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            _ => escaped.push(c),
        }
    }
    escaped
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_escaped() {
        assert_eq!(escaped("a < b & \"c\" > d"), "a &lt; b &amp; &quot;c&quot; &gt; d");
    }

    /// XML 1.0, production 2: no control character but tab, line feed and carriage return, no U+FFFE and U+FFFF.
    #[test]
    fn what_is_no_character_of_xml_is_replaced() {
        assert_eq!(escaped("a\0b\u{1b}c\u{ffff}\n\u{1f600}"), "a\u{fffd}b\u{fffd}c\u{fffd} \u{1f600}");
    }
}
