//! The object dictionary: its table against data sheets, and accepted and refused values.

mod constraints;
mod refusals;
mod table;
mod values;

use servobench_cia402::units::Object;

/// The object at an index and sub-index.
pub(crate) const fn object(index: u16, subindex: u8) -> Object {
    Object { index, subindex }
}
