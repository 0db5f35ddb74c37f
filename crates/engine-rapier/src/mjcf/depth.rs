//! How deep elements are nested, told before anything reads the file that calls itself for each of them.
use super::refusal::MjcfRefusal;

/// Elements within each other, at most. 700 bodies have filled the 2 MiB that a thread has as its stack.
const DEEPEST: usize = 100;

/// That elements of `xml` are nested too deep, if they are. What is no XML is left to who reads it.
pub(super) fn check(xml: &str) -> Result<(), MjcfRefusal> {
    let (mut depth, mut at) = (0_usize, 0);
    while let Some(start) = xml[at..].find('<').map(|offset| at + offset) {
        let rest = &xml[start..];
        let markup = [("<!--", "-->"), ("<![CDATA[", "]]>"), ("<?", "?>"), ("<!", ">")];
        if let Some((open, close)) = markup.into_iter().find(|(open, _)| rest.starts_with(open)) {
            let Some(end) = rest[open.len()..].find(close) else { return Ok(()) };
            at = start + open.len() + end + close.len();
            continue;
        }
        let Some(length) = tag(rest) else { return Ok(()) };
        at = start + length;
        if rest.starts_with("</") {
            depth = depth.saturating_sub(1);
        } else if !rest[..length].ends_with("/>") {
            depth += 1;
        }
        if depth > DEEPEST {
            let name = rest[1..].split(|c: char| c.is_whitespace() || c == '/' || c == '>').next();
            let line = u32::try_from(xml[..start].matches('\n').count() + 1).unwrap_or(u32::MAX);
            return Err(MjcfRefusal::TooDeep { line, element: name.unwrap_or_default().into(), depth: DEEPEST });
        }
    }
    Ok(())
}

/// Bytes of the tag that `text` begins with: a `>` in the value of an attribute does not end it.
fn tag(text: &str) -> Option<usize> {
    let mut quote = None;
    for (at, byte) in text.bytes().enumerate() {
        match (quote, byte) {
            (None, b'"' | b'\'') => quote = Some(byte),
            (None, b'>') => return Some(at + 1),
            (Some(open), _) if open == byte => quote = None,
            _ => {}
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_elements_that_are_open_count() {
        for harmless in [
            "<a/>".repeat(1000),
            "<a></a>".repeat(1000),
            format!("<!--{}-->", "<a>".repeat(1000)),
            format!("<![CDATA[{}]]>", "<a>".repeat(1000)),
            format!("<?xml {}?>", "<a>".repeat(1000)),
            "<a b='>'/>".repeat(1000),
            "<a b='/>' c=\"'\"></a>".repeat(1000),
            "<a>".repeat(DEEPEST),
            "</a>".repeat(1000),
            "< > <".into(),
            "<a b='".into(),
        ] {
            assert_eq!(check(&harmless), Ok(()), "{harmless}");
        }
        let deep = "<a\nb='1'>".repeat(DEEPEST + 1);
        let said = check(&deep).unwrap_err().to_string();
        assert!(said.starts_with("line 101: `<a>` is nested more than 100 elements deep"), "{said}");
    }
}
