//! Bounds checked before a model description is parsed: the parser's time grows with the square of the number of attributes of an
//! element, its memory with the number of elements.
use crate::error::DescriptionProblem;
use servobench_files::{XmlBounds, XmlExcess};

/// Bytes of a model description. Large ones, with some hundred thousand variables, have a hundred million.
pub(crate) const MOST_BYTES: usize = 1 << 27;
/// Elements, texts and comments.
pub(super) const MOST_NODES: u32 = 1 << 22;
/// Depth of nesting of elements. The standard has six, annotations of tools any number.
const MOST_DEPTH: usize = 64;
/// Attributes of one element. The standard has twenty at most.
const MOST_ATTRIBUTES: usize = 128;
/// Attributes of all elements.
const MOST_ATTRIBUTES_IN_ALL: usize = 1 << 24;

/// Checks the text against the bounds. The text need not be XML: the parser rejects what is not.
///
/// # Errors
/// The bound that is exceeded, and the byte offset.
pub(super) fn hold(text: &str) -> Result<(), (usize, DescriptionProblem)> {
    let bounds = XmlBounds {
        bytes: MOST_BYTES,
        depth: MOST_DEPTH,
        attributes: MOST_ATTRIBUTES,
        attributes_in_all: MOST_ATTRIBUTES_IN_ALL,
    };
    bounds.hold(text).map_err(|XmlExcess { at, what, most }| (at, DescriptionProblem::Limit { what, most }))
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
