//! The scenario file: schema, quantities with units, diagnostics with spans, look-up in `models/`.

mod scenario;

pub use scenario::*;
