//! Why an axis is not available.
use core::fmt;
use servobench_base::Stateful;
use servobench_cia402::ErrorCode;

/// Why an axis is not available: a fault of the drive, or one of the link to it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Stateful)]
pub enum Fault {
    /// The drive's own, with its code (603Fh); 0 when it gives none.
    Drive(u16),
    /// What the link has found and stopped the axis for.
    Link(LinkFault),
}

impl Fault {
    /// The code as an error number of a function block: the drive's (603Fh), or [`LinkFault::code`].
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
    /// The drive is silent, or did not do what it was told, for longer than the drive time-out.
    DriveTimeout,
    /// The drive left Operation enabled without having been told to and without a fault.
    DriveLeftOperation,
    /// The external fault signal.
    External,
    /// A motion into the switch of the negative end.
    NegativeLimit,
    /// A motion into the switch of the positive end.
    PositiveLimit,
    /// A reading of the position that its counter cannot show, or so far from the one before that counts are lost.
    PositionLost,
    /// The motion task gave a value that is no number, or one that the drive's units cannot express.
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

    /// What happened, in words.
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

    /// What the drive is told.
    #[must_use]
    pub const fn response(self) -> &'static str {
        match self {
            Self::NegativeLimit | Self::PositiveLimit => "halt (bit 8): the axis stays powered",
            Self::DriveTimeout | Self::DriveLeftOperation | Self::External | Self::PositionLost | Self::Command => {
                "Quick stop, and Disable voltage when it is over"
            }
        }
    }

    /// Its error code: that of CiA 301 (emergency error codes) where there is one that says the same, a device-specific one
    /// (FFxxh) otherwise.
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
