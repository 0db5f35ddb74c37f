//! Interpolated position: points that a master sends to the trajectory buffer of a drive, and their encodings.
//!
//! | by | format of a point | position | time to the next | velocity |
//! |---|---|---|---|---|
//! | 2010h, [`SegmentCommand`] | eight bytes in a frame | absolute or relative | individual, ms | 0.1 or 10 counts/s, 24 bits |
//! | 60C1h, sub-mode −3, [`InterpolationData`](crate::InterpolationData) | three sub-indices | absolute | individual, ms | 0.1 counts/s |
//! | 60C1h, −2 | two of them | absolute | individual, ms | – |
//! | 60C1h, −1 and 0 | one of them | absolute | 60C2h | – |
//! | 115h, [`serial`] | a word and two values | absolute or relative | individual, ms | 0.1 counts/s |
//!
//! 2010h and 115h omit the velocity if the segment to the point is a line; in the sub-modes without velocities every segment is.
//!
//! Sources: Copley Controls, *PVT Trajectory Calculations*, rev. 00 (2020); *CANopen Programmer's Manual*, 95-00271-000 rev. 7
//! (2012), pp. 209–218, 2010h to 2013h; IEC 61800-7-201, interpolated position mode.
mod segment_command;
use servobench_base::Stateful;
pub mod serial;
mod sub_mode;

pub use segment_command::{SegmentCommand, SegmentError};
pub use sub_mode::{SettingError, SubMode, TimePeriod};

/// Capacity of the trajectory buffer (points).
pub const CAPACITY: usize = 32;

/// A point of a move in the units of the drive.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Stateful)]
pub struct Point {
    /// Position (counts), or with `is_relative` the distance from the previous point; for the first point of a move from the position at
    /// which it is started.
    pub position: i32,
    /// True if the position is relative.
    pub is_relative: bool,
    /// Velocity (0.1 counts/s); without it the segment to this point is linear.
    pub velocity: Option<i32>,
    /// Time to the next point (µs); 0 at the end of the move.
    pub time: u32,
}

impl Point {
    /// Time in whole milliseconds, for encodings with individual times; `None` if it is not whole, or more than 255.
    #[must_use]
    pub fn milliseconds(&self) -> Option<u8> {
        u8::try_from(self.time / 1000).ok().filter(|_| self.time.is_multiple_of(1000))
    }
}

/// Latched error of the trajectory buffer, by its bit in the highest byte of its status (2012h).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[repr(u8)]
pub enum BufferError {
    /// A point came out of sequence, by its integrity counter.
    Sequence = 1,
    /// A point came when the buffer was full.
    Overflow = 2,
    /// The move needed a point that was missing.
    Underflow = 4,
}
