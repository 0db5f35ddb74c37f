//! A table of flux linkages: a CSV file with a row for each pair of currents, in any order.
//!
//! ```text
//! i_d [Apk],i_q [Apk],psi_d [mV s],psi_q [mV s]
//! -20,0,121.9,0
//! ```
use crate::quantity::Scale;
use crate::reading::{self, ReadError, names};
use servobench_config::Physical;
use servobench_config::quantities::{CURRENT, FLUX_LINKAGE};
use servobench_files::{MOST_QUOTED, quoted};
use servobench_plant::pmsm::FluxData;
use std::collections::BTreeMap;
use thiserror::Error;

/// Columns with their quantity and a unit to propose.
const COLUMNS: [(&str, &Physical, &str); 4] = [
    ("i_d", &CURRENT, "Apk"),
    ("i_q", &CURRENT, "Apk"),
    ("psi_d", &FLUX_LINKAGE, "mV s"),
    ("psi_q", &FLUX_LINKAGE, "mV s"),
];
const LIKE: &str = "i_d [Apk],i_q [Apk],psi_d [mV s],psi_q [mV s]";
/// Largest number of rows.
const MOST_ROWS: usize = FluxData::MOST * FluxData::MOST;

/// A mistake in a table of flux linkages, with its place.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("{line}:{column}: {mistake}")]
pub struct FluxTableError {
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
    /// The mistake.
    pub mistake: FluxTableMistake,
}

/// Mistake in a table of flux linkages, with its correction.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum FluxTableMistake {
    /// The table is empty.
    #[error("the table is empty: begin with a heading like `{LIKE}`")]
    NoHeading,
    /// A column has an unknown name.
    #[error("unknown column `{name}`: the heading is like `{LIKE}`, its columns are separated by commas")]
    UnknownColumn {
        /// The name.
        name: String,
    },
    /// A column appears twice.
    #[error("there are two columns `{column}`: delete one")]
    Twice {
        /// The column.
        column: &'static str,
    },
    /// A column has no unit.
    #[error("`{column}` needs its unit in brackets: write `{column} [{proposal}]`")]
    NoUnit {
        /// The column.
        column: &'static str,
        /// A unit to propose.
        proposal: &'static str,
    },
    /// A column has a wrong unit.
    #[error("`{column}` cannot be in `{unit}`: {message}")]
    Unit {
        /// The column.
        column: &'static str,
        /// Its unit.
        unit: String,
        /// Reason.
        message: String,
    },
    /// A column is missing.
    #[error("the column `{column}` is missing: add `{column} [{proposal}]`")]
    Missing {
        /// The column.
        column: &'static str,
        /// A unit to propose.
        proposal: &'static str,
    },
    /// A row has more or fewer values than there are columns.
    #[error("the row has {found} values, the heading has 4 columns")]
    Width {
        /// Values of the row.
        found: usize,
    },
    /// A value is not a valid number.
    #[error("`{column}` is `{text}`: {reason}")]
    Value {
        /// The column.
        column: &'static str,
        /// The text of the value.
        text: String,
        /// Reason.
        reason: &'static str,
    },
    /// A pair of currents appears in two rows.
    #[error("the currents of this row are those of line {line}, too: delete one")]
    Again {
        /// Line of the first.
        line: usize,
    },
    /// There are too many rows.
    #[error("more than {MOST_ROWS} rows: leave out currents between which the flux linkages are nearly straight")]
    TooMany,
    /// A pair of currents has no row.
    #[error("missing row for i_d = {d} A and i_q = {q} A (peak): every i_d needs a row for every i_q")]
    Hole {
        /// i_d.
        d: f64,
        /// i_q.
        q: f64,
    },
}

use FluxTableMistake as Mistake;

/// Reads a table and sorts it by increasing currents.
///
/// # Errors
/// [`FluxTableError`] with the place and the mistake.
pub fn read_flux_table(text: &str) -> Result<FluxData, FluxTableError> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let mut rows = (1..).zip(text.lines()).filter(|(_, row)| !row.trim().is_empty());
    let (line, row) = rows.next().ok_or_else(|| wrong(1, 1, Mistake::NoHeading))?;
    let heads = heading(line, row)?;
    let mut points = BTreeMap::new();
    let mut last = line;
    for (line, row) in rows {
        if points.len() == MOST_ROWS {
            return Err(wrong(line, 1, Mistake::TooMany));
        }
        let [d, q, psi_d, psi_q] = values(&heads, line, row)?;
        if let Some((first, _)) = points.insert((Ordered(d), Ordered(q)), (line, [psi_d, psi_q])) {
            return Err(wrong(line, 1, Mistake::Again { line: first }));
        }
        last = line;
    }
    let (mut i_d, mut i_q): (Vec<Ordered>, Vec<Ordered>) = points.keys().copied().unzip();
    i_q.sort();
    i_d.dedup();
    i_q.dedup();
    for d in &i_d {
        for q in &i_q {
            if !points.contains_key(&(*d, *q)) {
                return Err(wrong(last, 1, Mistake::Hole { d: d.0, q: q.0 }));
            }
        }
    }
    Ok(FluxData {
        i_d: i_d.into_iter().map(|i| i.0).collect(),
        i_q: i_q.into_iter().map(|i| i.0).collect(),
        psi_d: points.values().map(|(_, psi)| psi[0]).collect(),
        psi_q: points.values().map(|(_, psi)| psi[1]).collect(),
    })
}

/// A finite number.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Ordered(f64);

impl Eq for Ordered {}

impl PartialOrd for Ordered {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Ordered {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.0.total_cmp(&other.0)
    }
}

/// Index into [`COLUMNS`], scale and factor of each column.
type Heads = [(usize, Scale, f64); 4];

const fn wrong(line: usize, column: usize, mistake: FluxTableMistake) -> FluxTableError {
    FluxTableError { line, column, mistake }
}

/// The cells of a row, each with the column in characters of its beginning.
fn cells(row: &str) -> impl Iterator<Item = (usize, &str)> {
    let mut next = 0;
    row.split(',').map(move |cell| {
        let begin = next + cell.len() - cell.trim_start().len();
        next += cell.len() + 1;
        (row[..begin].chars().count() + 1, cell.trim())
    })
}

fn heading(line: usize, row: &str) -> Result<Heads, FluxTableError> {
    let mut heads: Vec<(usize, Scale, f64)> = Vec::new();
    for (at, cell) in cells(row) {
        let fail = |mistake| wrong(line, at, mistake);
        let (name, unit) = match cell.split_once('[') {
            Some((name, rest)) => (name.trim_end(), rest.strip_suffix(']').map_or("", str::trim)),
            None => (cell, ""),
        };
        let Some(which) = COLUMNS.iter().position(|(column, ..)| *column == name) else {
            return Err(fail(Mistake::UnknownColumn { name: quoted(name).to_string() }));
        };
        let (column, physical, proposal) = COLUMNS[which];
        if heads.iter().any(|(other, ..)| *other == which) {
            return Err(fail(Mistake::Twice { column }));
        }
        if unit.is_empty() {
            return Err(fail(Mistake::NoUnit { column, proposal }));
        }
        let refuse = |message: String| fail(Mistake::Unit { column, unit: quoted(unit).to_string(), message });
        // A message about a mistake within the unit would quote all of it.
        if unit.chars().count() > MOST_QUOTED {
            return Err(refuse("no unit is that long".to_owned()));
        }
        let (scale, factor) = read_unit(unit, physical).map_err(refuse)?;
        heads.push((which, scale, factor));
    }
    for (which, (column, _, proposal)) in COLUMNS.into_iter().enumerate() {
        if !heads.iter().any(|(other, ..)| *other == which) {
            return Err(wrong(line, 1, Mistake::Missing { column, proposal }));
        }
    }
    let found = heads.len();
    heads.try_into().map_err(|_| wrong(line, 1, Mistake::Width { found }))
}

/// Scale of `unit`, and a further factor: from effective values to amplitudes.
fn read_unit(unit: &str, physical: &Physical) -> Result<(Scale, f64), String> {
    let with = |message: &str, help: &str| if help.is_empty() { message.into() } else { format!("{message}; {help}") };
    let candidates = [physical];
    let (_, one) = reading::read(&format!("1 {unit}"), &candidates).map_err(|error| match error {
        ReadError::NoQuantity(error) => with(&error.message, &error.help),
        ReadError::NoUnit => format!("{} has a unit", names(&candidates)),
        ReadError::OtherDimension { is, help } => {
            with(&format!("{} is needed, this is {is}", names(&candidates)), help)
        }
    })?;
    let scale = Scale::read(unit).map_err(|error| with(&error.message, &error.help))?;
    let own = scale.value("1").map_err(str::to_owned)?;
    Ok((scale, one / own))
}

fn values(heads: &Heads, line: usize, row: &str) -> Result<[f64; 4], FluxTableError> {
    let found = cells(row).count();
    if found != heads.len() {
        return Err(wrong(line, 1, Mistake::Width { found }));
    }
    let mut values = [0.0; 4];
    for ((which, scale, factor), (at, text)) in heads.iter().zip(cells(row)) {
        let value = number(scale, text).map_err(|reason| {
            let column = COLUMNS[*which].0;
            wrong(line, at, Mistake::Value { column, text: quoted(text).to_string(), reason })
        })?;
        // -0 becomes 0.
        values[*which] = factor * value + 0.0;
    }
    Ok(values)
}

/// The value (SI) of `text`.
fn number(scale: &Scale, text: &str) -> Result<f64, &'static str> {
    match text.parse::<f64>() {
        Ok(number) if number.is_finite() => scale.value(text),
        Ok(_) => Err("the number must be finite"),
        Err(_) => Err("write a number like `12.5`; its unit is in the heading"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const GOOD: &str = "i_q [Arms],i_d [Apk],psi_q [mV s],psi_d [V s]\n\
        0,-2,0,.1\n\n1,-2,20,.11\r\n2,-2,30,.12\n0,0,0,.2\n1,0,21,.21\n2,0,31,.22\n2,1,32,.32\n1,1,22,.31\n-0,1,0,.3\n";

    /// Oracle: by hand; the rows in any order, effective values as amplitudes.
    #[test]
    fn a_table_is_read_in_si_and_in_order() {
        let FluxData { i_d, i_q, psi_d, psi_q } = read_flux_table(GOOD).unwrap();
        assert_eq!(i_d, [-2.0, 0.0, 1.0]);
        assert!(i_q.iter().zip([0.0, 2.0_f64.sqrt(), 8.0_f64.sqrt()]).all(|(a, b)| (a - b).abs() < 1e-15), "{i_q:?}");
        assert_eq!(psi_d, [0.1, 0.11, 0.12, 0.2, 0.21, 0.22, 0.3, 0.31, 0.32]);
        assert_eq!(psi_q, [0.0, 0.02, 0.03, 0.0, 0.021, 0.031, 0.0, 0.022, 0.032]);
    }

    #[test]
    fn what_is_wrong_is_told_with_its_place() {
        for (from, to, expected) in [
            (GOOD, "", "1:1: the table is empty"),
            ("psi_q [mV s]", "psi_q [mV s];i", "1:22: `psi_q` needs its unit in brackets: write `psi_q [mV s]`"),
            ("psi_q", "flux_q", "1:22: unknown column `flux_q`"),
            ("i_q [Arms]", "i_q [A]", "1:1: `i_q` cannot be in `A`: a current (Arms or Apk) is needed"),
            ("i_q [Arms]", "i_q", "1:1: `i_q` needs its unit in brackets: write `i_q [Apk]`"),
            ("i_q [Arms]", "i_d [Arms]", "1:12: there are two columns `i_d`: delete one"),
            (",psi_d [V s]", "", "1:1: the column `psi_d` is missing"),
            ("psi_d [V s]", "psi_d [V]", "`psi_d` cannot be in `V`"),
            ("1,-2,20,.11", "1,-2,20", "4:1: the row has 3 values, the heading has 4 columns"),
            ("1,-2,20,.11", "1,-2,x,.11", "4:6: `psi_q` is `x`: write a number like `12.5`"),
            ("1,-2,20,.11", "1,-2,nan,.11", "the number must be finite"),
            ("1,-2,20,.11", "1,-2,1e40,.11", "the number is too large"),
            ("1,-2,20,.11", "0,-2,20,.11", "4:1: the currents of this row are those of line 2, too"),
            ("1,-2,20,.11", "", "missing row for i_d = -2 A and i_q = 1.41"),
        ] {
            let said = read_flux_table(&GOOD.replacen(from, to, 1)).unwrap_err().to_string();
            assert!(said.contains(expected), "{to}: {said}");
        }
        let rows: Vec<String> = (0..5000).map(|n| format!("{n},0,0,0")).collect();
        let long = format!("{LIKE}\n{}", rows.join("\n"));
        assert!(read_flux_table(&long).unwrap_err().to_string().contains("more than 4225 rows"));
    }
}
