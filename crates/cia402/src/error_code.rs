//! Error codes of the drive (603Fh) and of the link to it, and the error register (1001h).
//!
//! Codes of IEC 61800-7-201 (CiA 402-2, error codes of the emergency message), and those of CiA 301 (table 26) for communication and
//! external errors. There is no specific code for an open motor phase: 3321h, an interrupted armature circuit, is that of the output
//! voltage (33xxh); drives also use device-specific codes (Kollmorgen S300 2380h, ABB ACS580 3381h). Neither standard has a code for a
//! limit switch or for faults found by the link: FF00h to FFFFh are device-specific.
use core::fmt;

/// Declares the error codes: number, source, text, condition.
macro_rules! error_codes {
    ($($name:ident = $code:literal, $source:expr, $text:literal, $when:literal;)*) => {
        /// Error that makes an axis unavailable.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
        #[repr(u16)]
        pub enum ErrorCode { $(#[doc = concat!($when, ".")] $name = $code,)* }

        impl ErrorCode {
            /// Every code of the drive and the link.
            pub const ALL: &[Self] = &[$(Self::$name),*];

            /// Text, in the words of the standard if it has one.
            #[must_use]
            pub const fn text(self) -> &'static str {
                match self { $(Self::$name => $text,)* }
            }

            /// Condition of the error, in words.
            #[must_use]
            pub const fn when(self) -> &'static str {
                match self { $(Self::$name => $when,)* }
            }

            /// Source of the error.
            #[must_use]
            pub const fn source(self) -> Source {
                match self { $(Self::$name => $source,)* }
            }
        }
    };
}

/// Source of an error code.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Source {
    /// The drive, which begins its fault reaction and reports the code as 603Fh.
    Drive {
        /// The error register (1001h) while the error is present.
        register: u8,
    },
    /// The link between motion task and drive, which keeps the code to itself.
    Link,
}

/// Bits of the error register (CiA 301, 1001h). The first one is set with every error.
const GENERIC: u8 = 1 << 0;
const CURRENT: u8 = 1 << 1;
const VOLTAGE: u8 = 1 << 2;
const TEMPERATURE: u8 = 1 << 3;
const COMMUNICATION: u8 = 1 << 4;
const PROFILE: u8 = 1 << 5;

const fn drive(class: u8) -> Source {
    Source::Drive { register: GENERIC | class }
}

error_codes! {
    OverCurrent = 0x2310, drive(CURRENT), "continuous over-current",
        "The current of a phase was above its threshold";
    LoadLevel = 0x2350, drive(CURRENT), "load level fault (I²t, thermal state)",
        "The I²t load of motor or drive was reached where its reaction is a fault";
    DcLinkOverVoltage = 0x3210, drive(VOLTAGE), "DC link over-voltage",
        "The measured DC link was above its threshold while the drive function was enabled";
    DcLinkUnderVoltage = 0x3220, drive(VOLTAGE), "DC link under-voltage",
        "The power was gone while the drive function was enabled, or the measured DC link below its threshold";
    ArmatureInterrupted = 0x3321, drive(VOLTAGE), "armature circuit interrupted",
        "A phase of the motor lacked the current requested of it";
    Temperature = 0x4310, drive(TEMPERATURE), "excess temperature of the motor",
        "The measured temperature of the winding was above its threshold";
    MotorBlocked = 0x7121, drive(PROFILE), "motor blocked",
        "The motor was stalled although the loops were at their limit";
    Commutation = 0x7122, drive(PROFILE), "motor error or commutation malfunction",
        "The motor gained speed against its torque-producing current";
    IncrementalSensor = 0x7305, drive(PROFILE), "incremental sensor 1 fault",
        "The encoder of the motor failed, or a measured velocity or effort was not a number";
    IncrementalSensor2 = 0x7306, drive(PROFILE), "incremental sensor 2 fault",
        "The encoder of the load failed";
    Speed = 0x7310, drive(PROFILE), "speed",
        "The motor was faster than its threshold";
    DriveTimeout = 0x8130, Source::Link, "drive time-out",
        "The drive was silent, or did not follow its commands, for longer than the drive time-out";
    FollowingError = 0x8611, drive(PROFILE), "following error",
        "The following error was outside its window (6065h) for longer than its time-out (6066h)";
    SyncController = 0x8700, drive(PROFILE | COMMUNICATION), "sync controller",
        "More cycles of a cyclic mode began without a frame than the drive bridges";
    External = 0x9000, Source::Link, "external fault",
        "The external fault signal came";
    DriveLeftOperation = 0xFF01, Source::Link, "drive left Operation enabled",
        "The drive left Operation enabled without a command and without a fault";
    NegativeLimitSwitch = 0xFF02, Source::Link, "negative limit switch",
        "A motion went into the switch of the negative end";
    PositiveLimitSwitch = 0xFF03, Source::Link, "positive limit switch",
        "A motion went into the switch of the positive end";
    PositionLost = 0xFF04, Source::Link, "position lost",
        "A position was read that its counter cannot show, or so far from the one before that counts are lost";
    Command = 0xFF05, Source::Link, "command that cannot be followed",
        "The motion task gave a value that is not a number, or one that the drive's units cannot express";
}

impl ErrorCode {
    /// Number of the error.
    #[must_use]
    pub const fn code(self) -> u16 {
        self as u16
    }

    /// The error with this code; `None` for 0, no error, and for codes that neither drive nor link produce.
    #[must_use]
    pub fn from_code(code: u16) -> Option<Self> {
        Self::ALL.iter().copied().find(|error| error.code() == code)
    }

    /// Error register (1001h) of a drive that reports `code` (603Fh).
    #[must_use]
    pub fn register(code: u16) -> u8 {
        match Self::from_code(code).map(Self::source) {
            Some(Source::Drive { register }) => register,
            // An external code: only its sender knows its class.
            _ if code != 0 => GENERIC,
            _ => 0,
        }
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

    /// CiA 301, 1001h: bit 0 with every error, bit 2 for voltage (3xxxh), bit 3 for temperature (4xxxh), bit 4 for communication, bit 5
    /// for errors of the profile.
    #[test]
    fn the_register_tells_the_class() {
        for (code, register) in [
            (0, 0),
            (0x2310, 0x03),
            (0x2350, 0x03),
            (0x3220, 0x05),
            (0x3321, 0x05),
            (0x4310, 0x09),
            (0x7122, 0x21),
            (0x7305, 0x21),
            (0x8611, 0x21),
            (0x8700, 0x31),
            (0x9000, 0x01),
        ] {
            assert_eq!(ErrorCode::register(code), register, "{code:04X}h");
        }
    }
}
