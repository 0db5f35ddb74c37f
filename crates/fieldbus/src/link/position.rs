//! Position of the axis, by a counter that wraps.
use super::units::{Scale, reading};
use servobench_base::Stateful;
use servobench_cia402::Actuals;
use servobench_cia402::counter::Unwrapped;
use servobench_cia402::units::UnitError;

/// Number of cycles over which a difference is taken: the coarser the counter, the longer it should be.
const SPAN: usize = 4;

/// A reading of the actual position and of the position that the drive's loops follow (counts).
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
struct Reading {
    actual: i128,
    followed: i128,
    /// Time of reception (base ticks).
    at: u64,
}

/// Position and velocity from one reading to the next.
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub(crate) struct Position {
    unwrapped: Unwrapped,
    counts: i128,
    /// The last readings, the oldest at `oldest`.
    readings: [Reading; SPAN],
    oldest: usize,
    counts_per_tick: f64,
    followed_per_tick: f64,
}

impl Position {
    /// Position at rest at the reading of the counter, in `actuals` that were received at `now`.
    pub(crate) fn start(scale: &Scale, actuals: &Actuals, now: u64) -> Result<Self, UnitError> {
        let unwrapped = Unwrapped::new(scale.counter(), reading(scale.counter(), actuals))?;
        Ok(Self::at(unwrapped, scale, actuals, now))
    }

    /// Position at rest near `counts`, consistent with the counter: after homing.
    pub(crate) fn near(scale: &Scale, counts: i64, actuals: &Actuals, now: u64) -> Result<Self, UnitError> {
        let counter = scale.counter();
        let mut unwrapped = Unwrapped::new(counter, counter.wrap(counts.into()))?.at(counts);
        unwrapped.follow(reading(scale.counter(), actuals))?;
        Ok(Self::at(unwrapped, scale, actuals, now))
    }

    fn at(unwrapped: Unwrapped, scale: &Scale, actuals: &Actuals, now: u64) -> Self {
        let counts = unwrapped.position();
        let followed = counts + scale.ahead(actuals);
        let readings = [Reading { actual: counts, followed, at: now }; SPAN];
        Self { unwrapped, counts, readings, oldest: 0, counts_per_tick: 0.0, followed_per_tick: 0.0 }
    }

    /// Takes the next reading. Over lost frames a velocity is their mean.
    pub(crate) fn follow(&mut self, scale: &Scale, actuals: &Actuals, now: u64) -> Result<(), UnitError> {
        self.counts = self.unwrapped.follow(reading(scale.counter(), actuals))?;
        let followed = self.counts + scale.ahead(actuals);
        let reading = Reading { actual: self.counts, followed, at: now };
        let before = core::mem::replace(&mut self.readings[self.oldest], reading);
        self.oldest = (self.oldest + 1) % SPAN;
        if now > before.at {
            let ticks = (now - before.at) as f64;
            self.counts_per_tick = (reading.actual - before.actual) as f64 / ticks;
            self.followed_per_tick = (reading.followed - before.followed) as f64 / ticks;
        }
        Ok(())
    }

    /// Counts since the counter's zero, wraps included.
    pub(crate) const fn counts(&self) -> i128 {
        self.counts
    }

    /// Velocity of the position that the drive's loops follow (counts per base tick); `None` if they follow no position, or one that always
    /// equals the actual count.
    pub(crate) fn followed_per_tick(&self) -> Option<f64> {
        let follows = self.readings.iter().any(|reading| reading.actual != reading.followed);
        follows.then_some(self.followed_per_tick)
    }

    /// Velocity (counts per base tick).
    pub(crate) const fn counts_per_tick(&self) -> f64 {
        self.counts_per_tick
    }
}
