//! Mistakes in a table of points.
use super::Column;
use thiserror::Error;

/// A mistake in a table of points, with its place.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("{line}:{column}: {mistake}")]
pub struct PointsError {
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
    /// The mistake.
    pub mistake: PointsMistake,
}

/// Mistake in a table of points, with its correction.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum PointsMistake {
    /// The table is empty.
    #[error("the table is empty: begin with a heading like `{like}`")]
    NoHeading {
        /// A valid heading.
        like: &'static str,
    },
    /// The columns are not separated by commas.
    #[error("columns are separated by commas, not by `{found}`: write `{like}`, numbers with a point")]
    Separator {
        /// The separator found.
        found: &'static str,
        /// A valid heading.
        like: &'static str,
    },
    /// A column has an unknown name.
    #[error("unknown column `{name}`: the heading is like `{like}`")]
    UnknownColumn {
        /// The text found in place of a name.
        name: String,
        /// A valid heading.
        like: &'static str,
    },
    /// A column has no unit.
    #[error("`{column}` needs its unit in brackets: write `{column} [{proposal}]`")]
    NoUnit {
        /// The column.
        column: Column,
        /// A unit to propose.
        proposal: &'static str,
    },
    /// A column has no usable unit.
    #[error("`{column}` cannot be in `{unit}`: {message}")]
    Unit {
        /// The column.
        column: Column,
        /// Its unit.
        unit: String,
        /// Reason and correction.
        message: String,
    },
    /// A column appears twice.
    #[error("there are two columns `{column}`: delete one")]
    Twice {
        /// The column.
        column: Column,
    },
    /// Positions are given twice.
    #[error("`position` and `step` both give the positions of the points: delete one")]
    PositionAndStep,
    /// Steps add up to a position that has lost its precision.
    #[error("the steps add up to more than 1e30 (SI): check them, and the unit in the heading")]
    TooFar,
    /// A required column is missing.
    #[error("the column `{column}` is missing: add `{column} [{proposal}]`")]
    Missing {
        /// The column.
        column: Column,
        /// A unit to propose.
        proposal: &'static str,
    },
    /// A row has more or fewer values than the heading has columns.
    #[error("a row of {found} values below a heading of {expected}: separate values by commas, with decimal points")]
    Width {
        /// Values in the row.
        found: usize,
        /// Columns in the heading.
        expected: usize,
    },
    /// A value is not a usable number.
    #[error("`{column}` is `{text}`: {reason}")]
    Value {
        /// The column.
        column: Column,
        /// The text of the value.
        text: String,
        /// Reason.
        reason: &'static str,
    },
    /// A point is not later than the previous one.
    #[error(
        "`time` is {time} s, not later than {before} s at the point before: sort the rows by time and give each a different time"
    )]
    Order {
        /// Time of the point (s).
        time: f64,
        /// Time of the previous point (s).
        before: f64,
    },
    /// A single point is not a move.
    #[error("a table needs at least 2 points, this one has {points}: add the point where the move ends")]
    TooFew {
        /// Number of points.
        points: usize,
    },
    /// There are more points than intended.
    #[error("a table has at most {most} points: split it, or leave points out")]
    TooMany {
        /// Largest number of points.
        most: usize,
    },
}
