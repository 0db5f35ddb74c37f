//! The object dictionary of the drive as a table.
use crate::style::{Ink, Style};
use crate::text::wrapped;
use servobench_cia402::objects::{Admitted, Contents, Dictionary, Entry, OBJECTS};
use servobench_cia402::units::Object;

/// Width of `60E3h:32`, the longest index.
const INDEX: usize = 8;
/// Width of `UINT32`.
const TYPE: usize = 6;
/// Width of `const`.
const ACCESS: usize = 5;
/// Width of `-2147483648` and a mark before it.
const VALUE: usize = 12;
/// Width of `position unit`; longer ones are wrapped.
const UNIT: usize = 13;
/// Width of `1 and more`; longer ones are wrapped.
const RANGE: usize = 10;
/// Width of all columns but the name, and their separators.
const FIXED: usize = INDEX + TYPE + ACCESS + VALUE + UNIT + RANGE + 5;
/// Narrowest column of names: rather than narrow it further, the table becomes wider than the terminal.
const NARROWEST_NAME: usize = 16;

/// All values of `dictionary` with their entries in the object dictionary; an object with several values is under its name. Long
/// texts continue below. Values that differ from those after power-on are marked.
#[must_use]
pub fn object_table(dictionary: &Dictionary, style: Style) -> String {
    let name = style.width.saturating_sub(FIXED).max(NARROWEST_NAME);
    let heading = format!(
        "{:INDEX$} {:name$} {:TYPE$} {:ACCESS$}{:>VALUE$} {:UNIT$} RANGE",
        "INDEX", "NAME", "TYPE", "R/W", "VALUE", "UNIT"
    );
    let mut table = style.paint(Ink::Heading, &heading) + "\n";
    let mut is_marked = false;
    for object in &OBJECTS {
        let index = object.index;
        if let Contents::Text(text) = object.contents {
            for (k, part) in wrapped(object.name, name).iter().enumerate() {
                let line = if k == 0 {
                    let index = format!("{index:04X}h");
                    format!("{index:INDEX$} {part:name$} {:TYPE$} {:ACCESS$} {text}", "STRING", "const")
                } else {
                    format!("{:INDEX$} {part}", "")
                };
                table += &line;
                table += "\n";
            }
            continue;
        }
        let is_variable = matches!(object.contents, Contents::Variable(_));
        if !is_variable {
            let over_its_values = format!("{:INDEX$} {}\n", format!("{index:04X}h"), object.name);
            table += &over_its_values;
        }
        for (subindex, entry) in (object.first_subindex()..).zip(object.entries()) {
            let address = Object { index, subindex };
            let row = Row {
                index: if is_variable { format!("{index:04X}h") } else { format!("{index:04X}h:{subindex}") },
                entry,
                value: dictionary.read(address).map_or_else(|_| "–".into(), |value| value.to_string()),
                is_marked: dictionary.read(address).is_ok_and(|value| value != entry.default_value()),
            };
            is_marked |= row.is_marked;
            table += &row.lines(name, style);
        }
    }
    table += "\n¹ written only while the drive function is disabled\n² not written during a homing search or while points are followed\n";
    if is_marked {
        table += "* not the value after power-on\n";
    }
    table
}

/// One value.
struct Row<'a> {
    /// Index of the object: `6065h`, `607Dh:2`.
    index: String,
    entry: &'a Entry,
    value: String,
    /// True if the value differs from that after power-on.
    is_marked: bool,
}

impl Row<'_> {
    /// The row in as many lines as its longest text needs.
    fn lines(&self, name: usize, style: Style) -> String {
        let Entry { data_type, access, disabled_only, governs, unit, .. } = *self.entry;
        let names = wrapped(self.entry.name, name);
        let (units, ranges) = (wrapped(unit, UNIT), wrapped(&range(self.entry), RANGE));
        let data_type = data_type.name().replace("INTEGER", "INT").replace("UNSIGNED", "UINT");
        let footnote = match governs {
            _ if disabled_only => "¹",
            Some(_) => "²",
            None => "",
        };
        let access = format!("{}{footnote}", access.abbreviation());
        let value = if self.is_marked {
            style.paint(Ink::Heading, &format!("{:>VALUE$}", format!("*{}", self.value)))
        } else {
            format!("{:>VALUE$}", self.value)
        };
        let count = names.len().max(units.len()).max(ranges.len());
        let line = |k: usize| {
            let [name_part, unit_part, range_part] =
                [&names, &units, &ranges].map(|parts| parts.get(k).map_or("", String::as_str));
            let start = if k == 0 {
                format!("{:INDEX$} {name_part:name$} {data_type:TYPE$} {access:ACCESS$}{value}", self.index)
            } else {
                format!("{:INDEX$} {name_part:name$} {:TYPE$} {:ACCESS$}{:VALUE$}", "", "", "", "")
            };
            format!("{start} {unit_part:UNIT$} {range_part}").trim_end().to_owned() + "\n"
        };
        (0..count).map(line).collect()
    }
}

/// Values that the entry takes; empty if it takes all of its type.
fn range(entry: &Entry) -> String {
    match entry.admitted {
        Admitted::Any => String::new(),
        Admitted::Range(lowest, highest) if lowest == highest => lowest.to_string(),
        Admitted::Range(lowest, highest) if i128::from(highest) == entry.data_type.highest() => {
            format!("{lowest} and more")
        }
        Admitted::Range(lowest, highest) => format!("{lowest} to {highest}"),
        Admitted::OneOf(accepted) => list(accepted),
        Admitted::Bits(bits) => format!("bits {bits:02X}h"),
    }
}

/// Numbers in ascending order; three or more in a row as a range.
fn list(numbers: &[i64]) -> String {
    let runs = numbers.chunk_by(|one, next| one + 1 == *next).map(|run| match run {
        [first, .., last] if run.len() > 2 => format!("{first} to {last}"),
        _ => run.iter().map(i64::to_string).collect::<Vec<_>>().join(", "),
    });
    runs.collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use servobench_cia402::PowerState;

    #[test]
    fn numbers_in_a_row_are_told_by_their_ends() {
        assert_eq!(list(&[0, 1, 3, 4, 6, 7, 8, 9, 10]), "0, 1, 3, 4, 6 to 10");
        assert_eq!(list(&[-3]), "-3");
        assert_eq!(list(&[1, 2, 3]), "1 to 3");
        assert_eq!(list(&[]), "");
    }

    #[test]
    fn no_line_is_wider_than_the_terminal() {
        for width in [80, 100, 132] {
            let table = object_table(&Dictionary::new(), Style { width, colour: false });
            let widest = table.lines().map(|line| line.chars().count()).max().unwrap();
            assert!(widest <= width, "{widest} columns of {width}");
        }
    }

    /// The columns of `line` after index and name, without wrapped text.
    fn columns(table: &str, index: &str) -> Vec<String> {
        let line = table.lines().find(|line| line.split(' ').next() == Some(index)).unwrap();
        line.chars().skip(31).collect::<String>().split_whitespace().map(str::to_owned).collect()
    }

    /// Types, units and bounds typed from CiA 402-2.
    #[test]
    fn a_line_says_what_the_standard_says() {
        let table = object_table(&Dictionary::new(), Style::default());
        assert_eq!(columns(&table, "6041h"), ["UINT16", "ro", "0"]);
        assert_eq!(columns(&table, "6064h"), ["INT32", "ro", "0", "position", "unit"]);
        assert_eq!(columns(&table, "607Dh:1"), ["INT32", "rw", "-2147483648", "position", "unit"]);
        assert_eq!(columns(&table, "6066h"), ["UINT16", "rw", "0", "ms"]);
        assert_eq!(columns(&table, "605Ah"), ["INT16", "rw", "2", "0", "to", "8"]);
        // A write-only object has no value to show.
        assert_eq!(columns(&table, "2010h"), ["UINT64", "wo", "–"]);
        assert!(!table.contains('*'), "all values are those after power-on");
    }

    #[test]
    fn what_was_written_is_marked() {
        let mut dictionary = Dictionary::new();
        let limit = Object { index: 0x607D, subindex: 2 };
        dictionary.write_number(limit, 500_000, PowerState::SwitchOnDisabled).unwrap();
        let table = object_table(&dictionary, Style::default());
        let marked: Vec<&str> = table.lines().filter(|line| line.contains('*')).collect();
        assert!(
            matches!(marked[..], [line, note] if line.contains(" *500000 ") && note.starts_with('*')),
            "{marked:?}"
        );
    }
}
