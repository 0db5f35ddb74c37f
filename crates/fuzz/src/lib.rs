//! Fuzz targets as tests: a property that must hold for every input.
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
//! Structured input is composed of [`Number`], ranges, tuples, arrays and the values of [`produce`]:
//!
//! ```
//! use servobench_fuzz::{Number, ValueGenerator, check, fuzz};
//!
//! let pairs = (Number::any(), 1..10_u8).map_gen(|(number, times)| (number, number * f64::from(times)));
//! fuzz(check!(), 1_000, pairs, |(one, many): &(f64, f64)| assert!(one.is_nan() || one.abs() <= many.abs()));
//! ```
//! `cargo test` runs a target on the same seeded inputs each time, then on those that a fuzzer left. `SERVOBENCH_SWEEP=1000000` changes
//! the number of inputs. Built for libFuzzer (docs/testing.md), the same target is guided by coverage.

mod number;
mod seeded;
mod splice;
mod target;

pub use bolero::check;
pub use bolero::generator::{ValueGenerator, produce};
pub use number::Number;
pub use seeded::seeded;
pub use splice::{Splice, SplicedText};
pub use target::{Target, fuzz};
