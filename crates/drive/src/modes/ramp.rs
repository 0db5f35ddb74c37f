//! Ramp from one velocity to another within an acceleration and a jerk: for legs of a search, and stops.
use super::Moment;
use servobench_base::{ParamError, Setpoint, Stateful, positive};
use servobench_motion::online::{DirectionalLimits, Effort, Sides, Target, Transition};
use servobench_motion::{Order, PlanError};

/// Steepness of a ramp, in both directions.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Steepness {
    /// Acceleration and deceleration (m/s² or rad/s²).
    pub acceleration: f64,
    /// Jerk (m/s³ or rad/s³); without it the velocity is a trapezoid.
    pub jerk: Option<f64>,
}

impl Steepness {
    /// # Errors
    /// [`ParamError`] names the first value that is not positive.
    pub fn check(&self) -> Result<(), ParamError> {
        positive("acceleration", self.acceleration)?;
        self.jerk.map_or(Ok(0.0), |jerk| positive("jerk", jerk)).map(|_| ())
    }
}

/// The present ramp and its progress.
#[derive(Debug, Clone, Copy, PartialEq, Default, Stateful)]
pub(super) struct Ramp {
    way: Option<Transition>,
    /// Target velocity.
    velocity: f64,
    /// Time since the beginning (s).
    since: f64,
    /// Last set-point.
    last: Setpoint,
}

impl Ramp {
    /// Present set-point on the ramp to `velocity`. If the demand on the loops differs from the last set-point, the ramp restarts from
    /// there.
    ///
    /// # Errors
    /// [`PlanError`] if the demand is not a valid state of motion.
    #[inline]
    pub(super) fn step(
        &mut self,
        steepness: &Steepness,
        velocity: f64,
        moment: &Moment,
    ) -> Result<Setpoint, PlanError> {
        let demanded = moment.demanded;
        if velocity == 0.0 && demanded.v == 0.0 && demanded.a == 0.0 {
            return Ok(Setpoint::at_rest(demanded.x));
        }
        let own = self.way.as_ref().filter(|_| self.last.after(moment.period) == demanded);
        let since = self.since + moment.period;
        let now = own.map_or(demanded, |way| way.at(since));
        #[expect(clippy::float_cmp, reason = "whether it is the same request, not whether it is near")]
        let goes_on = own.is_some() && self.velocity == velocity;
        if goes_on {
            (self.since, self.last) = (since, now);
        } else {
            self.begin(steepness, velocity, &now)?;
        }
        Ok(self.last)
    }

    /// Plans a new ramp; separate from the ordinary step, whose frame has no room for a plan.
    #[inline(never)]
    fn begin(&mut self, steepness: &Steepness, velocity: f64, now: &Setpoint) -> Result<(), PlanError> {
        let way = plan(steepness, velocity, now)?;
        *self = Self { way: Some(way), velocity, since: 0.0, last: way.at(0.0) };
        Ok(())
    }
}

/// Velocity limit of a plan: a ramp from one velocity to another needs no limit between them.
const UNLIMITED: f64 = 1e30;

fn plan(steepness: &Steepness, velocity: f64, from: &Setpoint) -> Result<Transition, PlanError> {
    let order = if steepness.jerk.is_some() { Order::Third } else { Order::Second };
    let limits = DirectionalLimits {
        velocity: Sides::both(UNLIMITED),
        acceleration: Sides::both(steepness.acceleration),
        jerk: steepness.jerk.unwrap_or(UNLIMITED),
        snap: UNLIMITED,
    };
    Transition::plan(order, from, &Target::Velocity(velocity), &limits, Effort::Fast)
}
