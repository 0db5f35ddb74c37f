//! The IP move segment command (2010h): a point, or a command to the buffer, in eight bytes.
//!
//! | byte 0 | bytes 1–7, lowest byte first |
//! |---|---|
//! | bit 7 clear, bits 0–2 integrity counter, bits 3–6 format 0 | time (ms), position (24 bits), velocity (24 bits, 0.1 counts/s) |
//! | format 1 | the same, velocity in 10 counts/s |
//! | formats 2, 3 | like 0 and 1, with the position relative to the previous point |
//! | format 4 | position (32 bits), from which the next relative point counts; not a point itself |
//! | format 5 | time (ms), position (32 bits); the approach is linear |
//! | format 6 | the same, relative |
//! | 80h | clear the buffer and abort the move |
//! | 81h | byte 1: number of points to remove, the last added first |
//! | 82h | byte 1: clear the latched errors whose bits are set |
//! | 83h | number the next segment 0 |
//! | 84h | nothing |
//!
//! The integrity counter is the lowest three bits of the segment's number. Source: Copley Controls, *CANopen Programmer's Manual*,
//! 95-00271-000 rev. 7 (2012), pp. 214–215, "IP move segment command"; format 6 and command 84h from later editions.
use super::Point;
use thiserror::Error;

/// Content of 2010h.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SegmentCommand {
    /// Add a point whose time is whole milliseconds.
    Point {
        /// The lowest three bits of the segment's number.
        counter: u8,
        /// The point.
        point: Point,
    },
    /// Set the base of the next relative point.
    Base {
        /// The lowest three bits of the segment's number.
        counter: u8,
        /// Position (counts).
        position: i32,
    },
    /// Empty the buffer, abort the move.
    Clear,
    /// Remove this number of points, the last added first.
    Remove(u8),
    /// Clear the latched errors whose bits are set.
    ClearErrors(u8),
    /// Number the next segment 0.
    ResetSegment,
    /// Nothing.
    NoOperation,
}

/// Eight bytes that are not a command.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum SegmentError {
    /// A reserved format.
    #[error("byte 0 of the move segment command is {byte:#04x}: format {format} is reserved, formats 0 to 6 are known")]
    Format {
        /// Byte 0.
        byte: u8,
        /// Its bits 3 to 6.
        format: u8,
    },
    /// A reserved command.
    #[error(
        "byte 0 of the move segment command is {byte:#04x}: command {command} is reserved, commands 0 to 4 are known"
    )]
    Command {
        /// Byte 0.
        byte: u8,
        /// Its bits 0 to 6.
        command: u8,
    },
}

/// Number of fine velocity units in a coarse one.
const COARSE: i32 = 100;

impl SegmentCommand {
    /// Decodes `bytes`.
    ///
    /// # Errors
    /// [`SegmentError`] for reserved formats and commands.
    pub fn decode(bytes: [u8; 8]) -> Result<Self, SegmentError> {
        let [byte, one, two, three, four, five, six, seven] = bytes;
        let (format, counter) = (byte >> 3 & 0xF, byte & 7);
        if byte & 0x80 != 0 {
            return match byte & 0x7F {
                0 => Ok(Self::Clear),
                1 => Ok(Self::Remove(one)),
                2 => Ok(Self::ClearErrors(one)),
                3 => Ok(Self::ResetSegment),
                4 => Ok(Self::NoOperation),
                command => Err(SegmentError::Command { byte, command }),
            };
        }
        let (position, velocity) = match format {
            0..=3 => {
                let velocity = signed_24([five, six, seven]) * if format & 1 == 0 { 1 } else { COARSE };
                (signed_24([two, three, four]), Some(velocity))
            }
            4 => return Ok(Self::Base { counter, position: i32::from_le_bytes([one, two, three, four]) }),
            5 | 6 => (i32::from_le_bytes([two, three, four, five]), None),
            _ => return Err(SegmentError::Format { byte, format }),
        };
        let is_relative = matches!(format, 2 | 3 | 6);
        let time = u32::from(one) * 1000;
        Ok(Self::Point { counter, point: Point { position, is_relative, velocity, time } })
    }

    /// Encodes the command; `None` for a point that fits none of the formats: its time is not 0 to 255 whole milliseconds, or its position
    /// or velocity, for a point with a velocity, does not fit into 24 bits.
    #[must_use]
    pub fn encode(self) -> Option<[u8; 8]> {
        let command = |code: u8, data: u8| Some([0x80 | code, data, 0, 0, 0, 0, 0, 0]);
        match self {
            Self::Clear => command(0, 0),
            Self::Remove(number) => command(1, number),
            Self::ClearErrors(mask) => command(2, mask),
            Self::ResetSegment => command(3, 0),
            Self::NoOperation => command(4, 0),
            Self::Base { counter, position } => {
                let [a, b, c, d] = position.to_le_bytes();
                Some([counter & 7 | 4 << 3, a, b, c, d, 0, 0, 0])
            }
            Self::Point { counter, point } => {
                let Point { position, is_relative, velocity, .. } = point;
                let time = point.milliseconds()?;
                let byte = |format: u8| counter & 7 | format << 3;
                let Some(velocity) = velocity else {
                    let [a, b, c, d] = position.to_le_bytes();
                    return Some([byte(if is_relative { 6 } else { 5 }), time, a, b, c, d, 0, 0]);
                };
                let [a, b, c] = as_24(position)?;
                let (coarse, [d, e, f]) = match as_24(velocity) {
                    Some(fine) => (0, fine),
                    None => (1, as_24(velocity / COARSE).filter(|_| velocity % COARSE == 0)?),
                };
                Some([byte(if is_relative { 2 } else { 0 } | coarse), time, a, b, c, d, e, f])
            }
        }
    }
}

fn signed_24([a, b, c]: [u8; 3]) -> i32 {
    i32::from_le_bytes([0, a, b, c]) >> 8
}

fn as_24(value: i32) -> Option<[u8; 3]> {
    let [a, b, c, _] = value.to_le_bytes();
    (signed_24([a, b, c]) == value).then_some([a, b, c])
}
