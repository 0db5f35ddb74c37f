//! Refused accesses to the object dictionary: the abort codes of CiA 301 (table 22) with the reason.
//!
//! The same codes end an SDO transfer over EtherCAT (ETG.1000.6, table 41).
use crate::objects::{DataType, Value};
use crate::units::{Object, UnitError};
use crate::{Mode, PowerState};
use core::fmt;
use thiserror::Error;

/// Declares the abort codes with their texts.
macro_rules! abort_codes {
    ($($name:ident = $code:literal, $text:literal;)*) => {
        /// Code that ends a transfer on the bus.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
        #[repr(u32)]
        pub enum AbortCode {
            $(#[doc = concat!($text, ".")] $name = $code,)*
        }

        impl AbortCode {
            /// Every code that the dictionary returns.
            pub const ALL: &[Self] = &[$(Self::$name),*];

            /// Text in the words of the standard.
            #[must_use]
            pub const fn text(self) -> &'static str {
                match self { $(Self::$name => $text,)* }
            }
        }
    };
}

abort_codes! {
    WriteOnly = 0x0601_0001, "Attempt to read a write only object";
    ReadOnly = 0x0601_0002, "Attempt to write a read only object";
    NoObject = 0x0602_0000, "Object does not exist in the object dictionary";
    Incompatible = 0x0604_0043, "General parameter incompatibility reason";
    Length = 0x0607_0010, "Data type does not match, length of service parameter does not match";
    NoSubindex = 0x0609_0011, "Sub-index does not exist";
    OutOfRange = 0x0609_0030, "Invalid value for parameter";
    TooHigh = 0x0609_0031, "Value of parameter written too high";
    TooLow = 0x0609_0032, "Value of parameter written too low";
    MaximumBelowMinimum = 0x0609_0036, "Maximum value is less than minimum value";
    DeviceState = 0x0800_0022, "Data cannot be transferred or stored to the application because of the present device state";
}

impl AbortCode {
    /// The code as sent over the bus.
    #[must_use]
    pub const fn bits(self) -> u32 {
        self as u32
    }
}

impl fmt::Display for AbortCode {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let bits = self.bits();
        write!(f, "{:04X} {:04X}h", bits >> 16, bits & 0xFFFF)
    }
}

/// A refused access: the object, the value, and the accepted values. Nothing has changed.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum SdoError {
    /// An index that does not exist in the drive.
    #[error("object {index:04X}h does not exist: take one of the drive's object dictionary")]
    NoObject {
        /// Rejected index.
        index: u16,
    },
    /// A sub-index that does not exist in the object.
    #[error("{object} does not exist: `{name}` has sub-indices up to {highest:02X}h")]
    NoSubindex {
        /// Rejected object.
        object: Object,
        /// Name of the object.
        name: &'static str,
        /// Highest sub-index of the object.
        highest: u8,
    },
    /// A read of a write-only object.
    #[error("`{name}` ({object}) is write only: keep what was written")]
    WriteOnly {
        /// The object.
        object: Object,
        /// Name of the object.
        name: &'static str,
    },
    /// A string read as a number.
    #[error("`{name}` ({object}) is a string, not a number: upload its bytes")]
    NoNumber {
        /// The object.
        object: Object,
        /// Name of the object.
        name: &'static str,
    },
    /// A write of a read-only object.
    #[error("`{name}` ({object}) is read only: it reports the state of the drive")]
    ReadOnly {
        /// The object.
        object: Object,
        /// Name of the object.
        name: &'static str,
    },
    /// A wrong number of bytes for the type.
    #[error("`{name}` ({object}) is of type {}, {} byte long, got {length} byte", data_type.name(), data_type.size())]
    Length {
        /// The object.
        object: Object,
        /// Name of the object.
        name: &'static str,
        /// Type of the object.
        data_type: DataType,
        /// Number of bytes received.
        length: usize,
    },
    /// A value of another type.
    #[error("`{name}` ({object}) is of type {}, got {} {value}", data_type.name(), value.data_type().name())]
    Type {
        /// The object.
        object: Object,
        /// Name of the object.
        name: &'static str,
        /// Type of the object.
        data_type: DataType,
        /// Rejected value.
        value: Value,
    },
    /// A value above the range.
    #[error("`{name}` ({object}) must be at most {highest}, got {value}")]
    TooHigh {
        /// The object.
        object: Object,
        /// Name of the object.
        name: &'static str,
        /// Rejected value.
        value: i128,
        /// Largest accepted value.
        highest: i128,
    },
    /// A value below the range.
    #[error("`{name}` ({object}) must be at least {lowest}, got {value}")]
    TooLow {
        /// The object.
        object: Object,
        /// Name of the object.
        name: &'static str,
        /// Rejected value.
        value: i128,
        /// Smallest accepted value.
        lowest: i128,
    },
    /// A value that is not defined.
    #[error("`{name}` ({object}) must be one of {accepted:?}, got {value}")]
    NotListed {
        /// The object.
        object: Object,
        /// Name of the object.
        name: &'static str,
        /// Rejected value.
        value: Value,
        /// Accepted values.
        accepted: &'static [i64],
    },
    /// Reserved bits.
    #[error("`{name}` ({object}) must have no bits but {bits:#x}, got {:#x}: clear the others", value.number())]
    ReservedBits {
        /// The object.
        object: Object,
        /// Name of the object.
        name: &'static str,
        /// Rejected value.
        value: Value,
        /// Bits that are defined.
        bits: u32,
    },
    /// A window whose ends would cross.
    #[error("`{name}` ({object}) must be {side} {bound}, the other end, got {value}: write the other end first")]
    CrossedBounds {
        /// The object.
        object: Object,
        /// Name of the object.
        name: &'static str,
        /// Rejected value.
        value: Value,
        /// Required side of the other end.
        side: Side,
        /// Value of the other end.
        bound: i32,
    },
    /// A factor that is inconsistent with the others.
    #[error("{object} = {value} does not fit the other objects of the factor group: {reason}")]
    FactorGroup {
        /// The object.
        object: Object,
        /// Rejected value.
        value: Value,
        /// Error of their product.
        reason: UnitError,
    },
    /// A write that is refused in the present state.
    #[error("`{name}` ({object}) cannot be written in {state}: disable operation first")]
    State {
        /// The object.
        object: Object,
        /// Name of the object.
        name: &'static str,
        /// State of the drive.
        state: PowerState,
    },
    /// A write that would change an active motion.
    #[error(
        "`{name}` ({object}) cannot be written while a motion of {} is under way: wait for its end, or clear bit 4 of the controlword",
        mode.abbreviation()
    )]
    UnderWay {
        /// The object.
        object: Object,
        /// Name of the object.
        name: &'static str,
        /// Mode that generates the motion.
        mode: Mode,
    },
}

/// A side of a bound.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Side {
    /// Less than the bound.
    Below,
    /// Greater than the bound.
    Above,
}

impl fmt::Display for Side {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Below => "below",
            Self::Above => "above",
        })
    }
}

impl SdoError {
    /// Code that ends the transfer.
    #[must_use]
    pub const fn abort_code(&self) -> AbortCode {
        match self {
            Self::NoObject { .. } => AbortCode::NoObject,
            Self::NoSubindex { .. } => AbortCode::NoSubindex,
            Self::WriteOnly { .. } => AbortCode::WriteOnly,
            Self::ReadOnly { .. } => AbortCode::ReadOnly,
            Self::Length { .. } | Self::Type { .. } => AbortCode::Length,
            Self::TooHigh { .. } => AbortCode::TooHigh,
            Self::TooLow { .. } => AbortCode::TooLow,
            Self::NotListed { .. } | Self::ReservedBits { .. } => AbortCode::OutOfRange,
            Self::CrossedBounds { .. } => AbortCode::MaximumBelowMinimum,
            Self::NoNumber { .. } | Self::FactorGroup { .. } => AbortCode::Incompatible,
            Self::State { .. } | Self::UnderWay { .. } => AbortCode::DeviceState,
        }
    }
}
