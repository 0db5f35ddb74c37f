//! Faults that make an axis unavailable.
use core::fmt;
use servobench_base::Stateful;
use servobench_cia402::ErrorCode;

/// Fault that makes an axis unavailable: of the drive, or of the link to it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Stateful)]
pub enum Fault {
    /// A fault of the drive, with its code (603Fh); 0 without one.
    Drive(u16),
    /// A fault found by the link, which has stopped the axis.
    Link(LinkFault),
}

impl Fault {
    /// Code as an error number of a function block: the drive's (603Fh), or [`LinkFault::code`].
    #[must_use]
    pub const fn code(self) -> u16 {
        match self {
            Self::Drive(code) => code,
            Self::Link(fault) => fault.code(),
        }
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Drive(code) => write!(f, "fault {code:04X}h of the drive"),
            Self::Link(fault) => f.pad(fault.name()),
        }
    }
}

/// A fault of the link between motion task and drive. It holds until a reset, and as long as its cause.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Stateful)]
pub enum LinkFault {
    /// The drive is silent, or did not execute its commands, for longer than the drive time-out.
    DriveTimeout,
    /// The drive left Operation enabled without a command and without a fault.
    DriveLeftOperation,
    /// The external fault signal.
    External,
    /// A motion into the limit switch of the negative end.
    NegativeLimit,
    /// A motion into the limit switch of the positive end.
    PositiveLimit,
    /// A position reading outside the range of its counter, or so far from the previous one that counts are lost.
    PositionLost,
    /// The motion task gave a NaN, or a value that the drive's units cannot express.
    Command,
}

impl LinkFault {
    /// Every fault.
    pub const ALL: [Self; 7] = [
        Self::DriveTimeout,
        Self::DriveLeftOperation,
        Self::External,
        Self::NegativeLimit,
        Self::PositiveLimit,
        Self::PositionLost,
        Self::Command,
    ];

    /// Name of the fault, in words.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::DriveTimeout => "drive time-out",
            Self::DriveLeftOperation => "drive left Operation enabled",
            Self::External => "external fault",
            Self::NegativeLimit => "negative limit switch",
            Self::PositiveLimit => "positive limit switch",
            Self::PositionLost => "position lost",
            Self::Command => "command that cannot be followed",
        }
    }

    /// Response of the link, in words.
    #[must_use]
    pub const fn response(self) -> &'static str {
        match self {
            Self::NegativeLimit | Self::PositiveLimit => "halt (bit 8): the axis stays powered",
            Self::DriveTimeout | Self::DriveLeftOperation | Self::External | Self::PositionLost | Self::Command => {
                "Quick stop, and Disable voltage when it is over"
            }
        }
    }

    /// Error code: that of CiA 301 (emergency error codes) with the same meaning if there is one, a device-specific one (FFxxh) otherwise.
    #[must_use]
    pub const fn code(self) -> u16 {
        let error = match self {
            // Life guard error or heartbeat error.
            Self::DriveTimeout => ErrorCode::DriveTimeout,
            Self::External => ErrorCode::External,
            Self::DriveLeftOperation => ErrorCode::DriveLeftOperation,
            Self::NegativeLimit => ErrorCode::NegativeLimitSwitch,
            Self::PositiveLimit => ErrorCode::PositiveLimitSwitch,
            Self::PositionLost => ErrorCode::PositionLost,
            Self::Command => ErrorCode::Command,
        };
        error.code()
    }
}
