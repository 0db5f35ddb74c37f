//! What tests of several crates need; nothing but tests and benchmarks depends on it.
//!
//! - [`Random`]: seeded random numbers, the same in every run.
//! - [`CountingAllocator`]: how often and how much a thread allocates.
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
