//! Limits of a move, and the order of the profile that respects them.
use crate::PlanError;
use servobench_base::{ParamError, Stateful, positive};
use servobench_config::Kind::Axis;
use servobench_config::quantities::{ACCELERATION, JERK, SNAP, VELOCITY};

/// Order of a rest-to-rest profile: the derivative of position that is piecewise constant.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Stateful)]
pub enum Order {
    /// Trapezoidal velocity: acceleration switches, jerk is not limited.
    Second,
    /// Jerk-limited ("S-curve"): jerk switches, snap is not limited.
    Third,
    /// Snap-limited: snap switches.
    Fourth,
}

impl Order {
    /// The order whose `derivative` is piecewise constant, the inverse of [`Order::derivative`]; `None` except for 2, 3, 4.
    #[must_use]
    pub const fn from_derivative(derivative: u8) -> Option<Self> {
        match derivative {
            2 => Some(Self::Second),
            3 => Some(Self::Third),
            4 => Some(Self::Fourth),
            _ => None,
        }
    }

    /// The derivative that is piecewise constant, and the number of moving averages: 2, 3 or 4.
    #[must_use]
    pub const fn derivative(self) -> usize {
        match self {
            Self::Second => 2,
            Self::Third => 3,
            Self::Fourth => 4,
        }
    }
}

servobench_config::parameters! {
    /// A limit of moves, a magnitude.
    pub enum LimitParameter {
        /// Largest velocity
        VELOCITY "velocity" = servobench_config::positive(Axis(&VELOCITY), "30 m/min");
        /// Largest acceleration
        ACCELERATION "acceleration" = servobench_config::positive(Axis(&ACCELERATION), "5 m/s2");
        /// Largest jerk
        JERK "jerk" = servobench_config::positive(Axis(&JERK), "50 m/s3");
        /// Largest snap
        SNAP "snap" = servobench_config::positive(Axis(&SNAP), "1000 m/s4");
        /// Largest velocity below zero, of moves that are planned in motion
        NEGATIVE_VELOCITY "negative velocity" = servobench_config::positive(Axis(&VELOCITY), "20 m/min");
        /// Largest acceleration below zero, of moves that are planned in motion
        NEGATIVE_ACCELERATION "negative acceleration" = servobench_config::positive(Axis(&ACCELERATION), "4 m/s2");
    }
}

/// Limits of a move as magnitudes, in the axis unit (m or rad).
///
/// A profile of order n uses the first n of them and ignores the others. `f64::INFINITY` means "no limit" for all but
/// the n-th, which the profile needs as its amplitude.
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub struct Limits {
    /// Velocity (m/s or rad/s).
    pub velocity: f64,
    /// Acceleration (m/s² or rad/s²).
    pub acceleration: f64,
    /// Jerk (m/s³ or rad/s³).
    pub jerk: f64,
    /// Snap (m/s⁴ or rad/s⁴).
    pub snap: f64,
}

/// Smallest and largest accepted magnitude (SI) in a request. Between them no product of four lengths of averages, limits
/// or sample times leaves the normal range of `f64`, so that every plan is finite.
pub(crate) const RANGE: (f64, f64) = (1e-30, 1e30);

impl Limits {
    /// No limits: the base for `Limits { velocity: 1.0, acceleration: 5.0, ..Limits::UNLIMITED }`.
    pub const UNLIMITED: Self =
        Self { velocity: f64::INFINITY, acceleration: f64::INFINITY, jerk: f64::INFINITY, snap: f64::INFINITY };

    /// The limits that `order` uses, from its highest derivative down to velocity; the rest is infinite.
    ///
    /// # Errors
    /// [`PlanError`] names the first limit that is not positive or out of range.
    pub(crate) fn descending(&self, order: Order) -> Result<[f64; 4], PlanError> {
        let n = order.derivative();
        let named = [
            (LimitParameter::VELOCITY.name, self.velocity),
            (LimitParameter::ACCELERATION.name, self.acceleration),
            (LimitParameter::JERK.name, self.jerk),
            (LimitParameter::SNAP.name, self.snap),
        ];
        let mut bounds = [f64::INFINITY; 4];
        for (k, (name, value)) in named.into_iter().enumerate().take(n) {
            bounds[n - 1 - k] = if k + 1 == n {
                in_range(name, positive(name, value)?, "correct its unit or plan a lower order")?
            } else if value >= RANGE.0 {
                value
            } else if value > 0.0 {
                in_range(name, value, "correct its unit")?
            } else {
                return Err(ParamError { name, value, bound: "positive" }.into());
            };
        }
        Ok(bounds)
    }
}

/// Returns `value` when its magnitude lies in [`RANGE`].
///
/// # Errors
/// [`PlanError::OutOfRange`] otherwise.
pub(crate) fn in_range(name: &'static str, value: f64, remedy: &'static str) -> Result<f64, PlanError> {
    let (lowest, highest) = RANGE;
    if (lowest..=highest).contains(&value.abs()) {
        Ok(value)
    } else {
        Err(PlanError::OutOfRange { name, value, lowest, highest, remedy })
    }
}

/// Returns `value`, of either sign or zero, when its magnitude is not above [`RANGE`].
///
/// # Errors
/// [`ParamError`] otherwise.
pub(crate) fn within_range(name: &'static str, value: f64) -> Result<f64, ParamError> {
    if value.abs() <= RANGE.1 { Ok(value) } else { Err(ParamError { name, value, bound: "a number within ±1e30" }) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn descending_starts_at_the_highest_derivative_and_ignores_the_rest() {
        let limits = Limits { velocity: 1.0, acceleration: 2.0, jerk: 3.0, snap: f64::NAN };
        assert_eq!(limits.descending(Order::Third).unwrap()[..], [3.0, 2.0, 1.0, f64::INFINITY]);
        assert_eq!(limits.descending(Order::Second).unwrap()[..2], [2.0, 1.0]);
        assert!(limits.descending(Order::Fourth).is_err());
    }

    #[test]
    fn an_order_is_known_by_its_derivative() {
        for derivative in 0..=u8::MAX {
            let order = Order::from_derivative(derivative);
            assert_eq!(order.is_some(), (2..=4).contains(&derivative), "{derivative}");
            assert!(order.is_none_or(|order| order.derivative() == usize::from(derivative)), "{order:?}");
        }
    }

    #[test]
    fn only_the_highest_used_limit_must_be_finite() {
        let jerk_only = Limits { jerk: 3.0, ..Limits::UNLIMITED };
        assert!(jerk_only.descending(Order::Third).is_ok());
        let e = jerk_only.descending(Order::Fourth).unwrap_err();
        assert_eq!(e.to_string(), "`snap` must be finite and positive, got inf");
        for bad in [0.0, -0.0, -1.0, f64::NAN, f64::NEG_INFINITY, 1e-31, f64::MIN_POSITIVE / 2.0] {
            assert!(Limits { velocity: bad, ..jerk_only }.descending(Order::Third).is_err(), "{bad}");
        }
    }
}
