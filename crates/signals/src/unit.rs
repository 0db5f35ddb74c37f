//! Units of signals.
use crate::equipment::{Amplifier, Equipment};
use std::fmt;

/// The unit of a signal.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Unit {
    /// Unit of the axis, m or rad, per second to this power.
    Axis(u8),
    /// Unit of an effort of the motor: N or N·m.
    MotorEffort,
    /// Unit of an effort on the load: N or N·m.
    LoadEffort,
    /// A.
    Ampere,
    /// V.
    Volt,
    /// W.
    Watt,
    /// °C.
    Celsius,
    /// Unit of the output of an ideal source: V, or that of its effort.
    Output,
    /// A pure number.
    One,
}

const POWERS: [&str; 5] = ["", "/s", "/s²", "/s³", "/s⁴"];

impl Unit {
    /// Its symbol on an axis with `equipment`; empty for a pure number.
    #[must_use]
    pub fn symbol(self, equipment: &Equipment) -> String {
        match self {
            Self::Axis(power) => format!("{}{}", equipment.axis.unit(), POWERS[usize::from(power)]),
            Self::MotorEffort => equipment.motor_coordinate.effort_unit().into(),
            Self::LoadEffort => equipment.axis.effort_unit().into(),
            Self::Ampere => "A".into(),
            Self::Volt => "V".into(),
            Self::Watt => "W".into(),
            Self::Celsius => "°C".into(),
            Self::Output => match equipment.amplifier {
                Some(Amplifier::Ideal { output_unit }) => output_unit.into(),
                Some(Amplifier::Current) | None => String::new(),
            },
            Self::One => String::new(),
        }
    }
}

/// For any axis: U is its unit, E that of the motor's effort, F that of an effort on the load.
impl fmt::Display for Unit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Axis(power) => write!(f, "U{}", POWERS[usize::from(*power)]),
            Self::MotorEffort => f.write_str("E"),
            Self::LoadEffort => f.write_str("F"),
            Self::Ampere => f.write_str("A"),
            Self::Volt => f.write_str("V"),
            Self::Watt => f.write_str("W"),
            Self::Celsius => f.write_str("°C"),
            Self::Output => f.write_str("V or E"),
            Self::One => f.write_str("1"),
        }
    }
}
