//! Helpers for the tests of several crates; only tests and benchmarks depend on it.
//!
//! - [`Random`]: seeded random numbers, the same in every run.
//! - [`CountingAllocator`]: number and size of a thread's allocations.
//!
//! ```
//! use servobench_testkit::{CountingAllocator, Random};
//! #[global_allocator]
//! static ALLOCATOR: CountingAllocator = CountingAllocator;
//!
//! let mut random = Random::seeded(1);
//! let before = CountingAllocator::count();
//! let value = random.unit();
//! assert_eq!(CountingAllocator::count(), before, "no allocation for {value}");
//! ```
mod allocation;
mod random;

pub use allocation::CountingAllocator;
pub use random::Random;
