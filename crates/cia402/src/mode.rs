//! Modes of operation (6060h, 6061h).

use servobench_base::Stateful;
/// A supported mode of operation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Stateful)]
#[repr(i8)]
pub enum Mode {
    /// The drive plans a move to each target position (pp).
    ProfilePosition = 1,
    /// The drive ramps to each target velocity (pv).
    ProfileVelocity = 3,
    /// The drive ramps to each target torque (tq).
    ProfileTorque = 4,
    /// The drive searches for its reference (hm).
    Homing = 6,
    /// The drive interpolates between the points of a buffer (ip).
    InterpolatedPosition = 7,
    /// The master commands a position every cycle (csp).
    CyclicSynchronousPosition = 8,
    /// The master commands a velocity every cycle (csv).
    CyclicSynchronousVelocity = 9,
    /// The master commands a torque every cycle (cst).
    CyclicSynchronousTorque = 10,
}

impl Mode {
    /// Every mode, in the order of the codes.
    pub const ALL: [Self; 8] = [
        Self::ProfilePosition,
        Self::ProfileVelocity,
        Self::ProfileTorque,
        Self::Homing,
        Self::InterpolatedPosition,
        Self::CyclicSynchronousPosition,
        Self::CyclicSynchronousVelocity,
        Self::CyclicSynchronousTorque,
    ];

    /// The mode with this code; `None` for unsupported ones, to which a drive does not switch.
    #[must_use]
    pub fn from_code(code: i8) -> Option<Self> {
        Self::ALL.into_iter().find(|mode| mode.code() == code)
    }

    /// Value of 6060h.
    #[must_use]
    pub const fn code(self) -> i8 {
        self as i8
    }

    /// Abbreviation in the profile.
    #[must_use]
    pub const fn abbreviation(self) -> &'static str {
        match self {
            Self::ProfilePosition => "pp",
            Self::ProfileVelocity => "pv",
            Self::ProfileTorque => "tq",
            Self::Homing => "hm",
            Self::InterpolatedPosition => "ip",
            Self::CyclicSynchronousPosition => "csp",
            Self::CyclicSynchronousVelocity => "csv",
            Self::CyclicSynchronousTorque => "cst",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_are_those_of_the_profile() {
        let known: Vec<_> = (i8::MIN..=i8::MAX).filter_map(Mode::from_code).map(Mode::code).collect();
        assert_eq!(known, [1, 3, 4, 6, 7, 8, 9, 10]);
    }
}
