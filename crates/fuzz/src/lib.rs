//! Fuzz targets as tests: a property that must hold whatever the input.
//!
//! ```
//! use servobench_fuzz::{Splice, check, fuzz};
//!
//! // In a function with `#[test]`, by whose name a fuzzer finds it:
//! let numbers = Splice::text(&["1.5e3", "-2"], &["nan", "inf", "_"]);
//! fuzz(check!(), 1_000, numbers, |text: &String| {
//!     assert!(text.parse::<f64>().is_err() || !text.contains('_'));
//! });
//! ```
//! `cargo test` runs a target on the same seeded inputs each time, then on those that a fuzzer left. Another number of
//! inputs: `SERVOBENCH_SWEEP=1000000`. With `cargo bolero test` the same target runs under libFuzzer, AFL or Honggfuzz.

mod seeded;
mod splice;
mod target;

pub use bolero::check;
pub use splice::{Splice, SplicedText};
pub use target::{Target, fuzz};
