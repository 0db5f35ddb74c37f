//! Where the axis is, by a counter that wraps.
use super::units::Scale;
use servobench_cia402::counter::Unwrapped;
use servobench_cia402::units::UnitError;

/// Cycles that a difference spans: the coarser the counter, the longer it should be.
const SPAN: usize = 4;

/// Position and velocity from one reading to the next.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Position {
    unwrapped: Unwrapped,
    counts: i64,
    /// The last readings with their ticks, the oldest at `oldest`.
    readings: [(i64, u64); SPAN],
    oldest: usize,
    counts_per_tick: f64,
}

impl Position {
    /// At rest where the counter shows.
    pub(crate) fn start(scale: &Scale, bits: i32, now: u64) -> Result<Self, UnitError> {
        let unwrapped = Unwrapped::new(scale.counter(), scale.reading(bits))?;
        Ok(Self::at(unwrapped, now))
    }

    /// At rest near `counts`, where the counter shows `bits`: after homing.
    pub(crate) fn near(scale: &Scale, counts: i64, bits: i32, now: u64) -> Result<Self, UnitError> {
        let counter = scale.counter();
        let mut unwrapped = Unwrapped::new(counter, counter.wrap(counts.into()))?.at(counts);
        unwrapped.follow(scale.reading(bits))?;
        Ok(Self::at(unwrapped, now))
    }

    fn at(unwrapped: Unwrapped, now: u64) -> Self {
        let counts = low_bits(unwrapped.position());
        Self { unwrapped, counts, readings: [(counts, now); SPAN], oldest: 0, counts_per_tick: 0.0 }
    }

    /// The next reading. Between frames that were lost the velocity is their mean.
    pub(crate) fn follow(&mut self, scale: &Scale, bits: i32, now: u64) -> Result<(), UnitError> {
        self.counts = low_bits(self.unwrapped.follow(scale.reading(bits))?);
        let (before, then) = core::mem::replace(&mut self.readings[self.oldest], (self.counts, now));
        self.oldest = (self.oldest + 1) % SPAN;
        if now > then {
            self.counts_per_tick = (self.counts - before) as f64 / (now - then) as f64;
        }
        Ok(())
    }

    /// Counts since the counter's zero, wraps included.
    pub(crate) const fn counts(&self) -> i64 {
        self.counts
    }

    /// Velocity (counts per base tick).
    pub(crate) const fn counts_per_tick(&self) -> f64 {
        self.counts_per_tick
    }
}

#[expect(clippy::cast_possible_truncation, reason = "2⁶³ counts are four thousand million turns of a 32-bit counter")]
const fn low_bits(position: i128) -> i64 {
    position as i64
}
