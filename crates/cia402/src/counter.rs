//! Position counters that wrap.
//!
//! A counter of N bits shows the position modulo 2^N. Of the distances between two readings the shortest is taken,
//!
//! ```text
//! step = ((to − from + 2^(N−1)) mod 2^N) − 2^(N−1),        position += step,
//! ```
//!
//! so no count is lost over any number of turns as long as every true step is shorter than half the range. A step of half the range has two
//! directions and is refused. A longer one looks like a shorter one in the opposite direction and cannot be detected.
//!
//! # Over the bus
//!
//! The position objects of CiA 402 have 32 bits. The reading of a wider counter takes two words: the lower half in the object, the upper
//! half in a manufacturer-specific one ([`Counter::words`]).
//!
//! ```
//! use servobench_cia402::counter::{Counter, Unwrapped};
//! let mut position = Unwrapped::new(Counter::signed(16)?, 32_767_i16)?;
//! assert_eq!(position.follow(-32_768_i16)?, 32_768);
//! # Ok::<(), servobench_cia402::units::UnitError>(())
//! ```
use crate::units::UnitError;
use servobench_base::Stateful;

/// The range of a position counter.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Stateful)]
pub struct Counter {
    bits: u32,
    signed: bool,
}

impl Counter {
    /// A counter of `bits` bits from −2^(bits−1) to 2^(bits−1) − 1, such as the position actual internal value (6063h)
    /// with 32.
    ///
    /// # Errors
    /// [`UnitError::CounterWidth`] unless `bits` is from 8 to 64.
    pub const fn signed(bits: u32) -> Result<Self, UnitError> {
        Self::of_width(bits, true)
    }

    /// A counter of `bits` bits from 0 to 2^bits − 1.
    ///
    /// # Errors
    /// As [`signed`](Self::signed).
    pub const fn unsigned(bits: u32) -> Result<Self, UnitError> {
        Self::of_width(bits, false)
    }

    const fn of_width(bits: u32, signed: bool) -> Result<Self, UnitError> {
        match bits {
            8..=64 => Ok(Self { bits, signed }),
            _ => Err(UnitError::CounterWidth { bits }),
        }
    }

    /// Number of readings, 2^N.
    #[must_use]
    pub const fn range(self) -> i128 {
        1 << self.bits
    }

    /// Lowest reading.
    #[must_use]
    pub const fn lowest(self) -> i128 {
        if self.signed { -self.range() / 2 } else { 0 }
    }

    /// Highest reading.
    #[must_use]
    pub const fn highest(self) -> i128 {
        self.lowest() + self.range() - 1
    }

    /// Reading of the counter at a position (counts).
    #[must_use]
    pub const fn wrap(self, position: i128) -> i128 {
        // The range is a power of two: its low bits are the remainder, of negative positions too.
        let remainder = position & (self.range() - 1);
        if remainder > self.highest() { remainder - self.range() } else { remainder }
    }

    /// Reading of the counter at a position (counts) as words of 32 bits, the lower one first; the words are those of an unsigned counter
    /// too. The upper one of a counter of 32 bits or fewer is 0.
    ///
    /// ```
    /// use servobench_cia402::counter::Counter;
    /// let wide = Counter::signed(64)?;
    /// assert_eq!(wide.words(-2), [-2, -1]);
    /// assert_eq!(wide.reading_of([-2, -1]), -2);
    /// # Ok::<(), servobench_cia402::units::UnitError>(())
    /// ```
    #[must_use]
    pub const fn words(self, position: i128) -> [i32; 2] {
        let shown = self.wrap(position);
        #[expect(clippy::cast_possible_truncation, reason = "the halves of 64 bits, as an unsigned counter uses them")]
        let [low, high] = [shown as i32, (shown >> 32) as i32];
        [low, if self.bits > 32 { high } else { 0 }]
    }

    /// Reading from [`words`](Self::words).
    #[must_use]
    pub const fn reading_of(self, [low, high]: [i32; 2]) -> i128 {
        match (self.bits > 32, self.signed) {
            (false, true) => low as i128,
            (false, false) => low.cast_unsigned() as i128,
            (true, true) => (high as i128) << 32 | low.cast_unsigned() as i128,
            (true, false) => (high.cast_unsigned() as i128) << 32 | low.cast_unsigned() as i128,
        }
    }

    /// Shortest distance from one reading to another, from −2^(N−1) to 2^(N−1) − 1 counts.
    const fn way(self, from: i128, to: i128) -> i128 {
        Self { bits: self.bits, signed: true }.wrap(to - from)
    }

    /// Position nearest to `position` with the same reading as `target`.
    #[must_use]
    pub const fn nearest(self, target: i128, position: i128) -> i128 {
        position + self.way(position, target)
    }

    fn reading(self, reading: i128) -> Result<i128, UnitError> {
        let (lowest, highest) = (self.lowest(), self.highest());
        if (lowest..=highest).contains(&reading) {
            Ok(reading)
        } else {
            Err(UnitError::OutsideCounter { bits: self.bits, lowest, highest, reading })
        }
    }
}

/// Absolute position, unwrapped from a counter.
///
/// 2⁶³ readings of the widest counter, each half the range further, stay within the 127 bits of the position.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Stateful)]
pub struct Unwrapped {
    counter: Counter,
    reading: i128,
    position: i128,
}

impl Unwrapped {
    /// Starts at the position of the reading.
    ///
    /// # Errors
    /// [`UnitError::OutsideCounter`] if the reading is outside the range of the counter.
    pub fn new(counter: Counter, reading: impl Into<i128>) -> Result<Self, UnitError> {
        let reading = counter.reading(reading.into())?;
        Ok(Self { counter, reading, position: reading })
    }

    /// Same counter at another position (counts), known from homing or from before.
    #[must_use]
    pub fn at(self, position: i64) -> Self {
        Self { position: position.into(), ..self }
    }

    /// Position (counts) at the next reading.
    ///
    /// # Errors
    /// [`UnitError::OutsideCounter`] if the reading is outside the range of the counter, [`UnitError::StepTooLong`] if the direction is
    /// ambiguous. Nothing changes then.
    pub fn follow(&mut self, reading: impl Into<i128>) -> Result<i128, UnitError> {
        let reading = self.counter.reading(reading.into())?;
        let step = self.counter.way(self.reading, reading);
        let largest_step = self.counter.range() / 2 - 1;
        if step.abs() > largest_step {
            let from = self.reading;
            return Err(UnitError::StepTooLong { from, to: reading, step, largest_step });
        }
        self.reading = reading;
        self.position += step;
        Ok(self.position)
    }

    /// The position at the last accepted reading (counts).
    #[must_use]
    pub const fn position(&self) -> i128 {
        self.position
    }
}
