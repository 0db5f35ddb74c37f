//! Plans trajectories from the inputs of a block, the limits of the axis and the override factors.
//!
//! Acceleration is for a rising speed, Deceleration for a falling one. An axis that turns round uses both in the same direction:
//! [`Transition::plan_ramps`] documents how both are kept.
use crate::command::Dynamics;
use servobench_base::{Setpoint, Stateful};
use servobench_motion::online::{Effort, RampLimits, Sides, Target, Transition};
use servobench_motion::{Limits, Order, PlanError};

/// The factors of MC_SetOverride.
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub(crate) struct Override {
    pub(crate) velocity: f64,
    pub(crate) acceleration: f64,
    pub(crate) jerk: f64,
}

impl Override {
    pub(crate) const NONE: Self = Self { velocity: 1.0, acceleration: 1.0, jerk: 1.0 };
}

/// Bounds of a trajectory, magnitudes.
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub(crate) struct Bounds {
    pub(crate) velocity: f64,
    pub(crate) acceleration: f64,
    pub(crate) deceleration: f64,
    /// Infinite at order 2.
    pub(crate) jerk: f64,
    /// Infinite at orders 2 and 3.
    pub(crate) snap: f64,
}

impl Bounds {
    pub(crate) fn of(dynamics: &Dynamics, limits: &Limits, factors: &Override) -> Self {
        Self {
            velocity: dynamics.velocity.unwrap_or(limits.velocity) * factors.velocity,
            acceleration: dynamics.acceleration * factors.acceleration,
            deceleration: dynamics.deceleration * factors.acceleration,
            jerk: dynamics.jerk.unwrap_or(limits.jerk) * factors.jerk,
            snap: dynamics.snap.unwrap_or(limits.snap) * factors.jerk,
        }
    }

    /// Full bounds of the axis.
    pub(crate) const fn of_axis(limits: &Limits) -> Self {
        let Limits { velocity, acceleration, jerk, snap } = *limits;
        Self { velocity, acceleration, deceleration: acceleration, jerk, snap }
    }

    /// The same bounds with room for `speed`.
    pub(crate) fn faster(self, speed: f64) -> Self {
        Self { velocity: self.velocity.max(speed), ..self }
    }

    /// Bounds of the same trajectory run backwards.
    pub(crate) const fn backwards(self) -> Self {
        Self { acceleration: self.deceleration, deceleration: self.acceleration, ..self }
    }

    pub(crate) fn order(&self) -> Order {
        if self.snap < f64::INFINITY {
            Order::Fourth
        } else if self.jerk < f64::INFINITY {
            Order::Third
        } else {
            Order::Second
        }
    }

    pub(crate) const fn limits(&self) -> RampLimits {
        let Self { velocity, acceleration, deceleration, jerk, snap } = *self;
        RampLimits { velocity: Sides::both(velocity), acceleration, deceleration, jerk, snap }
    }

    /// Trajectory from `from` to `target`.
    pub(crate) fn plan(&self, from: &Setpoint, target: &Target) -> Result<Transition, PlanError> {
        Transition::plan_ramps(self.order(), from, target, &self.limits(), Effort::Fast)
    }

    /// Distance covered from `from` until the velocity is `v`.
    pub(crate) fn covered(&self, from: &Setpoint, v: f64) -> Result<f64, PlanError> {
        let way = self.plan(from, &Target::Velocity(v))?;
        Ok(way.at(way.duration()).x - from.x)
    }
}
