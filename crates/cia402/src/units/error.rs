//! Refused factors, counts and positions.
use core::fmt;

use thiserror::Error;

/// Index and sub-index in the object dictionary.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Object {
    /// Index, such as 6091h.
    pub index: u16,
    /// Sub-index, 00h for a plain variable.
    pub subindex: u8,
}

impl fmt::Display for Object {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:04X}h:{:02X}h", self.index, self.subindex)
    }
}

/// A refused factor, reading or position, with what would be accepted.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum UnitError {
    /// An object of the factor group that is zero.
    #[error("`{name}` ({object}) must be at least 1, got 0: write the ratio of the axis, or 1 if there is none")]
    ZeroFactor {
        /// The object.
        object: Object,
        /// Name of the object in the standard.
        name: &'static str,
    },
    /// A part of a ratio that is not positive.
    #[error("`{name}` must be at least 1, got {value}: give the sign by the polarity (607Eh)")]
    NotPositive {
        /// Numerator or denominator.
        name: &'static str,
        /// Rejected value.
        value: i64,
    },
    /// A polarity with a reserved bit.
    #[error("polarity (607Eh:00h) must have no bits but 7, 6 and 5, got {polarity:#04x}: clear bits {reserved:#04x}")]
    ReservedPolarity {
        /// Byte as written.
        polarity: u8,
        /// Reserved bits that are set.
        reserved: u8,
    },
    /// A product of ratios whose reduced numerator or denominator is too large to be stored.
    #[error(
        "`{name}` needs a numerator or denominator of {value} when reduced, at most {highest} is kept: choose factors \
         that have more in common, or a coarser unit"
    )]
    RatioTooLarge {
        /// Name of the product.
        name: &'static str,
        /// The larger one of numerator and denominator, reduced.
        value: u128,
        /// Largest one that can be stored.
        highest: i64,
    },
    /// Counts that overflow in the conversion.
    #[error(
        "{value} counts cannot be multiplied by {numerator} within 127 bits: wrap the position into its counter first"
    )]
    CountOverflow {
        /// Counts to be converted.
        value: i128,
        /// Numerator of the ratio, or of its product with the time.
        numerator: i128,
    },
    /// A position or velocity that is NaN or too far for the counts.
    #[error("`{name}` must be finite and at most {highest:e} in magnitude (SI), got {value:e}: correct it or its unit")]
    NotCountable {
        /// Field name.
        name: &'static str,
        /// Rejected value (SI).
        value: f64,
        /// Magnitude at which the counts overflow (SI).
        highest: f64,
    },
    /// A counter too narrow or too wide.
    #[error("a position counter must have 8 to 64 bits, got {bits}: take the width of the drive's counter")]
    CounterWidth {
        /// Requested width (bit).
        bits: u32,
    },
    /// A reading outside the range of the counter.
    #[error(
        "a {bits}-bit counter shows {lowest} to {highest}, got {reading}: check its width and whether it is signed"
    )]
    OutsideCounter {
        /// Width (bit).
        bits: u32,
        /// Lowest reading.
        lowest: i128,
        /// Highest reading.
        highest: i128,
        /// Rejected reading.
        reading: i128,
    },
    /// Two readings so far apart that the direction between them is ambiguous.
    #[error(
        "the counter went from {from} to {to}, {step} counts by the shorter distance, at most {largest_step} determine the \
         direction: read it more often, take a wider counter or start again from a known position"
    )]
    StepTooLong {
        /// Reading before.
        from: i128,
        /// Reading after.
        to: i128,
        /// Difference in the shortest direction (counts).
        step: i128,
        /// Largest step accepted (counts).
        largest_step: i128,
    },
}
