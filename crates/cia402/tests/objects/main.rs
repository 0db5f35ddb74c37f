//! The object dictionary: what the table says, what is taken and what is refused, and what is written of it.

mod constraints;
mod refusals;
mod table;
mod values;

use servobench_cia402::units::Object;

/// The object at an index and sub-index.
pub(crate) const fn object(index: u16, subindex: u8) -> Object {
    Object { index, subindex }
}
