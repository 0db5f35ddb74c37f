//! Nesting depth of elements, checked before the file is read by recursive functions.
use super::refusal::MjcfRefusal;
use servobench_files::{XmlBounds, XmlExcess};

/// Deepest nesting of elements. 700 bodies have filled the 2 MiB of a thread's stack.
const DEEPEST: usize = 100;

/// Refuses an `xml` with elements nested too deep. Invalid XML is left to its reader.
pub(super) fn check(xml: &str) -> Result<(), MjcfRefusal> {
    const ANY: usize = usize::MAX;
    let bounds = XmlBounds { bytes: ANY, depth: DEEPEST, attributes: ANY, attributes_in_all: ANY };
    bounds.hold(xml).map_err(|XmlExcess { at, .. }| {
        let name = xml[at + 1..].split(|c: char| c.is_whitespace() || c == '/' || c == '>').next();
        let line = u32::try_from(xml[..at].matches('\n').count() + 1).unwrap_or(u32::MAX);
        MjcfRefusal::TooDeep { line, element: name.unwrap_or_default().into(), depth: DEEPEST }
    })
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
