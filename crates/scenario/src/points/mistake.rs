//! What may be wrong with a table of points.
use super::Column;
use thiserror::Error;

/// What is wrong with a table of points, and where.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("{line}:{column}: {mistake}")]
pub struct PointsError {
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
    /// What is wrong there.
    pub mistake: PointsMistake,
}

/// What is wrong at a place of a table of points, with the way out.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum PointsMistake {
    /// There is nothing.
    #[error("the table is empty: begin with a heading like `{like}`")]
    NoHeading {
        /// A right one.
        like: &'static str,
    },
    /// Something else stands between the columns.
    #[error("columns are separated by commas, not by `{found}`: write `{like}`, numbers with a point")]
    Separator {
        /// What stands there.
        found: &'static str,
        /// A right heading.
        like: &'static str,
    },
    /// A column has a name that means nothing here.
    #[error("unknown column `{name}`: the heading is like `{like}`")]
    UnknownColumn {
        /// What stands there instead of a name.
        name: String,
        /// A right heading.
        like: &'static str,
    },
    /// A column has no unit.
    #[error("`{column}` needs its unit in brackets: write `{column} [{proposal}]`")]
    NoUnit {
        /// Which.
        column: Column,
        /// A unit that it might have.
        proposal: &'static str,
    },
    /// A column has no usable unit.
    #[error("`{column}` cannot be in `{unit}`: {message}")]
    Unit {
        /// Which column.
        column: Column,
        /// Its unit.
        unit: String,
        /// What is wrong with it, and what to write instead.
        message: String,
    },
    /// A column is there a second time.
    #[error("there are two columns `{column}`: delete one")]
    Twice {
        /// Which.
        column: Column,
    },
    /// Positions are said twice.
    #[error("`position` and `step` both say where the points are: delete one")]
    PositionAndStep,
    /// Steps add up to a position that is no more known well.
    #[error("the steps add up to more than 1e30 (SI): check them, and the unit in the heading")]
    TooFar,
    /// A column that every table needs is not there.
    #[error("the column `{column}` is missing: add `{column} [{proposal}]`")]
    Missing {
        /// Which.
        column: Column,
        /// A unit that it might have.
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
    /// A value is no number that can be used.
    #[error("`{column}` is `{text}`: {reason}")]
    Value {
        /// In which column.
        column: Column,
        /// What stands there.
        text: String,
        /// What is wrong with it.
        reason: &'static str,
    },
    /// A point is not later than the one before.
    #[error(
        "`time` is {time} s, not later than {before} s at the point before: sort the rows by time and give each a time \
         of its own"
    )]
    Order {
        /// Its time (s).
        time: f64,
        /// That of the point before (s).
        before: f64,
    },
    /// There is no way from one point to another.
    #[error("a table needs at least 2 points, this one has {points}: add the point where the move ends")]
    TooFew {
        /// Number of points.
        points: usize,
    },
    /// There are more points than anybody means.
    #[error("a table has at most {most} points: split it, or leave points out")]
    TooMany {
        /// The most that are read.
        most: usize,
    },
}
