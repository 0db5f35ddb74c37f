//! Modulo axes: positions within a range, and the distance to a target.
//!
//! A position beyond the position range limit (607Bh) continues at its other end. Both ends belong to the range, as in the default range,
//! that of 32 bits, so after `length = max − min + 1` positions the axis is back at the start. In integers, for positions `from` and `to`
//! of the range:
//!
//! ```text
//! way = (to − from) mod length, in [0, length)       positive direction
//!       way − length, unless way = 0                 negative direction
//!       the shorter one of both, positive if equal   shortest way
//! ```
//!
//! The positioning option code (60F2h, IEC 61800-7-201) selects the direction by its bits 7 and 6, the rotary axis direction option. The
//! first option, 00b, moves as on a linear axis: the distance can exceed the range.
//!
//! ```
//! use servobench_cia402::modulo::{Direction, PositionRange};
//! let turn = PositionRange::new(0, 359)?;
//! assert_eq!(turn.way(350, 10, Direction::Positive), 20);
//! assert_eq!(turn.way(350, 10, Direction::Negative), -340);
//! assert_eq!(turn.way(350, 10, Direction::Shortest), 20);
//! # Ok::<(), servobench_cia402::modulo::EmptyRange>(())
//! ```
use thiserror::Error;

/// Bits of 60F2h that are supported: the rotary axis direction option.
pub(crate) const POSITIONING_OPTION_BITS: u32 = 0b1100_0000;

/// Direction of a modulo axis to its target.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Direction {
    /// With increasing position; no motion if the target is the position.
    Positive,
    /// With decreasing position; no motion if the target is the position.
    Negative,
    /// The shorter direction, with increasing position if both are equal.
    Shortest,
}

/// Rotary axis direction option of the positioning option code.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[repr(u16)]
pub enum RotaryAxisOption {
    /// Like on a linear axis: a target beyond the range is reached over several turns.
    #[default]
    Linear = 0b00,
    /// With decreasing position.
    Negative = 0b01,
    /// With increasing position.
    Positive = 0b10,
    /// The shorter direction.
    Shortest = 0b11,
}

impl RotaryAxisOption {
    /// 60F2h with this option only.
    #[must_use]
    pub const fn code(self) -> u16 {
        (self as u16) << 6
    }

    /// Direction on a modulo axis; `None` to move as on a linear one.
    #[must_use]
    pub const fn direction(self) -> Option<Direction> {
        match self {
            Self::Linear => None,
            Self::Negative => Some(Direction::Negative),
            Self::Positive => Some(Direction::Positive),
            Self::Shortest => Some(Direction::Shortest),
        }
    }

    /// Option in bits 7 and 6 of 60F2h.
    #[must_use]
    pub const fn of_code(positioning_option_code: u16) -> Self {
        match (positioning_option_code >> 6) & 0b11 {
            0b00 => Self::Linear,
            0b01 => Self::Negative,
            0b10 => Self::Positive,
            _ => Self::Shortest,
        }
    }
}

/// A range whose end is not above its beginning.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error("max position range limit (607Bh:02h) must be above {min}, the min position range limit, got {max}")]
pub struct EmptyRange {
    /// 607Bh:01h.
    pub min: i32,
    /// 607Bh:02h.
    pub max: i32,
}

/// Range of the positions of an axis (607Bh).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct PositionRange {
    min: i32,
    max: i32,
}

impl Default for PositionRange {
    /// The full range of 32 bits.
    fn default() -> Self {
        Self { min: i32::MIN, max: i32::MAX }
    }
}

impl PositionRange {
    /// Range from one position to another, both included.
    ///
    /// # Errors
    /// [`EmptyRange`] unless the second one is above the first.
    pub const fn new(min: i32, max: i32) -> Result<Self, EmptyRange> {
        if min < max { Ok(Self { min, max }) } else { Err(EmptyRange { min, max }) }
    }

    /// Smallest position.
    #[must_use]
    pub const fn min(self) -> i32 {
        self.min
    }

    /// Largest position.
    #[must_use]
    pub const fn max(self) -> i32 {
        self.max
    }

    /// Number of positions, at most 2³².
    #[must_use]
    pub const fn length(self) -> i64 {
        self.max as i64 - self.min as i64 + 1
    }

    /// Position in the range for an unwrapped position.
    #[must_use]
    pub const fn wrap(self, position: i64) -> i32 {
        let (min, length) = (self.min as i64, self.length());
        let wrapped = if min <= position && position <= self.max as i64 {
            position
        } else {
            // If the difference overflows, whole turns are removed from the position first.
            let difference = match position.checked_sub(min) {
                Some(difference) => difference,
                None => position % length - min,
            };
            min + difference.rem_euclid(length)
        };
        #[expect(clippy::cast_possible_truncation, reason = "from min to max, both 32 bits")]
        {
            wrapped as i32
        }
    }

    /// Signed distance from one position to another, each wrapped into the range first; less than one turn.
    #[must_use]
    pub const fn way(self, from: i64, to: i64, direction: Direction) -> i64 {
        let difference = self.wrap(to) as i64 - self.wrap(from) as i64;
        let positive = if difference < 0 { difference + self.length() } else { difference };
        let negative = if positive == 0 { 0 } else { positive - self.length() };
        match direction {
            Direction::Positive => positive,
            Direction::Negative => negative,
            Direction::Shortest => {
                if positive <= -negative {
                    positive
                } else {
                    negative
                }
            }
        }
    }
}
