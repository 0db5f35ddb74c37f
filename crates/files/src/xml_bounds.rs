//! Bounds that hold before XML is parsed: parsers take time with the square of the number of attributes of an element, memory with the
//! number of elements, and the stack with the depth of elements in each other.

/// Largest amounts in an XML file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct XmlBounds {
    /// Bytes of the file.
    pub bytes: usize,
    /// Nesting depth of elements.
    pub depth: usize,
    /// Attributes of one element.
    pub attributes: usize,
    /// Attributes of all elements.
    pub attributes_in_all: usize,
}

/// The bound that is exceeded.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct XmlExcess {
    /// Its byte offset.
    pub at: usize,
    /// The exceeded quantity, in words.
    pub what: &'static str,
    /// The bound.
    pub most: usize,
}

impl XmlBounds {
    /// Checks the text against the bounds. It need not be XML: the parser refuses other text.
    ///
    /// # Errors
    /// The exceeded bound, and its byte offset.
    pub fn hold(&self, text: &str) -> Result<(), XmlExcess> {
        let beyond = |at, what, most| Err(XmlExcess { at, what, most });
        if text.len() > self.bytes {
            return beyond(0, "the number of bytes of the file", self.bytes);
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
            if values > self.attributes {
                return beyond(at, "the number of attributes of an element", self.attributes);
            }
            in_all += values;
            if in_all > self.attributes_in_all {
                return beyond(at, "the number of attributes", self.attributes_in_all);
            }
            let bytes = rest.as_bytes();
            if bytes.get(1) == Some(&b'/') {
                depth = depth.saturating_sub(1);
            } else if len < 2 || bytes[len - 2] != b'/' {
                depth += 1;
                if depth > self.depth {
                    return beyond(at, "the depth of elements in each other", self.depth);
                }
            }
            rest = &rest[len..];
        }
        Ok(())
    }
}

/// Length of the tag that `text` begins with, and its number of quoted values.
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
