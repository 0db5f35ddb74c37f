//! The object dictionary as JSON: the table with the present values.
use super::dictionary::Dictionary;
use super::entry::{Admitted, Contents, Entry};
use super::table::OBJECTS;
use crate::units::Object;
use core::fmt::{self, Display, Formatter};

/// The object dictionary as a JSON array with one object for each entry, as displayable text.
///
/// `index` and `subindex` are numbers; `range` has two numbers, `accepted` several, `bits` a mask, and without these three the entry takes
/// every value of its type. `value` is null for a write-only entry.
#[derive(Debug, Clone, Copy)]
pub struct Json<'a>(pub &'a Dictionary);

impl Display for Json<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let mut before = "[\n  ";
        for object in &OBJECTS {
            if let Contents::Text(text) = object.contents {
                let (index, name) = (object.index, object.name);
                write!(
                    f,
                    "{before}{{\"index\": {index}, \"subindex\": 0, \"object\": \"{name}\", \"name\": \"{name}\""
                )?;
                f.write_str(", \"type\": \"VISIBLE_STRING\", \"access\": \"const\", \"pdo\": \"\", \"unit\": \"\"")?;
                write!(f, ", \"disabled_only\": false, \"default\": \"{text}\", \"value\": \"{text}\"}}")?;
                before = ",\n  ";
            }
            for (subindex, entry) in (object.first_subindex()..).zip(object.entries()) {
                f.write_str(before)?;
                before = ",\n  ";
                let address = Object { index: object.index, subindex };
                write!(f, "{{\"index\": {}, \"subindex\": {subindex}, \"object\": \"{}\"", object.index, object.name)?;
                description(f, entry)?;
                match self.0.read(address) {
                    Ok(value) => write!(f, ", \"value\": {value}}}")?,
                    Err(_) => f.write_str(", \"value\": null}")?,
                }
            }
        }
        f.write_str("\n]\n")
    }
}

/// Writes the description of an entry. No name, no unit and no string has a character that JSON escapes.
fn description(f: &mut Formatter<'_>, entry: &Entry) -> fmt::Result {
    let Entry { name, data_type, access, mapping, unit, disabled_only, .. } = *entry;
    let (data_type, access, mapping) = (data_type.name(), access.abbreviation(), mapping.abbreviation());
    write!(f, ", \"name\": \"{name}\", \"type\": \"{data_type}\", \"access\": \"{access}\", \"pdo\": \"{mapping}\"")?;
    write!(f, ", \"unit\": \"{unit}\", \"disabled_only\": {disabled_only}, \"default\": {}", entry.default_value())?;
    if let Some(mode) = entry.governs {
        write!(f, ", \"governs\": \"{}\"", mode.abbreviation())?;
    }
    match entry.admitted {
        Admitted::Any => Ok(()),
        Admitted::Range(lowest, highest) => write!(f, ", \"range\": [{lowest}, {highest}]"),
        // Rust and JSON write a slice of numbers alike.
        Admitted::OneOf(accepted) => write!(f, ", \"accepted\": {accepted:?}"),
        Admitted::Bits(bits) => write!(f, ", \"bits\": {bits}"),
    }
}
