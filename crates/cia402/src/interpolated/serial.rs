//! Points over the serial interface of a drive: parameter 115h of the trajectory buffer, a word of 16 bits and up to two values of 32.
//!
//! | bits of the word | point (bit 15 clear) | command (bit 15 set) |
//! |---|---|---|
//! | 0–7 | time to the next point (ms), 0 at the end | number of points to remove |
//! | 8 | reserved | 0: clear the buffer, 1: remove points |
//! | 9–11, 13–14 | reserved | reserved |
//! | 12 | position relative to the previous point | reserved |
//!
//! The values behind the word of a point are its position (counts) and, unless it is approached linearly, its velocity
//! (0.1 counts/s). Before a move the trajectory mode (C8h) is written; op-code 17 starts the move.
//!
//! Source: Copley Controls, *PVT Trajectory Calculations*, rev. 00 (2020), "PVT moves via binary serial".
use super::Point;
use servobench_base::Stateful;
use thiserror::Error;

/// Parameter of the trajectory buffer.
pub const TRAJECTORY_BUFFER: u16 = 0x115;
/// Parameter of the trajectory mode.
pub const TRAJECTORY_MODE: u16 = 0xC8;
/// Trajectory mode PVT.
pub const PVT: u16 = 3;
/// Start move command.
pub const START_MOVE: u8 = 17;

const TIME: u16 = 0x00FF;
const REMOVE: u16 = 1 << 8;
const RELATIVE: u16 = 1 << 12;
const COMMAND: u16 = 1 << 15;

/// Content of a write to the trajectory buffer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Record {
    /// Add a point.
    Point(Point),
    /// Abort the move and clear the buffer.
    Clear,
    /// Remove this number of points, the last added first.
    Remove(u8),
}

/// Content of a write to a parameter: a word and the values behind it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Stateful)]
pub struct Words {
    word: u16,
    values: [i32; 2],
    count: usize,
}

/// A message to the serial interface.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Stateful)]
pub enum Message {
    /// Writes a parameter.
    Write {
        /// Parameter.
        parameter: u16,
        /// Content.
        words: Words,
    },
    /// Gives a command.
    Command {
        /// Op-code.
        op_code: u8,
    },
}

/// Words that are not a record.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum RecordError {
    /// A word with reserved bits.
    #[error("bits {bits:#06x} of the word {word:#06x} are reserved: send them as zero")]
    ReservedBits {
        /// The word as received.
        word: u16,
        /// Reserved bits that are set.
        bits: u16,
    },
    /// Values behind a command.
    #[error("`values` must be none behind a command, got {values}: send the command as a separate word")]
    BehindCommand {
        /// Number of values.
        values: usize,
    },
    /// A wrong number of values for a point.
    #[error("`values` must be 1 or 2, got {values}: send the position and, for a cubic approach, the velocity")]
    OfPoint {
        /// Number of values.
        values: usize,
    },
}

impl Words {
    /// A word without values.
    const fn alone(word: u16) -> Self {
        Self { word, values: [0; 2], count: 0 }
    }

    /// First word, of 16 bits.
    #[must_use]
    pub const fn word(&self) -> u16 {
        self.word
    }

    /// Values behind the word.
    #[must_use]
    pub fn values(&self) -> &[i32] {
        &self.values[..self.count]
    }
}

impl Message {
    /// Selects the trajectory mode PVT.
    pub const SELECT_PVT: Self = Self::Write { parameter: TRAJECTORY_MODE, words: Words::alone(PVT) };
    /// Starts the move.
    pub const START_MOVE: Self = Self::Command { op_code: START_MOVE };

    /// Writes `record` to the trajectory buffer; `None` if [`Record::encode`] cannot encode it.
    #[must_use]
    pub fn of(record: Record) -> Option<Self> {
        record.encode().map(|words| Self::Write { parameter: TRAJECTORY_BUFFER, words })
    }
}

impl Record {
    /// Encodes the record; `None` for a point whose time is not 0 to 255 whole milliseconds.
    #[must_use]
    pub fn encode(self) -> Option<Words> {
        Some(match self {
            Self::Clear => Words::alone(COMMAND),
            Self::Remove(number) => Words::alone(COMMAND | REMOVE | u16::from(number)),
            Self::Point(point) => Words {
                word: u16::from(point.milliseconds()?) | if point.is_relative { RELATIVE } else { 0 },
                values: [point.position, point.velocity.unwrap_or(0)],
                count: 1 + usize::from(point.velocity.is_some()),
            },
        })
    }

    /// Decodes `word` and the `values` behind it.
    ///
    /// # Errors
    /// [`RecordError`] names the reserved bits that are set, or a number of values that does not belong to the word.
    pub const fn decode(word: u16, values: &[i32]) -> Result<Self, RecordError> {
        let [data, _] = word.to_le_bytes();
        let meaningful = match word & (COMMAND | REMOVE) {
            COMMAND => COMMAND,
            command if command & COMMAND != 0 => COMMAND | REMOVE | TIME,
            _ => RELATIVE | TIME,
        };
        if word & !meaningful != 0 {
            return Err(RecordError::ReservedBits { word, bits: word & !meaningful });
        }
        if word & COMMAND != 0 {
            return match values {
                [] if word & REMOVE != 0 => Ok(Self::Remove(data)),
                [] => Ok(Self::Clear),
                _ => Err(RecordError::BehindCommand { values: values.len() }),
            };
        }
        let (position, velocity) = match values {
            [position] => (*position, None),
            [position, velocity] => (*position, Some(*velocity)),
            _ => return Err(RecordError::OfPoint { values: values.len() }),
        };
        let time = data as u32 * 1000;
        Ok(Self::Point(Point { position, is_relative: word & RELATIVE != 0, velocity, time }))
    }
}
