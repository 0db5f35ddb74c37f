//! The request of the task to an axis at an instant, from moves, tables and function blocks.
use crate::setpoint::Setpoint;
use crate::state::Stateful;

/// Request of the task to the axis at an instant, not its version after a drive, a master's loop or an interpolation.
///
/// Positions are in the coordinate of the machine and count on over the turns of a modulo axis.
#[derive(Debug, Clone, Copy, PartialEq, Default, Stateful)]
pub enum Request {
    /// Nothing: the drive is not enabled, homes or has a fault.
    #[default]
    Nothing,
    /// To stand still at any position: before the first motion, and after a stop.
    Stand,
    /// To rest at a position (m or rad).
    Rest(f64),
    /// To follow a set-point.
    Follow(Setpoint),
    /// To move at a velocity (m/s or rad/s), without a target position.
    Velocity(f64),
    /// To exert an effort (N·m or N, motor coordinate).
    Effort(f64),
}

/// The kinds of [`Request`], with their names in recordings.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Stateful)]
pub enum RequestKind {
    /// [`Request::Nothing`].
    #[default]
    Nothing,
    /// [`Request::Stand`].
    Stand,
    /// [`Request::Rest`].
    Rest,
    /// [`Request::Follow`].
    Follow,
    /// [`Request::Velocity`].
    Velocity,
    /// [`Request::Effort`].
    Effort,
}

impl Request {
    /// Its kind.
    #[must_use]
    pub const fn kind(&self) -> RequestKind {
        match self {
            Self::Nothing => RequestKind::Nothing,
            Self::Stand => RequestKind::Stand,
            Self::Rest(_) => RequestKind::Rest,
            Self::Follow(_) => RequestKind::Follow,
            Self::Velocity(_) => RequestKind::Velocity,
            Self::Effort(_) => RequestKind::Effort,
        }
    }
}

impl RequestKind {
    /// Every kind.
    pub const ALL: [Self; 6] = [Self::Nothing, Self::Stand, Self::Rest, Self::Follow, Self::Velocity, Self::Effort];

    /// Name in recordings.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Nothing => "nothing",
            Self::Stand => "stand",
            Self::Rest => "rest",
            Self::Follow => "follow",
            Self::Velocity => "velocity",
            Self::Effort => "effort",
        }
    }

    /// The kind of this name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|kind| kind.name() == name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_read_back() {
        for kind in RequestKind::ALL {
            assert_eq!(RequestKind::from_name(kind.name()), Some(kind));
        }
        assert_eq!(RequestKind::from_name("standing"), None);
    }
}
