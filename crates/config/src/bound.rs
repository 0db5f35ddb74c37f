//! Bounds of physical quantities.
use crate::physical::Kind;
use crate::quantities::RATIO;
use core::fmt;

/// Bound of a physical quantity (SI).
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Bound {
    /// Above zero.
    Positive,
    /// Zero or more.
    NotNegative,
    /// Any value.
    Any,
    /// Between these values, both included.
    Within(f64, f64),
}

impl Bound {
    /// True if `value` is within the bound.
    #[must_use]
    pub fn holds(self, value: f64) -> bool {
        match self {
            Self::Positive => value > 0.0,
            Self::NotNegative => value >= 0.0,
            Self::Any => true,
            Self::Within(low, high) => (low..=high).contains(&value),
        }
    }
}

/// Completes the sentence "must be …".
impl fmt::Display for Bound {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Positive => f.write_str("above zero"),
            Self::NotNegative => f.write_str("zero or more"),
            Self::Any => f.write_str("any"),
            Self::Within(low, high) => write!(f, "from {low} to {high}"),
        }
    }
}

/// Requirements on a physical parameter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Measure {
    /// Quantity that it measures.
    pub kind: Kind,
    /// Its bound.
    pub bound: Bound,
    /// A value as written by users.
    pub example: &'static str,
}

/// Above zero.
#[must_use]
pub const fn positive(kind: Kind, example: &'static str) -> Measure {
    Measure { kind, bound: Bound::Positive, example }
}

/// Zero or more.
#[must_use]
pub const fn not_negative(kind: Kind, example: &'static str) -> Measure {
    Measure { kind, bound: Bound::NotNegative, example }
}

/// Any value.
#[must_use]
pub const fn any(kind: Kind, example: &'static str) -> Measure {
    Measure { kind, bound: Bound::Any, example }
}

impl Measure {
    /// True for a pure number, which needs no unit.
    #[must_use]
    pub fn is_ratio(&self) -> bool {
        self.kind == Kind::Plain(&RATIO)
    }
}
