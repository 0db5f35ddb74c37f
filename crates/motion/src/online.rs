//! Transitions from any state, planned while the axis moves: to a position at rest, to a position passed at a velocity, to a
//! velocity. Order 2 (trapezoid) is the shortest, in closed form; order 3 (jerk-limited) is as short as Ruckig's; order 4
//! (snap-limited) is the shortest from rest to rest without a cruise, and near it elsewhere.
//!
//! # One idea for every order
//!
//! Between two states of a chain of integrators, let
//!
//! - *away* be the fastest path that gains velocity towards the target: at order 3 to the velocity limit, at order 4 to the largest
//!   acceleration, which is then held,
//! - *home* the fastest path to the target's derivatives, one integrator less: the same problem one order below.
//!
//! A path that follows *away* for a time τ and *home* from there covers the more the longer τ is; the first τ that meets the
//! target is taken. If that would pass the limit, the limit is touched for an instant, with the one value of the highest
//! state for which the target is met; if a touch at rest is not far enough, there is a cruise. So order n is a root in
//! one unknown over order n − 1, and order 2 is two parabolas. If the velocity has a limit and rates that differ by its
//! direction, as in a transition of order 2, `trapezoid` has them.
//!
//! The additional distance of a longer τ is known in closed form (`second::Fastest::grows`, `costate`), so that Newton's method
//! finds each root in a few evaluations, and the inner one, which begins where the last one ended, in fewer.
//!
//! Order 4 needs one addition to order 3: a state may be so near its velocity limit that the fastest path
//! passes it though a slower one does not. `ladder` has the alternatives.
//!
//! # Accelerations that differ
//!
//! By its direction: [`DirectionalLimits`]. While the speed grows and while it falls, as in drives and function blocks:
//! [`RampLimits`], with [`Transition::plan_ramps`].
//!
//! # Passing a target
//!
//! [`passing_velocity`] is the highest velocity at which a target can be passed without turning back, [`braking_velocity`] the
//! one from which a distance is enough to stop.
//!
//! # Cost
//!
//! Of one call, in µs, where `rsruckig` takes 0.39 to rest (median, and the worst of a thousand; `cargo bench --bench online`):
//!
//! | | order 2 | order 3 | order 4 |
//! |---|---|---|---|
//! | [`Transition::plan`], from own plans | 0.2, 0.3 | 0.7, 1.3 | 5, 26 |
//! | [`Transition::plan_ramps`] | 0.2, 0.3 | 1.0, 5 | 6, 130 |
//! | [`passing_velocity`] | 0.3, 0.4 | 0.5, 11 | 3, 200 |
//!
//! The slowest start next to their limits and have to reverse; those of [`passing_velocity`] try plans. From any state within its
//! limits ("from anywhere") order 4 takes 8 and one in a thousand 117, the slowest of the bench 190; with [`Effort::Refined`] 8, 131 and
//! 830.
mod arrival;
mod braking;
mod costate;
mod first;
mod fourth;
mod ladder;
mod newton;
mod passing;
mod path;
mod ramps;
mod second;
mod third;
mod transition;
mod trapezoid;
mod turning;
mod watch;

use crate::limits::{in_range, within_range};
use crate::{Limits, Order, PlanError};
use servobench_base::{ParamError, Stateful, finite, positive};

pub use passing::{braking_velocity, passing_velocity};
pub(crate) use path::Stretch;
pub use ramps::RampLimits;
pub use second::Sides;
pub use transition::Transition;

servobench_config::choices! {
    /// Amount of work for a plan of order 4. Of a thousand random plans all but two are the same with either; the others are of
    /// states too near their velocity limit for the shortest profile.
    pub enum Effort default Fast {
        /// a bounded amount of work, for a control cycle
        Fast = "fast",
        /// more work where that makes the move shorter
        Refined = "refined",
    }
}

/// End of a transition, with neither acceleration nor jerk.
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub enum Target {
    /// At a position (m or rad), passed at a velocity (m/s or rad/s), zero for a stop there.
    Position {
        /// Position.
        x: f64,
        /// Velocity.
        v: f64,
    },
    /// At a velocity (m/s or rad/s), wherever it is reached.
    Velocity(f64),
}

/// Limits of a transition, velocity and acceleration by direction; in the axis unit (m or rad).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DirectionalLimits {
    /// Velocity (m/s or rad/s).
    pub velocity: Sides,
    /// Acceleration (m/s² or rad/s²).
    pub acceleration: Sides,
    /// Jerk (m/s³ or rad/s³), a magnitude; order 2 does not use it.
    pub jerk: f64,
    /// Snap (m/s⁴ or rad/s⁴), a magnitude; orders 2 and 3 do not use it.
    pub snap: f64,
}

impl From<Limits> for DirectionalLimits {
    fn from(limits: Limits) -> Self {
        let Limits { velocity, acceleration, jerk, snap } = limits;
        Self { velocity: Sides::both(velocity), acceleration: Sides::both(acceleration), jerk, snap }
    }
}

impl DirectionalLimits {
    fn check(&self, order: Order) -> Result<(), PlanError> {
        let Self { velocity, acceleration, jerk, snap } = *self;
        let sides = [
            ("velocity.above", velocity.above),
            ("velocity.below", velocity.below),
            ("acceleration.above", acceleration.above),
            ("acceleration.below", acceleration.below),
        ];
        check_limits(order, sides, jerk, snap)
    }
}

/// Checks the four limits of every order by their names, and those of the higher orders.
fn check_limits(order: Order, named: [(&'static str, f64); 4], jerk: f64, snap: f64) -> Result<(), PlanError> {
    let higher = [("jerk", jerk, Order::Third), ("snap", snap, Order::Fourth)];
    for (name, value) in named {
        in_range(name, positive(name, value)?, "correct its unit")?;
    }
    for (name, value, _) in higher.into_iter().filter(|(.., lowest)| order >= *lowest) {
        in_range(name, positive(name, value)?, "correct its unit or plan a lower order")?;
    }
    Ok(())
}

impl Target {
    fn check(&self, velocity: Sides) -> Result<(), PlanError> {
        let v = match self {
            Self::Position { x, v } => {
                within_range("target.x", *x)?;
                finite("target.v", *v)?
            }
            Self::Velocity(v) => finite("target.v", *v)?,
        };
        if velocity.excess(v).0 > 0.0 {
            return Err(ParamError { name: "target.v", value: v, bound: "within the limits of velocity" }.into());
        }
        Ok(())
    }
}
