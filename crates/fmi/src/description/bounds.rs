//! Bounds that hold before a model description is parsed: the parser takes time with the square of the number of attributes
//! of an element, and memory with the number of elements.
use crate::error::DescriptionProblem;

/// Bytes of a model description. Large ones, of some hundred thousand variables, have a hundred million.
pub(crate) const MOST_BYTES: usize = 1 << 27;
/// Elements, texts and comments.
pub(super) const MOST_NODES: u32 = 1 << 22;
/// Elements within each other. The standard has six, annotations of tools have what they like.
const MOST_DEPTH: usize = 64;
/// Attributes of one element. The standard has twenty at most.
const MOST_ATTRIBUTES: usize = 128;
/// Attributes of all elements.
const MOST_ATTRIBUTES_IN_ALL: usize = 1 << 24;

/// Holds the text against the bounds. It need not be XML: what is none is for the parser to refuse.
///
/// # Errors
/// The bound that is exceeded, and the byte where it is.
pub(super) fn hold(text: &str) -> Result<(), (usize, DescriptionProblem)> {
    let beyond = |at, what, most| Err((at, DescriptionProblem::Limit { what, most }));
    if text.len() > MOST_BYTES {
        return beyond(0, "the number of bytes of the file", MOST_BYTES);
    }
    let (mut depth, mut in_all) = (0_usize, 0);
    let mut rest = text;
    while let Some(start) = rest.find('<') {
        rest = &rest[start..];
        let at = text.len() - rest.len();
        if let Some(end) = [("<!--", "-->"), ("<![CDATA[", "]]>"), ("<?", "?>")]
            .into_iter()
            .find_map(|(begin, end)| rest.starts_with(begin).then_some(end))
        {
            let Some(end) = rest.find(end) else { return Ok(()) };
            rest = &rest[end..];
            continue;
        }
        let (len, values) = tag(rest);
        if values > MOST_ATTRIBUTES {
            return beyond(at, "the number of attributes of an element", MOST_ATTRIBUTES);
        }
        in_all += values;
        if in_all > MOST_ATTRIBUTES_IN_ALL {
            return beyond(at, "the number of attributes", MOST_ATTRIBUTES_IN_ALL);
        }
        let bytes = rest.as_bytes();
        if bytes.get(1) == Some(&b'/') {
            depth = depth.saturating_sub(1);
        } else if len < 2 || bytes[len - 2] != b'/' {
            depth += 1;
            if depth > MOST_DEPTH {
                return beyond(at, "the depth of elements in each other", MOST_DEPTH);
            }
        }
        rest = &rest[len..];
    }
    Ok(())
}

/// Length of the tag that `text` begins with, and how many quoted values are in it.
fn tag(text: &str) -> (usize, usize) {
    let (mut quote, mut values) = (None, 0);
    for (at, byte) in text.bytes().enumerate() {
        match quote {
            Some(open) if byte == open => {
                quote = None;
                values += 1;
            }
            None if byte == b'"' || byte == b'\'' => quote = Some(byte),
            None if byte == b'>' => return (at + 1, values),
            _ => {}
        }
    }
    (text.len(), values)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn what(text: &str) -> Option<(usize, &'static str)> {
        match hold(text) {
            Ok(()) => None,
            Err((at, DescriptionProblem::Limit { what, .. })) => Some((at, what)),
            Err(other) => panic!("{other:?}"),
        }
    }

    #[test]
    fn the_depth_counts_open_elements_only() {
        let flat = "<a><b/><!-- <c> --><![CDATA[<d>]]><e x='>'></e></a>";
        assert_eq!(what(&flat.repeat(100)), None);
        let deep = format!("<r>{}", "<a>".repeat(MOST_DEPTH));
        assert_eq!(what(&deep), Some((deep.len() - 3, "the depth of elements in each other")));
    }

    #[test]
    fn attributes_are_counted_by_their_values() {
        let element = |count: usize| format!("<a>\n<b {}/></a>", "x='\"' ".repeat(count));
        assert_eq!(what(&element(MOST_ATTRIBUTES)), None);
        assert_eq!(what(&element(MOST_ATTRIBUTES + 1)), Some((4, "the number of attributes of an element")));
    }
}
