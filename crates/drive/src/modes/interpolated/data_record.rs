//! The standard's objects: sub-mode (60C0h), data record (60C1h) and time period (60C2h).
//!
//! | 60C0h | between points | time of a segment | write that adds the point |
//! |---|---|---|---|
//! | 0 | linear | 60C2h, adapted | position, 60C1h.1 |
//! | −1 | linear | 60C2h | position, 60C1h.1 |
//! | −2 | linear | of each point, 60C1h.2 (ms) | time, 60C1h.2 |
//! | −3 | cubic | of each point, 60C1h.2 (ms) | velocity, 60C1h.3 (0.1 counts/s) |
//!
//! Source: Copley Controls, *PVT Trajectory Calculations*, rev. 00 (2020), "Standard DS402 objects".
use super::buffer::{Buffer, Point, Refusal};
use thiserror::Error;

/// How the drive interpolates (60C0h).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[repr(i16)]
pub enum SubMode {
    /// Linear in a constant time, which the drive adapts to the master's clock.
    LinearAdapted = 0,
    /// Linear in a constant time.
    Linear = -1,
    /// Linear in a time of its own for each point.
    LinearTimed = -2,
    /// Cubic in a time of its own for each point.
    Cubic = -3,
}

impl SubMode {
    /// Every sub-mode, downwards from the standard's.
    pub const ALL: [Self; 4] = [Self::LinearAdapted, Self::Linear, Self::LinearTimed, Self::Cubic];

    /// The sub-mode with this code.
    ///
    /// # Errors
    /// [`RecordError::SubMode`] for any other.
    pub fn from_code(code: i16) -> Result<Self, RecordError> {
        Self::ALL.into_iter().find(|mode| mode.code() == code).ok_or(RecordError::SubMode { code })
    }

    /// Value of 60C0h.
    #[must_use]
    pub const fn code(self) -> i16 {
        self as i16
    }

    /// Whether every segment lasts as long as 60C2h says.
    #[must_use]
    pub const fn has_constant_time(self) -> bool {
        matches!(self, Self::LinearAdapted | Self::Linear)
    }

    /// Sub-index of 60C1h by whose write the point is added.
    #[must_use]
    pub const fn last_sub_index(self) -> u8 {
        match self {
            Self::LinearAdapted | Self::Linear => 1,
            Self::LinearTimed => 2,
            Self::Cubic => 3,
        }
    }
}

/// Time between two points in the sub-modes with a constant one (60C2h).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct TimePeriod {
    microseconds: u32,
}

impl TimePeriod {
    /// `units` (60C2h.1) of 10^`index` s (60C2h.2).
    ///
    /// # Errors
    /// [`RecordError::TimePeriod`] for no units at all, and for an index that is not −3 to −6.
    pub fn new(units: u8, index: i8) -> Result<Self, RecordError> {
        let unit = match index {
            -3 => 1000,
            -4 => 100,
            -5 => 10,
            -6 => 1,
            _ => return Err(RecordError::TimePeriod { units, index }),
        };
        if units == 0 {
            return Err(RecordError::TimePeriod { units, index });
        }
        Ok(Self { microseconds: u32::from(units) * unit })
    }

    /// The period (µs).
    #[must_use]
    pub const fn microseconds(self) -> u32 {
        self.microseconds
    }
}

/// Why a write to these objects was refused.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum RecordError {
    /// 60C0h does not take this value.
    #[error("interpolation sub-mode (60C0h) must be 0, -1, -2 or -3, got {code}")]
    SubMode {
        /// Rejected value.
        code: i16,
    },
    /// 60C2h does not take these values.
    #[error(
        "interpolation time period (60C2h) must be 1 to 255 units of 10^-3 to 10^-6 s, got {units} units of 10^{index} s"
    )]
    TimePeriod {
        /// 60C2h.1.
        units: u8,
        /// 60C2h.2.
        index: i8,
    },
    /// 60C1h has no such sub-index, or the sub-mode does not use it.
    #[error(
        "interpolation data record: sub-index {sub_index} must not be written in sub-mode {}, 1 to {} may be",
        sub_mode.code(), sub_mode.last_sub_index()
    )]
    SubIndex {
        /// Rejected sub-index.
        sub_index: u8,
        /// The sub-mode.
        sub_mode: SubMode,
    },
    /// 60C1h.2 has eight bits.
    #[error("interpolation data record: time (60C1h.2) must be 0 to 255 ms, got {value}")]
    Time {
        /// Rejected value.
        value: i32,
    },
    /// The buffer did not take the point.
    #[error(transparent)]
    Refused(#[from] Refusal),
}

/// The data record (60C1h): what was written to it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct DataRecord {
    position: i32,
    time_ms: u8,
}

impl DataRecord {
    /// Writes `value` to `sub_index`: 1 position (counts), 2 time (ms), 3 velocity (0.1 counts/s). The write that the sub-mode
    /// names adds the point to the buffer.
    ///
    /// # Errors
    /// [`RecordError`] for a sub-index that the sub-mode does not use, a time beyond its range, and a point that the buffer
    /// refuses.
    pub fn write(
        &mut self,
        sub_mode: SubMode,
        period: TimePeriod,
        buffer: &mut Buffer,
        sub_index: u8,
        value: i32,
    ) -> Result<(), RecordError> {
        if !(1..=sub_mode.last_sub_index()).contains(&sub_index) {
            return Err(RecordError::SubIndex { sub_index, sub_mode });
        }
        match sub_index {
            1 => self.position = value,
            2 => self.time_ms = u8::try_from(value).map_err(|_| RecordError::Time { value })?,
            _ => {}
        }
        if sub_index == sub_mode.last_sub_index() {
            let time = if sub_mode.has_constant_time() { period.microseconds } else { u32::from(self.time_ms) * 1000 };
            let velocity = (sub_mode == SubMode::Cubic).then_some(value);
            buffer.add(Point { position: self.position, is_relative: false, velocity, time })?;
        }
        Ok(())
    }
}
