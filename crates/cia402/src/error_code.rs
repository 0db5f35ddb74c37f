//! Why a drive is faulty: the error codes (603Fh) and the error register (1001h).
//!
//! Codes of IEC 61800-7-201 (CiA 402-2, error codes of the emergency message), those of communication of CiA 301
//! (table 26). The profile has none for homing, limit switches and the position range: FF00h to FFFFh are the device's own,
//! and those that a link to the drive takes for itself (FF01h, FF04h, FF05h) are left out.
use core::fmt;

/// Declares the error codes: number, class in the error register, text.
macro_rules! error_codes {
    ($($(#[$doc:meta])* $name:ident = $code:literal, $class:expr, $text:literal;)*) => {
        /// What a drive gives as the reason of a fault.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
        #[repr(u16)]
        pub enum ErrorCode { $($(#[$doc])* $name = $code,)* }

        impl ErrorCode {
            /// Every code that a simulated drive gives.
            pub const ALL: &[Self] = &[$(Self::$name),*];

            /// Text, in the words of the standard where it has one.
            #[must_use]
            pub const fn text(self) -> &'static str {
                match self { $(Self::$name => $text,)* }
            }

            /// What the error register (1001h) tells while the error is present.
            #[must_use]
            pub const fn register(self) -> u8 {
                GENERIC | match self { $(Self::$name => $class,)* }
            }
        }
    };
}

/// Bits of the error register (CiA 301, 1001h). The first one is set with every error.
const GENERIC: u8 = 1 << 0;
const CURRENT: u8 = 1 << 1;
const VOLTAGE: u8 = 1 << 2;
const COMMUNICATION: u8 = 1 << 4;
const PROFILE: u8 = 1 << 5;
const MANUFACTURER: u8 = 1 << 7;

error_codes! {
    /// Anything that no other code tells.
    Generic = 0x1000, 0, "generic error";
    /// More current to the motor than the power stage bears.
    ContinuousOverCurrent = 0x2310, CURRENT, "continuous over current (device output side)";
    /// The DC link is charged beyond its limit.
    DcLinkOverVoltage = 0x3210, VOLTAGE, "DC link over-voltage";
    /// The DC link is not charged enough to drive the motor.
    DcLinkUnderVoltage = 0x3220, VOLTAGE, "DC link under-voltage";
    /// The drive's own software.
    InternalSoftware = 0x6100, 0, "internal software";
    /// Parameters that do not go together.
    Parameter = 0x6320, 0, "parameter error";
    /// The encoder.
    IncrementalSensor = 0x7305, PROFILE, "incremental sensor 1 fault";
    /// The master is silent for too long.
    Communication = 0x8100, COMMUNICATION, "communication";
    /// Life guarding or heartbeat ran out.
    Heartbeat = 0x8130, COMMUNICATION, "life guard error or heartbeat error";
    /// Process data did not come in time.
    RpdoTimeOut = 0x8250, COMMUNICATION, "RPDO time-out";
    /// The motor turns faster than it may.
    VelocityController = 0x8400, PROFILE, "velocity speed controller";
    /// The position loop cannot go on.
    PositionController = 0x8500, PROFILE, "position controller";
    /// The interpolated position ran out of points, or got too many.
    PositioningController = 0x8600, PROFILE, "positioning controller";
    /// The following error was outside its window (6065h) for longer than its time-out (6066h).
    FollowingError = 0x8611, PROFILE, "following error";
    /// The reference is beyond a software position limit (607Dh).
    ReferenceLimit = 0x8612, PROFILE, "reference limit";
    /// The cycle of the master and that of the drive lost each other.
    SyncController = 0x8700, PROFILE | COMMUNICATION, "sync controller";
    /// Something outside the drive asks for it.
    External = 0x9000, 0, "external error";
    /// The switch at the negative end was met.
    NegativeLimitSwitch = 0xFF02, MANUFACTURER, "negative limit switch";
    /// The switch at the positive end was met.
    PositiveLimitSwitch = 0xFF03, MANUFACTURER, "positive limit switch";
    /// The reference was not found.
    Homing = 0xFF11, MANUFACTURER, "homing error";
    /// The position left what its counter or its object can hold.
    PositionRange = 0xFF12, MANUFACTURER, "position range";
}

impl ErrorCode {
    /// Value of 603Fh.
    #[must_use]
    pub const fn code(self) -> u16 {
        self as u16
    }

    /// The error with this code; `None` for 0, no error, and for what a simulated drive does not give.
    #[must_use]
    pub fn from_code(code: u16) -> Option<Self> {
        Self::ALL.iter().copied().find(|error| error.code() == code)
    }
}

impl fmt::Display for ErrorCode {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} ({:04X}h)", self.text(), self.code())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_are_read_back_and_nothing_else_is() {
        let read: Vec<_> = (0..=u16::MAX).filter_map(ErrorCode::from_code).collect();
        assert_eq!(read, ErrorCode::ALL);
        assert_eq!(ErrorCode::FollowingError.to_string(), "following error (8611h)");
    }

    #[test]
    fn classes_are_those_of_the_leading_digits() {
        for error in ErrorCode::ALL {
            let class = match error.code() >> 12 {
                0x2 => CURRENT,
                0x3 => VOLTAGE,
                0xF => MANUFACTURER,
                _ => 0,
            };
            assert_eq!(error.register() & (CURRENT | VOLTAGE | MANUFACTURER), class, "{error}");
            assert_eq!(error.register() & GENERIC, GENERIC, "{error}");
        }
    }
}
