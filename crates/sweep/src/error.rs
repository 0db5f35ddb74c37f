//! Errors of sweeps.
use thiserror::Error;

/// Reason why a sweep is not valid.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum SweepError {
    /// A number that is not finite.
    #[error("`{key}`: {what} is {value}, and must be finite")]
    NotFinite {
        /// The key that varies.
        key: String,
        /// Name of the number.
        what: &'static str,
        /// Its value.
        value: f64,
    },
    /// A range on a logarithmic scale that has no logarithm.
    #[error(
        "`{key}`: a scale from {from} to {to} cannot be logarithmic; both ends must have the same sign, and neither may be 0"
    )]
    NoLogarithm {
        /// The key that varies.
        key: String,
        /// Start of the range.
        from: f64,
        /// End of the range.
        to: f64,
    },
    /// A range with fewer than two values.
    #[error("`{key}`: a range needs at least 2 values, `count` is {count}; write a single one in `values`")]
    TooFew {
        /// The key that varies.
        key: String,
        /// Requested number of values.
        count: usize,
    },
    /// A key without values.
    #[error("`{key}` has no values to take")]
    NoValues {
        /// The key that varies.
        key: String,
    },
    /// A key that appears twice.
    #[error("`{key}` varies twice; each key has one list, range or distribution")]
    Twice {
        /// The key that varies.
        key: String,
    },
    /// Keys that vary in parallel with different numbers of values.
    #[error(
        "`{key}` has {found} values and `{first}` {expected}: keys that vary side by side (`zip`) have the same number"
    )]
    UnequalLength {
        /// The first key.
        first: String,
        /// Its number of values.
        expected: usize,
        /// The one that differs.
        key: String,
        /// Its number of values.
        found: usize,
    },
    /// A distribution that is not valid.
    #[error("`{key}`: {reason}")]
    Distribution {
        /// The key that varies.
        key: String,
        /// Reason.
        reason: String,
    },
    /// Draws without a key, or with a count of zero.
    #[error("there is nothing to draw: {0}")]
    NothingDrawn(&'static str),
    /// Too many points.
    #[error("the sweep has more than {most} points; take fewer values, or draws in place of a grid")]
    TooMany {
        /// Largest number of points.
        most: usize,
    },
}
