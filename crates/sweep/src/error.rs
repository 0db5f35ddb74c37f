//! Why something cannot be varied.
use thiserror::Error;

/// Why something cannot be varied.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum SweepError {
    /// A number that is none.
    #[error("`{key}`: {what} is {value}, and must be finite")]
    NotFinite {
        /// The key that varies.
        key: String,
        /// Which number.
        what: &'static str,
        /// It.
        value: f64,
    },
    /// A range on a logarithmic scale that has no logarithm.
    #[error(
        "`{key}`: from {from} to {to} there is no logarithmic scale; both ends must have the same sign, and neither may be 0"
    )]
    NoLogarithm {
        /// The key that varies.
        key: String,
        /// Where the range begins.
        from: f64,
        /// Where it ends.
        to: f64,
    },
    /// A range of no value, or of one that would have to be both ends.
    #[error("`{key}`: a range needs at least 2 values, `count` is {count}; a single one stands in `values`")]
    TooFew {
        /// The key that varies.
        key: String,
        /// Values that the range is to have.
        count: usize,
    },
    /// A key without values.
    #[error("`{key}` has no values to take")]
    NoValues {
        /// The key that varies.
        key: String,
    },
    /// A key that varies twice.
    #[error("`{key}` varies twice; each key has one list, range or distribution")]
    Twice {
        /// The key that varies.
        key: String,
    },
    /// Keys that vary side by side and have different numbers of values.
    #[error(
        "`{key}` has {found} values and `{first}` {expected}: keys that vary side by side (`zip`) have the same number"
    )]
    UnequalLength {
        /// The first key.
        first: String,
        /// Values that it has.
        expected: usize,
        /// The one that differs.
        key: String,
        /// Values that that has.
        found: usize,
    },
    /// A distribution that is none.
    #[error("`{key}`: {reason}")]
    Distribution {
        /// The key that varies.
        key: String,
        /// What is wrong with it.
        reason: String,
    },
    /// Nothing is drawn, or drawn no times.
    #[error("there is nothing to draw: {0}")]
    NothingDrawn(&'static str),
    /// More points than can be told apart.
    #[error("the sweep has more than {most} points; take fewer values, or draws in place of a grid")]
    TooMany {
        /// Points, at most.
        most: usize,
    },
}
