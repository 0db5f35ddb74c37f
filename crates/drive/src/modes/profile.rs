//! Profile modes: the master gives a target now and then, the drive generates the profile to it.
pub mod effort;
pub mod position;
mod slopes;
pub mod velocity;
mod way;

use servobench_base::{ParamError, positive};
use servobench_motion::Order;

/// Shape of velocity changes (6086h).
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Ramp {
    /// Linearly: the velocity is a trapezoid (0).
    Linear,
    /// With at most this jerk (m/s³ or rad/s³), a magnitude (3).
    JerkLimited(f64),
}

impl Ramp {
    pub(crate) fn check(self) -> Result<(), ParamError> {
        match self {
            Self::Linear => Ok(()),
            Self::JerkLimited(jerk) => positive("profile_jerk", jerk).map(|_| ()),
        }
    }

    const fn order(self) -> Order {
        match self {
            Self::Linear => Order::Second,
            Self::JerkLimited(_) => Order::Third,
        }
    }

    const fn jerk(self) -> f64 {
        match self {
            Self::Linear => f64::INFINITY,
            Self::JerkLimited(jerk) => jerk,
        }
    }
}
