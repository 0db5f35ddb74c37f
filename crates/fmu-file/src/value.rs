//! Start values.
use crate::bits;
use serde::{Deserialize, Serialize};

/// A start value.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Value {
    /// For numbers of any type that can hold it, in the unit of the variable.
    Number(#[serde(with = "bits::float")] f64),
    /// For numbers, with a separate unit; `fmi::Setup` takes it after conversion. It may also be a mere text.
    Quantity {
        /// The original text.
        text: String,
        /// In SI units.
        #[serde(with = "bits::float")]
        si: f64,
        /// Exponents of kilogram, metre, second and ampere in its unit.
        exponents: [i32; 4],
    },
    /// For integers that are too long for a `f64`, and all others.
    Integer(#[serde(with = "bits::integer")] i128),
    /// For booleans.
    Boolean(bool),
    /// For texts, and for enumerations by the name of the item.
    Text(String),
    /// For binaries.
    Binary(Vec<u8>),
    /// For arrays, element by element in row-major order; may be nested. Other values stand for all elements.
    List(Vec<Value>),
}
