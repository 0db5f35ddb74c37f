//! Interpolation of a drive between points: sub-mode (60C0h) and time period (60C2h).
//!
//! | 60C0h | between points | time of a segment | write that adds the point |
//! |---|---|---|---|
//! | 0 | linear | 60C2h, adapted | position, 60C1h.1 |
//! | −1 | linear | 60C2h | position, 60C1h.1 |
//! | −2 | linear | individual, 60C1h.2 (ms) | time, 60C1h.2 |
//! | −3 | cubic | individual, 60C1h.2 (ms) | velocity, 60C1h.3 (0.1 counts/s) |
//!
//! Source: Copley Controls, *PVT Trajectory Calculations*, rev. 00 (2020), "Standard DS402 objects".
use thiserror::Error;

/// Interpolation of the drive (60C0h).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[repr(i16)]
pub enum SubMode {
    /// Linear in a constant time, which the drive adapts to the master's clock.
    LinearAdapted = 0,
    /// Linear in a constant time.
    Linear = -1,
    /// Linear in an individual time for each point.
    LinearTimed = -2,
    /// Cubic in an individual time for each point.
    Cubic = -3,
}

impl SubMode {
    /// Every sub-mode, in falling order of the codes.
    pub const ALL: [Self; 4] = [Self::LinearAdapted, Self::Linear, Self::LinearTimed, Self::Cubic];

    /// The sub-mode with this code.
    ///
    /// # Errors
    /// [`SettingError::SubMode`] for any other.
    pub fn from_code(code: i16) -> Result<Self, SettingError> {
        Self::ALL.into_iter().find(|mode| mode.code() == code).ok_or(SettingError::SubMode { code })
    }

    /// Value of 60C0h.
    #[must_use]
    pub const fn code(self) -> i16 {
        self as i16
    }

    /// True if every segment lasts for the time of 60C2h.
    #[must_use]
    pub const fn has_constant_time(self) -> bool {
        matches!(self, Self::LinearAdapted | Self::Linear)
    }

    /// Sub-index of 60C1h whose write adds the point.
    #[must_use]
    pub const fn last_sub_index(self) -> u8 {
        match self {
            Self::LinearAdapted | Self::Linear => 1,
            Self::LinearTimed => 2,
            Self::Cubic => 3,
        }
    }
}

/// Time between two points in the sub-modes with constant time (60C2h).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct TimePeriod {
    microseconds: u32,
}

impl TimePeriod {
    /// `units` (60C2h.1) of 10^`index` s (60C2h.2).
    ///
    /// # Errors
    /// [`SettingError::TimePeriod`] for zero units, and for an index that is not −3 to −6.
    pub fn new(units: u8, index: i8) -> Result<Self, SettingError> {
        let unit = match index {
            -3 => 1000,
            -4 => 100,
            -5 => 10,
            -6 => 1,
            _ => return Err(SettingError::TimePeriod { units, index }),
        };
        if units == 0 {
            return Err(SettingError::TimePeriod { units, index });
        }
        Ok(Self { microseconds: u32::from(units) * unit })
    }

    /// The period (µs).
    #[must_use]
    pub const fn microseconds(self) -> u32 {
        self.microseconds
    }
}

/// A value that one of these objects refuses.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum SettingError {
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
}
