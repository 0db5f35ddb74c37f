//! The rows of a table of points: its heading, and the contents of its cells.
use super::column::{Column, Layout};
use super::counts::{self, Counts};
use super::mistake::{PointsError, PointsMistake};
use crate::quantity::Scale;
use crate::reading::{self, ReadError, names};
use servobench_files::{MOST_QUOTED, quoted};

/// Longest unit (characters): that of `0.1 counts/s`.
const LONGEST_UNIT: usize = MOST_QUOTED;

/// A column of the heading.
#[derive(Debug)]
pub(super) struct Head {
    pub(super) column: Column,
    pub(super) unit: String,
    scale: Scale,
    /// Index of its quantity in the column's candidates.
    pub(super) which: usize,
    /// Its place in characters.
    at: usize,
}

/// A cell of a row.
#[derive(Debug, Clone, Copy)]
struct Cell<'a> {
    /// Its contents, without surrounding spaces.
    text: &'a str,
    /// The row before its contents.
    before: &'a str,
}

impl Cell<'_> {
    /// Column in characters where its text begins, from 1.
    fn at(&self) -> usize {
        self.before.chars().count() + 1
    }
}

/// Reads a table of at most `most` points, and passes the value of each cell in the columns that `layout` uses to `take`: `None` for an
/// empty cell.
pub(super) fn read_rows(
    text: &str,
    layout: Layout,
    counts: Option<Counts>,
    most: usize,
    mut take: impl FnMut(Column, Option<f64>),
) -> Result<Vec<Head>, PointsError> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let mut rows = (1..).zip(text.lines()).filter(|(_, row)| !row.trim().is_empty());
    let Some((line, row)) = rows.next() else {
        return Err(wrong(1, 1, PointsMistake::NoHeading { like: layout.example() }));
    };
    let heads = heading(line, row, layout, counts)?;
    let (mut points, mut last) = (0, (line, f64::NEG_INFINITY));
    for (line, row) in rows {
        if points == most {
            return Err(wrong(line, 1, PointsMistake::TooMany { most }));
        }
        last = (line, read_row(&heads, layout, line, row, last.1, &mut take)?);
        points += 1;
    }
    match points {
        0 | 1 => Err(wrong(last.0, 1, PointsMistake::TooFew { points })),
        _ => Ok(heads),
    }
}

pub(super) const fn wrong(line: usize, column: usize, mistake: PointsMistake) -> PointsError {
    PointsError { line, column, mistake }
}

fn cells(row: &str) -> impl Iterator<Item = Cell<'_>> {
    let mut next = 0;
    row.split(',').map(move |cell| {
        let (text, spaces) = (cell.trim(), cell.len() - cell.trim_start().len());
        let begin = next + spaces;
        next += cell.len() + 1;
        Cell { text, before: &row[..begin] }
    })
}

/// The columns in their order.
fn heading(line: usize, row: &str, layout: Layout, counts: Option<Counts>) -> Result<Vec<Head>, PointsError> {
    for (found, name) in [(';', ";"), ('\t', "tab")] {
        if let Some((before, _)) = row.split_once(found).filter(|_| !row.contains(',')) {
            return Err(wrong(
                line,
                before.chars().count() + 1,
                PointsMistake::Separator { found: name, like: layout.shortest_example() },
            ));
        }
    }
    let mut heads: Vec<Head> = Vec::new();
    for cell in cells(row) {
        let (name, unit) = match cell.text.split_once('[') {
            Some((name, rest)) => (name.trim_end(), rest.strip_suffix(']').map(str::trim)),
            None => (cell.text, None),
        };
        let fail = |mistake| wrong(line, cell.at(), mistake);
        let Some(column) = Column::ALL.into_iter().find(|column| column.name() == name) else {
            return Err(fail(PointsMistake::UnknownColumn { name: quoted(name).to_string(), like: layout.example() }));
        };
        if heads.iter().any(|head| head.column == column) {
            return Err(fail(PointsMistake::Twice { column }));
        }
        if layout.is_value(column) && heads.iter().any(|head| layout.is_value(head.column)) {
            return Err(fail(PointsMistake::PositionAndStep));
        }
        let Some(unit) = unit.filter(|unit| !unit.is_empty()) else {
            return Err(fail(PointsMistake::NoUnit { column, proposal: column.proposal() }));
        };
        let refuse = |message: String| fail(PointsMistake::Unit { column, unit: quoted(unit).to_string(), message });
        // A message about a mistake within the unit would quote all of it.
        if unit.chars().count() > LONGEST_UNIT {
            return Err(refuse("no unit is that long".to_owned()));
        }
        let read = counts::read_unit(column, unit, counts).unwrap_or_else(|| read_unit(column, unit));
        let (scale, which) = read.map_err(refuse)?;
        heads.push(Head { column, unit: unit.to_owned(), scale, which, at: cell.at() });
    }
    let [time, values] = layout.needed();
    let has_time = heads.iter().any(|head| head.column == time);
    let has_values = heads.iter().any(|head| layout.is_value(head.column));
    for (column, is_there) in [(time, has_time), (values, has_values)] {
        if !is_there {
            return Err(wrong(line, 1, PointsMistake::Missing { column, proposal: column.proposal() }));
        }
    }
    agreeing(line, heads, layout)
}

/// `heads`, unless positions and their derivatives are of different kinds of axes.
fn agreeing(line: usize, heads: Vec<Head>, layout: Layout) -> Result<Vec<Head>, PointsError> {
    if let Some(values) = heads.iter().find(|head| layout.is_value(head.column))
        && let Some(other) = heads.iter().find(|head| head.column != Column::Time && head.which != values.which)
    {
        let needed = other.column.candidates()[values.which].name;
        let message = format!("{} are in `{}`, {needed} is needed", values.column.plural(), values.unit);
        let mistake = PointsMistake::Unit { column: other.column, unit: other.unit.clone(), message };
        return Err(wrong(line, other.at, mistake));
    }
    Ok(heads)
}

/// The scale of `unit`, and the index of its quantity in the candidates of `column`.
fn read_unit(column: Column, unit: &str) -> Result<(Scale, usize), String> {
    let candidates = column.candidates();
    let with = |message: &str, help: &str| if help.is_empty() { message.into() } else { format!("{message}; {help}") };
    let (which, _) = reading::read(&format!("1 {unit}"), &candidates).map_err(|error| match error {
        ReadError::NoQuantity(error) => with(&error.message, &error.help),
        ReadError::NoUnit => format!("{} has a unit", names(&candidates)),
        ReadError::OtherDimension { is, help } => {
            with(&format!("{} is needed, this is {is}", names(&candidates)), help)
        }
    })?;
    let scale = Scale::read(unit).map_err(|error| with(&error.message, &error.help))?;
    Ok((scale, which))
}

/// Passes a point, which must be later than `before` (s), to `take`; returns its time (s).
fn read_row(
    heads: &[Head],
    layout: Layout,
    line: usize,
    row: &str,
    before: f64,
    take: &mut impl FnMut(Column, Option<f64>),
) -> Result<f64, PointsError> {
    let (mut read, mut time) = (0, before);
    for (head, cell) in heads.iter().zip(cells(row)) {
        let column = head.column;
        read += 1;
        let is_used = layout.uses(column);
        if cell.text.is_empty() && column != Column::Time && !layout.is_value(column) {
            if is_used {
                take(column, None);
            }
            continue;
        }
        let value = number(&head.scale, cell.text).map_err(|reason| {
            // A row of another width is reported as such: its values are in the wrong columns.
            width(line, row, heads.len()).err().unwrap_or_else(|| {
                wrong(line, cell.at(), PointsMistake::Value { column, text: quoted(cell.text).to_string(), reason })
            })
        })?;
        if column == Column::Time {
            if value <= before {
                return Err(wrong(line, cell.at(), PointsMistake::Order { time: value, before }));
            }
            time = value;
        }
        if is_used {
            take(column, Some(value));
        }
    }
    if read < heads.len() || row.bytes().filter(|byte| *byte == b',').count() + 1 != heads.len() {
        width(line, row, heads.len())?;
    }
    Ok(time)
}

/// An error unless `row` has `expected` values.
fn width(line: usize, row: &str, expected: usize) -> Result<(), PointsError> {
    match cells(row).count() {
        found if found == expected => Ok(()),
        found => Err(wrong(line, 1, PointsMistake::Width { found, expected })),
    }
}

/// The value (SI) of `text`.
fn number(scale: &Scale, text: &str) -> Result<f64, &'static str> {
    match text.parse::<f64>() {
        Ok(number) if number.is_finite() => scale.value(text),
        Ok(_) if text.contains(|c: char| c.is_ascii_digit()) => Err("the number is too large: above 1e30 in SI"),
        Ok(_) => Err("the number must be finite"),
        Err(_) if text.is_empty() => Err("write a number; only `velocity` beside `position` may be left empty"),
        Err(_) => Err("write a number like `12.5`; its unit is in the heading"),
    }
}
