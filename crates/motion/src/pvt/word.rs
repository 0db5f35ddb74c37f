//! Points and buffer commands as the drive takes them: parameter 0x115, a word of 16 bits and up to two values of 32.
//!
//! | bits of the word | point (bit 15 clear) | command (bit 15 set) |
//! |---|---|---|
//! | 0–7 | time to the next point (ms), 0 at the end | number of points to remove |
//! | 8 | reserved | 0: clear the buffer, 1: remove points |
//! | 9–11, 13–14 | reserved | reserved |
//! | 12 | position relative to the point before | reserved |
//!
//! The values behind the word of a point are its position (counts) and, unless it is approached linearly, its velocity
//! (0.1 counts/s).
use crate::PlanError;

const TIME: u16 = 0x00FF;
const REMOVE: u16 = 1 << 8;
const RELATIVE: u16 = 1 << 12;
const COMMAND: u16 = 1 << 15;

/// A point in the units of the drive.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct Point {
    /// Position (counts), or with `relative` the way from the point before; for the first point from the position at
    /// which the move is started.
    pub position: i32,
    /// Velocity (0.1 counts/s); without it the way to this point is linear.
    pub velocity: Option<i32>,
    /// Time to the next point (ms); 0 at the end of the move.
    pub time_ms: u8,
    /// Whether the position is relative.
    pub relative: bool,
}

/// What a master writes to the trajectory buffer of the drive.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Record {
    /// Add a point.
    Point(Point),
    /// Abort the move and clear the buffer.
    Clear,
    /// Remove so many of the points that were added last.
    Remove(u8),
}

/// A [`Record`] as it is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Words {
    word: u16,
    values: [i32; 2],
    count: usize,
}

impl Words {
    /// The word of 16 bits that comes first.
    #[must_use]
    pub const fn word(&self) -> u16 {
        self.word
    }

    /// The values that follow it.
    #[must_use]
    pub fn values(&self) -> &[i32] {
        &self.values[..self.count]
    }
}

impl Record {
    /// The words to write.
    #[must_use]
    pub fn encode(self) -> Words {
        match self {
            Self::Clear => Words { word: COMMAND, values: [0; 2], count: 0 },
            Self::Remove(number) => Words { word: COMMAND | REMOVE | u16::from(number), values: [0; 2], count: 0 },
            Self::Point(Point { position, velocity, time_ms, relative }) => Words {
                word: u16::from(time_ms) | if relative { RELATIVE } else { 0 },
                values: [position, velocity.unwrap_or(0)],
                count: 1 + usize::from(velocity.is_some()),
            },
        }
    }

    /// The record that `word` and the `values` behind it stand for; `point` is its number in an error.
    ///
    /// # Errors
    /// [`PlanError::ReservedBits`], or [`PlanError::Point`] for a number of values that does not belong to the word.
    pub fn decode(point: usize, word: u16, values: &[i32]) -> Result<Self, PlanError> {
        let count =
            |bound, remedy| PlanError::Point { point, name: "values", value: values.len() as f64, bound, remedy };
        let data = (word & TIME).to_le_bytes()[0];
        let meaningful = match word & (COMMAND | REMOVE) {
            COMMAND => COMMAND,
            command if command & COMMAND != 0 => COMMAND | REMOVE | TIME,
            _ => RELATIVE | TIME,
        };
        if word & !meaningful != 0 {
            return Err(PlanError::ReservedBits { point, word, bits: word & !meaningful });
        }
        if word & COMMAND != 0 {
            return match values {
                [] if word & REMOVE != 0 => Ok(Self::Remove(data)),
                [] => Ok(Self::Clear),
                _ => Err(count("none behind a command", "send the command as a word of its own")),
            };
        }
        let (position, velocity) = match values {
            [position] => (*position, None),
            [position, velocity] => (*position, Some(*velocity)),
            _ => return Err(count("1 or 2", "send the position and, for a cubic approach, the velocity")),
        };
        Ok(Self::Point(Point { position, velocity, time_ms: data, relative: word & RELATIVE != 0 }))
    }
}
