//! Elements and attributes of a parsed model description, with their places.
use super::named::one_of;
use crate::error::{DescriptionProblem, FmuError};
use roxmltree::{Document, Node};
use servobench_config::Choice;

/// An element.
#[derive(Debug, Clone, Copy)]
pub(super) struct Element<'a> {
    node: Node<'a, 'a>,
    file: &'a str,
}

impl<'a> Element<'a> {
    pub(super) fn root(document: &'a Document<'a>, file: &'a str) -> Self {
        Self { node: document.root_element(), file }
    }

    pub(super) fn name(self) -> &'a str {
        self.node.tag_name().name()
    }

    pub(super) fn children(self) -> impl Iterator<Item = Self> {
        let file = self.file;
        self.node.children().filter(Node::is_element).map(move |node| Self { node, file })
    }

    /// The first child of this name.
    pub(super) fn child(self, name: &str) -> Option<Self> {
        self.children().find(|child| child.name() == name)
    }

    /// Children of the child of this name; empty without such a child.
    pub(super) fn grandchildren(self, name: &str) -> impl Iterator<Item = Self> {
        self.child(name).into_iter().flat_map(Self::children)
    }

    /// The value of an attribute.
    pub(super) fn text(self, attribute: &str) -> Option<&'a str> {
        self.node.attribute(attribute)
    }

    /// The value of an attribute; empty if it is missing.
    pub(super) fn text_or_empty(self, attribute: &str) -> String {
        self.text(attribute).unwrap_or_default().to_owned()
    }

    /// # Errors
    /// The attribute is missing.
    pub(super) fn required(self, attribute: &'static str) -> Result<&'a str, FmuError> {
        let missing = || DescriptionProblem::NoAttribute { element: self.name().to_owned(), attribute };
        self.text(attribute).ok_or_else(|| self.error(missing()))
    }

    /// The attribute read by `read`, which takes the text without white space around it.
    ///
    /// # Errors
    /// The attribute is there and `read` returns `None`: `expected` describes a valid value.
    pub(super) fn read<T>(
        self,
        attribute: &'static str,
        expected: &str,
        read: impl FnOnce(&str) -> Option<T>,
    ) -> Result<Option<T>, FmuError> {
        let Some(text) = self.text(attribute) else { return Ok(None) };
        read(text.trim()).map(Some).ok_or_else(|| self.wrong(attribute, expected))
    }

    pub(super) fn boolean(self, attribute: &'static str) -> Result<bool, FmuError> {
        Ok(self.read(attribute, "`true`, `false`, `1` or `0`", boolean)?.unwrap_or(false))
    }

    /// A finite number.
    pub(super) fn number(self, attribute: &'static str) -> Result<Option<f64>, FmuError> {
        self.read(attribute, "a finite number", |text| float(text).filter(|value| value.is_finite()))
    }

    pub(super) fn unsigned(self, attribute: &'static str) -> Result<Option<u32>, FmuError> {
        self.read(attribute, "a whole number of 32 bits without a sign", |text| text.parse().ok())
    }

    pub(super) fn named<T: Choice + PartialEq>(self, attribute: &'static str) -> Result<Option<T>, FmuError> {
        let Some(text) = self.text(attribute) else { return Ok(None) };
        let expected = || one_of(T::ALL.iter().map(|(name, ..)| *name));
        T::from_name(text.trim()).map(Some).ok_or_else(|| self.wrong(attribute, expected()))
    }

    /// A list of whole numbers without a sign.
    pub(super) fn references(self, attribute: &'static str) -> Result<Option<Vec<u32>>, FmuError> {
        let numbers = |text: &str| text.split_ascii_whitespace().map(str::parse).collect::<Result<_, _>>().ok();
        self.read(attribute, "whole numbers without a sign, with spaces between them", numbers)
    }

    /// Error: the attribute is not what was `expected`.
    pub(super) fn wrong(self, attribute: &'static str, expected: impl Into<String>) -> FmuError {
        let value = self.text_or_empty(attribute);
        let element = self.name().to_owned();
        self.error_at(attribute, DescriptionProblem::Attribute { element, attribute, value, expected: expected.into() })
    }

    /// Error: the attribute has the value of another one.
    pub(super) fn twice(self, attribute: &'static str, first: &str) -> FmuError {
        let value = self.text_or_empty(attribute);
        let element = self.name().to_owned();
        self.error_at(attribute, DescriptionProblem::Twice { element, attribute, value, first: first.to_owned() })
    }

    /// An error at the element.
    pub(super) fn error(self, problem: DescriptionProblem) -> FmuError {
        self.at(self.node.range().start, problem)
    }

    /// An error at one of its attributes, or at the element if it does not have the attribute.
    pub(super) fn error_at(self, attribute: &str, problem: DescriptionProblem) -> FmuError {
        let start = self.node.attribute_node(attribute).map_or(self.node.range().start, |found| found.range().start);
        self.at(start, problem)
    }

    fn at(self, byte: usize, problem: DescriptionProblem) -> FmuError {
        let place = self.node.document().text_pos_at(byte);
        FmuError::Description {
            file: self.file.to_owned(),
            line: place.row,
            column: place.col,
            problem: Box::new(problem),
        }
    }
}

/// `xs:boolean`.
pub(super) fn boolean(text: &str) -> Option<bool> {
    match text {
        "true" | "1" => Some(true),
        "false" | "0" => Some(false),
        _ => None,
    }
}

/// `xs:double`, which allows `INF` and `NaN` and, unlike Rust, no other words.
pub(super) fn float(text: &str) -> Option<f64> {
    match text {
        "INF" | "+INF" => Some(f64::INFINITY),
        "-INF" => Some(f64::NEG_INFINITY),
        "NaN" => Some(f64::NAN),
        _ => text.bytes().all(|byte| byte.is_ascii_digit() || b"+-.eE".contains(&byte)).then(|| text.parse().ok())?,
    }
}
