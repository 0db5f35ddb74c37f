//! Start values.
use super::Version;
use super::element::{Element, boolean, float};
use super::variable::{DataType, Values};
use crate::error::FmuError;

/// Greatest number of elements of one array.
pub(super) const MOST_ELEMENTS: u64 = 1 << 24;

/// Start value of a variable: one for each element of an array, or one for all.
pub(super) fn start(element: Element, data_type: DataType, version: Version) -> Result<Option<Values>, FmuError> {
    match data_type {
        DataType::Float32 | DataType::Float64 => list(element, "a number", float, Values::Float),
        DataType::Boolean => list(element, "`true`, `false`, `1` or `0`", boolean, Values::Boolean),
        DataType::String if version == Version::Two => {
            Ok(element.text("start").map(|text| Values::String(vec![text.to_owned()])))
        }
        DataType::String => elements(element, "a text", |text| Some(text.to_owned()), Values::String),
        DataType::Binary => elements(element, "bytes of two hexadecimal digits each", bytes, Values::Binary),
        DataType::Clock => Ok(None),
        integers => {
            let Some((least, most)) = integers.integers() else { return Ok(None) };
            let number = |text: &str| text.parse().ok().filter(|value| (least..=most).contains(value));
            list(element, &format!("a whole number from {least} to {most}"), number, Values::Integer)
        }
    }
}

/// The list of the attribute `start`.
fn list<T>(
    element: Element,
    each: &str,
    read: impl Fn(&str) -> Option<T>,
    values: fn(Vec<T>) -> Values,
) -> Result<Option<Values>, FmuError> {
    let expected = format!("{each}, or a list of such");
    let all = |text: &str| {
        let all: Option<Vec<T>> = text.split_ascii_whitespace().map(&read).collect();
        all.filter(|all| !all.is_empty())
    };
    Ok(element.read("start", &expected, all)?.map(values))
}

/// The elements `<Start value="…"/>` of texts and bytes in FMI 3.0.
fn elements<T>(
    element: Element,
    expected: &str,
    read: impl Fn(&str) -> Option<T>,
    values: fn(Vec<T>) -> Values,
) -> Result<Option<Values>, FmuError> {
    let mut all = vec![];
    for start in element.children().filter(|child| child.name() == "Start") {
        let text = start.required("value")?;
        all.push(read(text).ok_or_else(|| start.wrong("value", expected))?);
    }
    Ok((!all.is_empty()).then(|| values(all)))
}

/// `xs:hexBinary`.
fn bytes(text: &str) -> Option<Vec<u8>> {
    let digits: Option<Vec<u8>> = text.trim().chars().map(|digit| u8::try_from(digit.to_digit(16)?).ok()).collect();
    digits
        .filter(|digits| digits.len() % 2 == 0)
        .map(|digits| digits.chunks(2).map(|two| two[0] << 4 | two[1]).collect())
}
