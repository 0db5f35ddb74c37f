//! `[drive.objects]`: values for the objects of the drive, by index and sub-index.
//!
//! ```text
//! key = index [ "." sub-index ]      index = 1 to 4 hexadecimal digits "h"      "6065h", "607Dh.2", "1600h.0Ah"
//! sub-index = one decimal digit | 1 to 2 hexadecimal digits "h"                  "607Dh.02h" is "607Dh.2"
//! ```
//! The object dictionary decides which objects exist and which values they accept.
use crate::diagnostic::Report;
use crate::field::{Field, written};

use crate::scenario::ObjectWrite;
use crate::source::Span;
use crate::tree::{Entry, Node, Number, Value};
use serde_json::{Value as Json, json};
use servobench_cia402::units::Object;

/// Values for objects, in the order of the file.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct ObjectTable(pub(crate) Vec<ObjectWrite>);

const HELP: &str = "write \"6065h\" = 10000, or \"607Dh.2\" with a sub-index";

impl Field for ObjectTable {
    fn decode(path: &str, node: &Node, (): &(), report: &mut Report) -> Option<Self> {
        let Value::Table(table) = &node.value else {
            let message = format!("`{path}` must be a table, got {}", node.value.kind());
            report.error(node.span, message, format!("write `[{path}]`"));
            return None;
        };
        let mut objects = Self(Vec::new());
        let mut is_right = true;
        for entry in &table.entries {
            is_right &= objects.entry(path, entry, report).is_some();
        }
        is_right.then_some(objects)
    }

    fn schema((): &()) -> Json {
        let subindex = "([0-9]|[0-9A-Fa-f]{1,2}h)";
        let (variable, array) = (format!("^[0-9A-Fa-f]{{1,4}}h(\\.{subindex})?$"), format!("^{subindex}$"));
        let whole = json!({ "type": "integer" });
        json!({
            "type": "object",
            "additionalProperties": false,
            "patternProperties": {
                variable: { "anyOf": [whole, {
                    "type": "object",
                    "additionalProperties": false,
                    "patternProperties": { array: whole },
                }] },
            },
            "examples": ["\"6065h\" = 10000, \"607Dh.2\" = 500"],
        })
    }
}

impl ObjectTable {
    /// Adds the entry of one key: an object, or for an unquoted `607Dh.2` the sub-indices of one.
    fn entry(&mut self, path: &str, entry: &Entry, report: &mut Report) -> Option<()> {
        let (index, subindex) = entry.key.split_once('.').map_or((entry.key.as_str(), None), |(a, b)| (a, Some(b)));
        let Some(index) = hexadecimal(index, 4) else {
            return refuse(entry.key_span, format!("`{}` is not the index of an object", entry.key), report);
        };
        let path = format!("{path}.{}", entry.key);
        match (subindex, &entry.node.value) {
            (Some(subindex), _) => self.value(index, subindex, path, entry, report),
            (None, Value::Table(all)) => {
                let all = all.entries.iter();
                all.map(|one| self.value(index, &one.key, format!("{path}.{}", one.key), one, report))
                    .fold(Some(()), Option::and)
            }
            (None, _) => self.value(index, "0", path, entry, report),
        }
    }

    fn value(&mut self, index: u16, subindex: &str, key: String, entry: &Entry, report: &mut Report) -> Option<()> {
        let decimal = subindex.parse().ok().filter(|_| subindex.len() == 1);
        let subindex = decimal.or_else(|| hexadecimal(subindex, 2)).and_then(|subindex| u8::try_from(subindex).ok());
        let Some(subindex) = subindex else {
            return refuse(entry.key_span, format!("`{}` is not the sub-index of an object", entry.key), report);
        };
        let object = Object { index, subindex };
        if self.0.iter().any(|written| written.object == object) {
            let message = format!("{index:04X}h:{subindex:02X}h is written twice");
            report.error(entry.key_span, message, "the master writes each object once");
            return None;
        }
        let Value::Number(Number { whole: Some(value), .. }) = entry.node.value else {
            let message = format!("an object takes a whole number, got {}", written(&entry.node));
            report.error(entry.node.span, message, "values are in the units of the drive");
            return None;
        };
        self.0.push(ObjectWrite { object, value, key });
        Some(())
    }
}

/// A number of at most `most` hexadecimal digits, followed by `h`.
fn hexadecimal(text: &str, most: usize) -> Option<u16> {
    let digits = text.strip_suffix('h').filter(|digits| (1..=most).contains(&digits.len()))?;
    digits.bytes().all(|byte| byte.is_ascii_hexdigit()).then(|| u16::from_str_radix(digits, 16).ok())?
}

fn refuse(span: Span, message: String, report: &mut Report) -> Option<()> {
    report.error(span, message, HELP);
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn indices_are_hexadecimal_with_an_h() {
        for (text, index) in [("6065h", 0x6065), ("60ffh", 0x60ff), ("FFFFh", 0xffff), ("0h", 0)] {
            assert_eq!(hexadecimal(text, 4), Some(index), "{text}");
        }
        for text in ["6065", "0x6065", "h", "", "10000h", "+12h", "60g5h", "6065H"] {
            assert_eq!(hexadecimal(text, 4), None, "{text}");
        }
    }
}
