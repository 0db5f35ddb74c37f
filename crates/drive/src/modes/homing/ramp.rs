//! From one velocity to another within the homing acceleration.
use super::Params;
use crate::modes::Moment;
use servobench_base::Setpoint;
use servobench_motion::online::{DirectionalLimits, Effort, Sides, Target, Transition};
use servobench_motion::{Order, PlanError};

/// The ramp under way, and how far it is.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Ramp {
    way: Option<Transition>,
    /// Velocity that it leads to.
    velocity: f64,
    /// Time since it began (s).
    since: f64,
    /// The last set-point.
    last: Setpoint,
}

impl Ramp {
    /// The set-point of now on the way to `velocity`.
    ///
    /// # Errors
    /// [`PlanError`] when what the loops follow is no state of motion.
    pub(super) fn step(&mut self, params: &Params, velocity: f64, moment: &Moment) -> Result<Setpoint, PlanError> {
        // When the loops follow something else meanwhile, the ramp begins anew from there.
        let own = self.way.as_ref().filter(|_| self.last.after(moment.period) == moment.demanded);
        let since = self.since + moment.period;
        let now = own.map_or(moment.demanded, |way| way.at(since));
        #[expect(clippy::float_cmp, reason = "whether it is the same request, not whether it is near")]
        let goes_on = own.is_some() && self.velocity == velocity;
        if goes_on {
            (self.since, self.last) = (since, now);
        } else if velocity == 0.0 && now.v == 0.0 && now.a == 0.0 {
            self.way = None;
            self.last = Setpoint::at_rest(now.x);
        } else {
            let way = plan(params, velocity, &now)?;
            *self = Self { way: Some(way), velocity, since: 0.0, last: way.at(0.0) };
        }
        Ok(self.last)
    }
}

fn plan(params: &Params, velocity: f64, from: &Setpoint) -> Result<Transition, PlanError> {
    let order = if params.jerk.is_some() { Order::Third } else { Order::Second };
    let limits = DirectionalLimits {
        velocity: Sides::both(params.switch_speed.max(params.zero_speed)),
        acceleration: Sides::both(params.acceleration),
        jerk: params.jerk.unwrap_or(f64::INFINITY),
        snap: f64::INFINITY,
    };
    Transition::plan(order, from, &Target::Velocity(velocity), &limits, Effort::Fast)
}
