//! One set-point: the profile of its frame, and plans within that profile.
use super::Params;
use crate::modes::Targets;
use servobench_base::{Setpoint, Stateful};
use servobench_motion::PlanError;
use servobench_motion::online::{Effort, RampLimits, Sides, Target, Transition, passing_velocity};

/// A target with its profile.
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub(super) struct SetPoint {
    pub(super) x: f64,
    pub(super) velocity: f64,
    acceleration: f64,
    deceleration: f64,
}

impl SetPoint {
    /// Set-point at `x`, with the profile of a frame.
    pub(super) const fn at(x: f64, targets: &Targets) -> Self {
        Self {
            x,
            velocity: targets.profile_velocity,
            acceleration: targets.profile_acceleration,
            deceleration: targets.profile_deceleration,
        }
    }

    fn limits(&self, p: &Params) -> RampLimits {
        RampLimits {
            velocity: Sides::both(self.velocity),
            acceleration: self.acceleration,
            deceleration: self.deceleration,
            jerk: p.ramp.jerk(),
            snap: f64::INFINITY,
        }
    }

    /// # Errors
    /// [`PlanError`] if the state or the profile allow no plan.
    pub(super) fn plan(&self, p: &Params, from: &Setpoint, target: &Target) -> Result<Transition, PlanError> {
        Transition::plan_ramps(p.ramp.order(), from, target, &self.limits(p), Effort::Fast)
    }

    /// Velocity at which the set-point is passed: `most` at most, zero if the axis would have to turn back for more.
    ///
    /// # Errors
    /// As [`plan`](Self::plan).
    pub(super) fn passing(&self, p: &Params, from: &Setpoint, most: f64) -> Result<f64, PlanError> {
        if most == 0.0 {
            return Ok(0.0);
        }
        let sign = if self.x >= from.x { 1.0 } else { -1.0 };
        let limits = self.limits(p).towards(sign);
        Ok(passing_velocity(p.ramp.order(), from, self.x, &limits, most)?.map_or(0.0, |speed| sign * speed))
    }
}
