//! Velocity from differences of positions, for a drive that gives none.
//!
//! ```text
//! v[k] = (x[k] − x[k−m])/(m·cycle time)
//! ```
//!
//! One count of position is `1/(m·cycle time)` counts per second of velocity: m cycles resolve m times finer and lag by
//! half of them. The difference itself is exact.
use crate::units::UnitError;

/// Increments passed in a time, a velocity not rounded yet.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Displacement {
    increments: i128,
    nanoseconds: u64,
}

impl Displacement {
    /// Difference of positions (increments).
    #[must_use]
    pub const fn increments(self) -> i128 {
        self.increments
    }

    /// Time that it took (ns), at least 1.
    #[must_use]
    pub const fn nanoseconds(self) -> u64 {
        self.nanoseconds
    }

    /// Velocity (increments/s).
    #[must_use]
    pub fn increments_per_second(self) -> f64 {
        self.increments as f64 * 1e9 / self.nanoseconds as f64
    }
}

/// The difference over the last `CYCLES` cycles, over fewer while there are fewer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Difference<const CYCLES: usize> {
    cycle_time: u32,
    /// The last positions (increments), the oldest one at `oldest`.
    positions: [i128; CYCLES],
    oldest: usize,
    cycles: u32,
}

impl<const CYCLES: usize> Difference<CYCLES> {
    /// Starts at rest at a position, with the time between two positions (ns).
    ///
    /// # Errors
    /// [`UnitError::ZeroCycleTime`] if that is zero.
    pub const fn new(cycle_time: u32, position: i128) -> Result<Self, UnitError> {
        const { assert!(CYCLES >= 1 && CYCLES <= u32::MAX as usize, "a difference takes at least one cycle") };
        if cycle_time == 0 {
            return Err(UnitError::ZeroCycleTime);
        }
        Ok(Self { cycle_time, positions: [position; CYCLES], oldest: 0, cycles: 0 })
    }

    /// The difference up to the position of the next cycle.
    #[must_use]
    pub fn follow(&mut self, position: i128) -> Displacement {
        let before = core::mem::replace(&mut self.positions[self.oldest], position);
        self.oldest = (self.oldest + 1) % CYCLES;
        if (self.cycles as usize) < CYCLES {
            self.cycles += 1;
        }
        Displacement {
            increments: position.wrapping_sub(before),
            nanoseconds: u64::from(self.cycle_time) * u64::from(self.cycles),
        }
    }
}
