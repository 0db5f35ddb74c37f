//! Option codes for the end of the drive function (605Ah to 605Eh).
//!
//! Codes below zero are manufacturer-specific, those above the listed ones reserved: both are refused.
use servobench_base::Stateful;
use thiserror::Error;

/// Braking of the axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Stateful)]
pub enum Deceleration {
    /// On the slow-down ramp, the deceleration of the mode of operation (6084h).
    SlowDownRamp,
    /// On the quick stop ramp (6085h).
    QuickStopRamp,
    /// At the current limit.
    CurrentLimit,
    /// At the voltage limit.
    VoltageLimit,
}

/// An option code that the object refuses.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error("{name} ({object:04X}h) must be one of {accepted:?}, got {value}")]
pub struct OptionCodeError {
    /// Index of the object.
    pub object: u16,
    /// Name of the object.
    pub name: &'static str,
    /// Rejected value.
    pub value: i16,
    /// Values that the object takes.
    pub accepted: &'static [i16],
}

/// Declares the enum of an option code: its object, its default and, per code, the braking of the axis.
macro_rules! option_code {
    (
        $(#[$doc:meta])*
        $name:ident: $object:literal, $object_name:literal, default $default:ident;
        $($(#[$variant_doc:meta])* $variant:ident = $code:literal => $deceleration:expr,)*
    ) => {
        $(#[$doc])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
        #[repr(i16)]
        pub enum $name { $($(#[$variant_doc])* $variant = $code,)* }

        impl $name {
            /// Every value that the object takes.
            pub const CODES: &[i16] = &[$($code),*];

            /// Braking of the axis; `None` switches the power stage off at once.
            #[must_use]
            pub const fn deceleration(self) -> Option<Deceleration> {
                match self { $(Self::$variant => $deceleration,)* }
            }

            /// Value of the object.
            #[must_use]
            pub const fn code(self) -> i16 {
                self as i16
            }
        }

        impl Default for $name {
            fn default() -> Self {
                Self::$default
            }
        }

        impl TryFrom<i16> for $name {
            type Error = OptionCodeError;

            fn try_from(value: i16) -> Result<Self, OptionCodeError> {
                match value {
                    $($code => Ok(Self::$variant),)*
                    _ => Err(OptionCodeError { object: $object, name: $object_name, value, accepted: Self::CODES }),
                }
            }
        }
    };
}

option_code! {
    /// Quick stop option code (605Ah): braking of transition 11, and the automatic transition 12.
    QuickStopOption: 0x605A, "quick stop option code", default QuickStopRamp;
    /// The power stage is switched off at once.
    Disable = 0 => None,
    /// Then on to Switch on disabled.
    SlowDownRamp = 1 => Some(Deceleration::SlowDownRamp),
    /// Then on to Switch on disabled.
    QuickStopRamp = 2 => Some(Deceleration::QuickStopRamp),
    /// Then on to Switch on disabled.
    CurrentLimit = 3 => Some(Deceleration::CurrentLimit),
    /// Then on to Switch on disabled.
    VoltageLimit = 4 => Some(Deceleration::VoltageLimit),
    /// Then held in Quick stop active.
    SlowDownRampAndStay = 5 => Some(Deceleration::SlowDownRamp),
    /// Then held in Quick stop active.
    QuickStopRampAndStay = 6 => Some(Deceleration::QuickStopRamp),
    /// Then held in Quick stop active.
    CurrentLimitAndStay = 7 => Some(Deceleration::CurrentLimit),
    /// Then held in Quick stop active.
    VoltageLimitAndStay = 8 => Some(Deceleration::VoltageLimit),
}

impl QuickStopOption {
    /// True if the axis is held in Quick stop active, from which transition 16 leads back.
    #[must_use]
    pub const fn stays(self) -> bool {
        self.code() >= 5
    }
}

option_code! {
    /// Shutdown option code (605Bh): braking of transition 8.
    ShutdownOption: 0x605B, "shutdown option code", default Disable;
    /// The power stage is switched off at once.
    Disable = 0 => None,
    /// The transition is taken at standstill.
    SlowDownRamp = 1 => Some(Deceleration::SlowDownRamp),
}

option_code! {
    /// Disable operation option code (605Ch): braking of transition 5.
    DisableOperationOption: 0x605C, "disable operation option code", default SlowDownRamp;
    /// The power stage is switched off at once.
    Disable = 0 => None,
    /// The transition is taken at standstill.
    SlowDownRamp = 1 => Some(Deceleration::SlowDownRamp),
}

option_code! {
    /// Halt option code (605Dh): braking by bit 8 of the controlword; the axis stays in Operation enabled.
    HaltOption: 0x605D, "halt option code", default SlowDownRamp;
    /// Then held.
    SlowDownRamp = 1 => Some(Deceleration::SlowDownRamp),
    /// Then held.
    QuickStopRamp = 2 => Some(Deceleration::QuickStopRamp),
    /// Then held.
    CurrentLimit = 3 => Some(Deceleration::CurrentLimit),
    /// Then held.
    VoltageLimit = 4 => Some(Deceleration::VoltageLimit),
}

option_code! {
    /// Fault reaction option code (605Eh): braking of the axis between transitions 13 and 14.
    FaultReactionOption: 0x605E, "fault reaction option code", default QuickStopRamp;
    /// The power stage is switched off at once.
    Disable = 0 => None,
    /// Then off.
    SlowDownRamp = 1 => Some(Deceleration::SlowDownRamp),
    /// Then off.
    QuickStopRamp = 2 => Some(Deceleration::QuickStopRamp),
    /// Then off.
    CurrentLimit = 3 => Some(Deceleration::CurrentLimit),
    /// Then off.
    VoltageLimit = 4 => Some(Deceleration::VoltageLimit),
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_is_taken_exactly_when_the_object_lists_it() {
        for value in i16::MIN..=i16::MAX {
            assert_eq!(QuickStopOption::try_from(value).is_ok(), (0..=8).contains(&value), "{value}");
            assert_eq!(ShutdownOption::try_from(value).is_ok(), (0..=1).contains(&value), "{value}");
            assert_eq!(DisableOperationOption::try_from(value).is_ok(), (0..=1).contains(&value), "{value}");
            assert_eq!(HaltOption::try_from(value).is_ok(), (1..=4).contains(&value), "{value}");
            assert_eq!(FaultReactionOption::try_from(value).is_ok(), (0..=4).contains(&value), "{value}");
            if let Ok(option) = QuickStopOption::try_from(value) {
                assert_eq!(option.code(), value);
            }
        }
    }

    #[test]
    fn a_refusal_names_object_value_and_what_is_taken() {
        let refusal = ShutdownOption::try_from(7).unwrap_err().to_string();
        assert_eq!(refusal, "shutdown option code (605Bh) must be one of [0, 1], got 7");
    }

    #[test]
    fn a_quick_stop_brakes_alike_whether_the_axis_stays_or_not() {
        for code in 1..=4 {
            let [goes, stays] = [code, code + 4].map(|code| QuickStopOption::try_from(code).unwrap());
            assert_eq!(goes.deceleration(), stays.deceleration());
            assert!(!goes.stays() && stays.stays());
        }
        assert!(!QuickStopOption::Disable.stays());
    }

    #[test]
    fn defaults_are_those_of_the_profile() {
        let defaults = [
            QuickStopOption::default().code(),
            ShutdownOption::default().code(),
            DisableOperationOption::default().code(),
            HaltOption::default().code(),
            FaultReactionOption::default().code(),
        ];
        assert_eq!(defaults, [2, 0, 1, 1, 2]);
    }
}
