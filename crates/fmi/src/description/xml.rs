//! Writing XML: elements with attributes, one a line.
use std::fmt::{self, Display, Write as _};

/// A number as an `xs:double`: the shortest that reads back to the same bits.
pub(super) struct Number(pub(super) f64);

impl Display for Number {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            f64::INFINITY => f.write_str("INF"),
            f64::NEG_INFINITY => f.write_str("-INF"),
            number if number.is_nan() => f.write_str("NaN"),
            number => write!(f, "{number:?}"),
        }
    }
}

/// A start tag under construction.
pub(super) struct Element {
    name: &'static str,
    attributes: String,
}

impl Element {
    pub(super) const fn new(name: &'static str) -> Self {
        Self { name, attributes: String::new() }
    }

    pub(super) fn set(&mut self, name: &str, value: impl Display) -> &mut Self {
        // A `String` takes everything.
        let _ = write!(self.attributes, " {name}=\"{}\"", escaped(&value.to_string()));
        self
    }

    pub(super) fn set_some(&mut self, name: &str, value: Option<impl Display>) -> &mut Self {
        match value {
            Some(value) => self.set(name, value),
            None => self,
        }
    }

    /// Sets an attribute, unless the text is empty.
    pub(super) fn set_text(&mut self, name: &str, text: &str) -> &mut Self {
        self.set_some(name, (!text.is_empty()).then_some(text))
    }

    /// Sets factor and offset, unless they are one and zero.
    pub(super) fn set_scale(&mut self, factor: f64, offset: f64) -> &mut Self {
        let unless = |number: f64, default: f64| (number.to_bits() != default.to_bits()).then_some(Number(number));
        self.set_some("factor", unless(factor, 1.0)).set_some("offset", unless(offset, 0.0))
    }
}

/// `text` as an attribute. Characters that XML cannot hold become spaces.
fn escaped(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '"' => escaped.push_str("&quot;"),
            '\n' => escaped.push_str("&#10;"),
            '\r' => escaped.push_str("&#13;"),
            '\t' => escaped.push_str("&#9;"),
            c if c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}') => escaped.push(' '),
            c => escaped.push(c),
        }
    }
    escaped
}

/// The text under construction.
pub(super) struct Xml {
    text: String,
    depth: usize,
}

impl Xml {
    pub(super) fn new() -> Self {
        Self { text: String::from("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"), depth: 0 }
    }

    /// The text.
    pub(super) fn finish(self) -> String {
        self.text
    }

    fn line(&mut self, line: fmt::Arguments<'_>) {
        // A `String` takes everything.
        let _ = writeln!(self.text, "{:width$}{line}", "", width = 2 * self.depth);
    }

    pub(super) fn leaf(&mut self, element: Element) {
        let Element { name, attributes } = element;
        self.line(format_args!("<{name}{attributes}/>"));
    }

    pub(super) fn within(&mut self, element: Element, inside: impl FnOnce(&mut Self)) {
        let Element { name, attributes } = element;
        self.line(format_args!("<{name}{attributes}>"));
        self.depth += 1;
        inside(self);
        self.depth -= 1;
        self.line(format_args!("</{name}>"));
    }

    /// All `items` within an element, which is left out if there are none.
    pub(super) fn group<T>(&mut self, name: &'static str, items: &[T], mut each: impl FnMut(&mut Self, &T)) {
        if !items.is_empty() {
            self.within(Element::new(name), |xml| items.iter().for_each(|item| each(xml, item)));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_xml_means_otherwise_is_escaped() {
        assert_eq!(escaped("a<b & \"c\"\n\u{1}µ"), "a&lt;b &amp; &quot;c&quot;&#10; µ");
    }

    /// Oracle: the bits, and the grammar of `xs:double`.
    #[test]
    fn numbers_read_back_to_the_bit() {
        for number in [0.1, -0.0, 1e-300, f64::MAX, f64::MIN_POSITIVE, 1.0 / 3.0, 62.5e-6] {
            assert_eq!(Number(number).to_string().parse::<f64>().unwrap().to_bits(), number.to_bits());
        }
        assert_eq!(Number(f64::NEG_INFINITY).to_string(), "-INF");
    }
}
