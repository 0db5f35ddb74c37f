//! Tables of points: time, position and, where it is known, velocity, as comma-separated values.
//!
//! ```text
//! time [ms],position [mm],velocity [mm/s]
//! 0,0,0
//! 10,5,
//! 20,15,1000
//! ```
//! The heading names the columns, in any order, with the unit of all their numbers. `velocity` may be left out, or a row of
//! it left empty. Times increase. Spaces around numbers and empty lines do not matter; the decimal sign is a point.
//!
//! A profile is such a table of times and of velocities or accelerations alone.
mod column;
mod mistake;

use crate::quantity::Scale;
use crate::reading::{self, ReadError, names};
use crate::scenario::Motion;

pub use column::Column;
use column::Layout;
pub use mistake::{PointsError, PointsMistake};

/// Points at most: a table of more is taken for a mistake.
pub const MOST_POINTS: usize = 5_000_000;

/// Points of a move, in SI: two at least, in the order of time.
#[derive(Debug, Clone, PartialEq)]
pub struct Points {
    /// Whether positions are lengths or angles.
    pub motion: Motion,
    /// Times (s), each later than the one before.
    pub times: Vec<f64>,
    /// Positions (m or rad), one for each time.
    pub positions: Vec<f64>,
    /// Velocities (m/s or rad/s), one for each time where there is such a column, and none where it is empty.
    pub velocities: Option<Vec<Option<f64>>>,
    /// Units as the heading writes them: of time, position, velocity.
    pub units: [Option<String>; 3],
}

/// A profile, in SI: two points at least, in the order of time.
#[derive(Debug, Clone, PartialEq)]
pub struct Profile {
    /// Whether its values are those of lengths or of angles.
    pub motion: Motion,
    /// Times (s), each later than the one before.
    pub times: Vec<f64>,
    /// Velocities or accelerations, one for each time.
    pub values: Vec<f64>,
}

/// A column of the heading.
#[derive(Debug)]
struct Head {
    column: Column,
    unit: String,
    scale: Scale,
    /// Which of its candidates it measures.
    which: usize,
    /// Its column in characters.
    at: usize,
}

/// A cell of a row.
#[derive(Debug, Clone, Copy)]
struct Cell<'a> {
    /// What stands in it, without the spaces around it.
    text: &'a str,
    /// What stands before that in the row.
    before: &'a str,
}

impl Cell<'_> {
    /// Where its text begins, from 1.
    fn at(&self) -> usize {
        self.before.chars().count() + 1
    }
}

/// Reads a table of points.
///
/// # Errors
/// [`PointsError`], the first mistake.
pub fn read_points(text: &str) -> Result<Points, PointsError> {
    read(text, MOST_POINTS)
}

/// Reads a profile of the values `column`, velocities or accelerations.
///
/// # Errors
/// [`PointsError`], the first mistake.
pub fn read_profile(text: &str, column: Column) -> Result<Profile, PointsError> {
    let layout = if column == Column::Acceleration { Layout::Accelerations } else { Layout::Velocities };
    let (mut times, mut values) = (Vec::new(), Vec::new());
    let heads = read_rows(text, layout, MOST_POINTS, |column, value| match column {
        Column::Time => times.extend(value),
        Column::Position | Column::Velocity | Column::Acceleration => values.extend(value),
    })?;
    Ok(Profile { motion: motion(&heads), times, values })
}

/// Reads a table of `most` points at most.
fn read(text: &str, most: usize) -> Result<Points, PointsError> {
    let (mut times, mut positions, mut velocities) = (Vec::new(), Vec::new(), Vec::new());
    let heads = read_rows(text, Layout::Positions, most, |column, value| match column {
        Column::Time => times.extend(value),
        Column::Position => positions.extend(value),
        Column::Velocity | Column::Acceleration => velocities.push(value),
    })?;
    let has_velocity = heads.iter().any(|head| head.column == Column::Velocity);
    let unit = |column| heads.iter().find(|head| head.column == column).map(|head| head.unit.clone());
    Ok(Points {
        motion: motion(&heads),
        times,
        positions,
        velocities: has_velocity.then_some(velocities),
        units: [Column::Time, Column::Position, Column::Velocity].map(unit),
    })
}

/// Whether the values below `heads` are those of lengths or of angles.
fn motion(heads: &[Head]) -> Motion {
    let is_rotary = heads.iter().any(|head| head.column != Column::Time && head.which == 1);
    if is_rotary { Motion::Rotary } else { Motion::Linear }
}

/// Reads a table of `most` points at most, and gives what stands in its cells to `take`: nothing where one is empty.
fn read_rows(
    text: &str,
    layout: Layout,
    most: usize,
    mut take: impl FnMut(Column, Option<f64>),
) -> Result<Vec<Head>, PointsError> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let mut rows = (1..).zip(text.lines()).filter(|(_, row)| !row.trim().is_empty());
    let Some((line, row)) = rows.next() else {
        return Err(wrong(1, 1, PointsMistake::NoHeading { like: layout.example() }));
    };
    let heads = heading(line, row, layout)?;
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

const fn wrong(line: usize, column: usize, mistake: PointsMistake) -> PointsError {
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
fn heading(line: usize, row: &str, layout: Layout) -> Result<Vec<Head>, PointsError> {
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
        let Some(column) = layout.columns().find(|column| column.name() == name) else {
            return Err(fail(PointsMistake::UnknownColumn { name: name.to_owned(), like: layout.example() }));
        };
        if heads.iter().any(|head| head.column == column) {
            return Err(fail(PointsMistake::Twice { column }));
        }
        let Some(unit) = unit.filter(|unit| !unit.is_empty()) else {
            return Err(fail(PointsMistake::NoUnit { column, proposal: column.proposal() }));
        };
        let (scale, which) = read_unit(column, unit)
            .map_err(|message| fail(PointsMistake::Unit { column, unit: unit.to_owned(), message }))?;
        heads.push(Head { column, unit: unit.to_owned(), scale, which, at: cell.at() });
    }
    for column in layout.needed() {
        if heads.iter().all(|head| head.column != column) {
            return Err(wrong(line, 1, PointsMistake::Missing { column, proposal: column.proposal() }));
        }
    }
    agreeing(line, heads)
}

/// `heads`, unless positions and velocities are those of different axes.
fn agreeing(line: usize, heads: Vec<Head>) -> Result<Vec<Head>, PointsError> {
    let of = |column| heads.iter().find(|head| head.column == column);
    if let (Some(position), Some(velocity)) = (of(Column::Position), of(Column::Velocity))
        && position.which != velocity.which
    {
        let needed = Column::Velocity.candidates()[position.which].name;
        let message = format!("positions are in `{}`, {needed} is needed", position.unit);
        let mistake = PointsMistake::Unit { column: Column::Velocity, unit: velocity.unit.clone(), message };
        return Err(wrong(line, velocity.at, mistake));
    }
    Ok(heads)
}

/// The scale of `unit`, and which of the candidates of `column` it measures.
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

/// Gives a point to `take` that must be later than `before` (s); its time (s).
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
        if cell.text.is_empty() && !layout.needed().contains(&column) {
            take(column, None);
            continue;
        }
        let value = number(&head.scale, cell.text).map_err(|reason| {
            // A row of another width is told as such: its values are in the wrong columns.
            width(line, row, heads.len()).err().unwrap_or_else(|| {
                wrong(line, cell.at(), PointsMistake::Value { column, text: shown(cell.text), reason })
            })
        })?;
        if column == Column::Time {
            if value <= before {
                return Err(wrong(line, cell.at(), PointsMistake::Order { time: value, before }));
            }
            time = value;
        }
        take(column, Some(value));
    }
    if read < heads.len() || row.bytes().filter(|byte| *byte == b',').count() + 1 != heads.len() {
        width(line, row, heads.len())?;
    }
    Ok(time)
}

/// Nothing, if `row` has `expected` values.
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
        Err(_) if text.is_empty() => Err("write a number; only `velocity` may be left empty"),
        Err(_) => Err("write a number like `12.5`, its unit stands in the heading"),
    }
}

/// As much of a cell as belongs into a message.
fn shown(text: &str) -> String {
    const MOST: usize = 40;
    if text.chars().count() <= MOST { text.to_owned() } else { text.chars().take(MOST).chain(['…']).collect() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_is_read_in_si() {
        let text =
            "\u{feff}position [mm], time [ms] ,velocity [m/min]\r\n0,0,0\r\n\r\n 250 , 10,\r\n1e3,+20.5,-30\r\n\r\n";
        let points = read_points(text).unwrap();
        assert_eq!((points.motion, &points.times), (Motion::Linear, &vec![0.0, 0.01, 0.0205]));
        assert_eq!(points.positions, [0.0, 0.25, 1.0]);
        assert_eq!(points.velocities, Some(vec![Some(0.0), None, Some(-0.5)]));
        assert_eq!(points.units.map(Option::unwrap), ["ms", "mm", "m/min"]);
    }

    #[test]
    fn angles_make_a_rotary_axis() {
        let points = read_points("time [s],position [rev]\n0,0\n1,-2").unwrap();
        assert_eq!((points.motion, points.velocities), (Motion::Rotary, None));
        assert!((points.positions[1] + 2.0 * std::f64::consts::TAU).abs() < 1e-15);
    }

    /// A number in a column is the very one that a quantity with its unit is.
    #[test]
    fn numbers_are_those_of_quantities() {
        for (number, unit) in
            [("0.1", "um"), ("7.3", "mm"), ("1.7e2", "cm"), ("33", "km"), ("-0.7", "deg"), (".5", "m")]
        {
            let text = format!("time [s],position [{unit}]\n0,0\n1,{number}");
            let quantity = crate::quantity::parse(&format!("{number} {unit}")).unwrap();
            assert_eq!(read_points(&text).unwrap().positions[1].to_bits(), quantity.value.to_bits(), "{number} {unit}");
        }
    }

    #[test]
    fn every_mistake_says_where_it_is_and_the_way_out() {
        let heading = "time [ms],position [mm],velocity [mm/s]\n";
        for (text, said) in [
            ("", "1:1: the table is empty: begin with a heading like `time [ms],position [mm],velocity [mm/s]`"),
            ("\n\ntime,x", "3:1: `time` needs its unit in brackets: write `time [ms]`"),
            ("0,0\n1,1", "1:1: unknown column `0`: the heading is like `time [ms],position [mm],velocity [mm/s]`"),
            (
                "time [ms];position [mm]\n",
                "1:10: columns are separated by commas, not by `;`: write `time [ms],position [mm]`, numbers with a point",
            ),
            ("time [s],time [ms]\n", "1:10: there are two columns `time`: delete one"),
            ("time [s]\n0\n1", "1:1: the column `position` is missing: add `position [mm]`"),
            (
                "time [s],position [s]\n",
                "1:10: `position` cannot be in `s`: a length or an angle is needed, this is a time (s)",
            ),
            ("time [s],position [MM]\n", "1:10: `position` cannot be in `MM`: unknown unit `MM`; did you mean `mm`?"),
            (
                "time [s],position [mm],velocity [rpm]\n",
                "1:24: `velocity` cannot be in `rpm`: positions are in `mm`, a velocity is needed",
            ),
            (
                "time [s],position [mm]\n0,0\n1,x",
                "3:3: `position` is `x`: write a number like `12.5`, its unit stands in the heading",
            ),
            ("time [s],position [mm]\n0,0\n1,nan", "3:3: `position` is `nan`: the number must be finite"),
            (
                "time [s],position [mm]\n0,0\n1,1e40",
                "3:3: `position` is `1e40`: the number is too large: above 1e30 in SI",
            ),
            (
                "time [s],position [mm]\n0,\n",
                "2:3: `position` is ``: write a number; only `velocity` may be left empty",
            ),
        ] {
            assert_eq!(read_points(text).unwrap_err().to_string(), said, "{text}");
        }
        for (rows, said) in [
            (
                "0,0,0\n1,5,0\n\n1,7,0",
                "5:1: `time` is 0.001 s, not later than 0.001 s at the point before: sort the rows by time and give each \
                 a time of its own",
            ),
            (
                "0,0,0\n1,5",
                "3:1: a row of 2 values below a heading of 3: separate values by commas, with decimal points",
            ),
            (
                "0,0,0\n1,5,0,1",
                "3:1: a row of 4 values below a heading of 3: separate values by commas, with decimal points",
            ),
            (
                "0,0,0\n1;5;0",
                "3:1: a row of 1 values below a heading of 3: separate values by commas, with decimal points",
            ),
            ("0,0,0\n", "2:1: a table needs at least 2 points, this one has 1: add the point where the move ends"),
        ] {
            assert_eq!(read_points(&format!("{heading}{rows}")).unwrap_err().to_string(), said, "{rows}");
        }
    }

    #[test]
    fn a_table_of_absurd_length_is_refused() {
        let text = "time [ms],position [mm]\n0,0\n1,0\n2,0\n3,0";
        assert_eq!(read(text, 4).unwrap().times.len(), 4);
        assert_eq!(read(text, 3).unwrap_err(), wrong(5, 1, PointsMistake::TooMany { most: 3 }));
    }

    /// Columns count characters, not bytes, and a long cell does not fill the screen.
    #[test]
    fn places_are_those_of_an_editor() {
        let error = read_points(&format!("time [µs],position [µm]\n0,0\n µ,{}", "x".repeat(99))).unwrap_err();
        assert_eq!((error.line, error.column), (3, 2));
        let error = read_points(&format!("time [µs],position [µm]\n0,0\n1,{}", "x".repeat(99))).unwrap_err();
        assert!(error.to_string().chars().count() < 140, "{error}");
    }
}
