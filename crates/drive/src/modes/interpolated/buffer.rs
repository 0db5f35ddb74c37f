//! The trajectory buffer: 32 points, their latched errors, and the status words for the master.
use servobench_base::Stateful;
use servobench_cia402::interpolated::{BufferError, CAPACITY, Point, SegmentCommand};
use thiserror::Error;

/// A point in the buffer, or a base from which the next relative one counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Stateful)]
pub(super) enum Entry {
    Point(Point),
    Base(i32),
}

/// Cause of a refused addition to the buffer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum Refusal {
    /// The buffer is full; latched.
    #[error(
        "the trajectory buffer holds {CAPACITY} points and is full: read the free count (2011h) before sending more"
    )]
    Full,
    /// A point is missing between the last one and this one; latched.
    #[error("the point has the integrity counter {got}, expected is {expected}: send again from the one that was lost")]
    OutOfSequence {
        /// Counter of the next point.
        expected: u8,
        /// Counter of this one.
        got: u8,
    },
    /// A point was lost before, and this one would not follow the last.
    #[error(
        "a point was lost before (errors {errors:#04x}): clear the errors and send again from the one that was lost"
    )]
    Latched {
        /// Latched errors, as in the highest byte of 2012h.
        errors: u8,
    },
}

/// The trajectory buffer. It outlives the moves: points are added before one is started, and while it is active.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Stateful)]
pub struct Buffer {
    entries: [Entry; CAPACITY],
    first: usize,
    count: usize,
    errors: u8,
    next_segment: u16,
    is_aborted: bool,
    is_started: bool,
}

impl Default for Buffer {
    fn default() -> Self {
        Self {
            entries: [Entry::Base(0); CAPACITY],
            first: 0,
            count: 0,
            errors: 0,
            next_segment: 0,
            is_aborted: false,
            is_started: false,
        }
    }
}

impl Buffer {
    /// Adds a point.
    ///
    /// # Errors
    /// [`Refusal`] if the buffer is full, which is latched, and after a lost point.
    pub fn add(&mut self, point: Point) -> Result<(), Refusal> {
        self.push(Entry::Point(point))
    }

    /// Executes a move segment command (2010h).
    ///
    /// # Errors
    /// [`Refusal`] of a point.
    pub fn apply(&mut self, command: SegmentCommand) -> Result<(), Refusal> {
        match command {
            SegmentCommand::Point { counter, point } => return self.push_numbered(counter, Entry::Point(point)),
            SegmentCommand::Base { counter, position } => return self.push_numbered(counter, Entry::Base(position)),
            SegmentCommand::Clear => self.clear(),
            SegmentCommand::Remove(number) => self.remove(number),
            SegmentCommand::ClearErrors(mask) => self.clear_errors(mask),
            SegmentCommand::ResetSegment => self.next_segment = 0,
            SegmentCommand::NoOperation => {}
        }
        Ok(())
    }

    fn push(&mut self, entry: Entry) -> Result<(), Refusal> {
        if self.has(BufferError::Sequence) || self.has(BufferError::Overflow) {
            return Err(Refusal::Latched { errors: self.errors });
        }
        if self.count == CAPACITY {
            self.latch(BufferError::Overflow);
            return Err(Refusal::Full);
        }
        self.entries[(self.first + self.count) % CAPACITY] = entry;
        self.count += 1;
        self.next_segment = self.next_segment.wrapping_add(1);
        Ok(())
    }

    /// Adds an entry, checked by the lowest three bits of its number.
    fn push_numbered(&mut self, counter: u8, entry: Entry) -> Result<(), Refusal> {
        let expected = self.next_segment.to_le_bytes()[0] & 7;
        if counter != expected && self.errors & BufferError::Overflow as u8 == 0 {
            self.latch(BufferError::Sequence);
            return Err(Refusal::OutOfSequence { expected, got: counter });
        }
        self.push(entry)
    }

    /// Empties the buffer and aborts an active move. Errors stay latched.
    pub fn clear(&mut self) {
        self.flush();
        self.is_aborted = true;
    }

    /// Removes the last `number` points, or all if there are fewer. The move continues with the rest.
    pub fn remove(&mut self, number: u8) {
        self.count = self.count.saturating_sub(number.into());
    }

    /// Clears the latched errors whose bits are set in `mask`, as in the highest byte of 2012h.
    pub const fn clear_errors(&mut self, mask: u8) {
        self.errors &= !mask;
    }

    /// Free places (2011h).
    #[must_use]
    pub const fn free(&self) -> usize {
        CAPACITY - self.count
    }

    /// True if the error is latched.
    #[must_use]
    pub const fn has(&self, error: BufferError) -> bool {
        self.errors & error as u8 != 0
    }

    /// Expected number of the next segment (2013h).
    #[must_use]
    pub const fn next_segment(&self) -> u16 {
        self.next_segment
    }

    /// Status word (2012h).
    ///
    /// | bits | |
    /// |---|---|
    /// | 0–15 | expected number of the next segment |
    /// | 16–23 | free places |
    /// | 24, 25, 26 | sequence error, overflow, underflow |
    /// | 31 | empty |
    #[must_use]
    pub fn status(&self) -> u32 {
        let [low, high] = self.next_segment.to_le_bytes();
        let free = u8::try_from(self.free()).unwrap_or(u8::MAX);
        u32::from_le_bytes([low, high, free, self.errors | if self.count == 0 { 0x80 } else { 0 }])
    }

    pub(super) const fn errors(&self) -> u8 {
        self.errors
    }

    pub(super) const fn count(&self) -> usize {
        self.count
    }

    pub(super) fn latch(&mut self, error: BufferError) {
        self.errors |= error as u8;
    }

    pub(super) const fn flush(&mut self) {
        self.count = 0;
    }

    pub(super) fn pop(&mut self) -> Option<Entry> {
        (self.count > 0).then(|| {
            let entry = self.entries[self.first];
            self.first = (self.first + 1) % CAPACITY;
            self.count -= 1;
            entry
        })
    }

    /// Returns true once if the buffer was cleared since the last call.
    pub(super) const fn take_abort(&mut self) -> bool {
        core::mem::replace(&mut self.is_aborted, false)
    }

    /// Starts the move at the next step, as the start move command of the serial interface does.
    pub(super) const fn start(&mut self) {
        self.is_started = true;
    }

    pub(super) const fn take_start(&mut self) -> bool {
        core::mem::replace(&mut self.is_started, false)
    }
}
