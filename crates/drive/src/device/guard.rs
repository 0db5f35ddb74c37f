//! Guard of the axis ends: no demand continues towards a reached end.
//!
//! An end is reached when its limit switch is on, when a demanded position is beyond the software limit (607Dh), or, without a demanded
//! position, when the axis itself is. A demand towards it is replaced by the quick-stop ramp (6085h) and the axis is held; a demand that
//! leads back is followed again.
use super::Params;
use crate::Demand;
use crate::modes::Moment;
use crate::modes::stop::Ramp;
use servobench_base::Stateful;

/// State from tick to tick.
#[derive(Debug, Clone, Copy, PartialEq, Default, Stateful)]
pub(super) struct State {
    held: Option<Held>,
}

/// An axis held at an end.
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
struct Held {
    /// +1 for the positive end, −1 for the negative one.
    end: f64,
    ramp: Ramp,
}

impl State {
    pub(super) const fn is_active(&self) -> bool {
        self.held.is_some()
    }

    /// Replaces the demand if it continues towards a reached end.
    #[inline]
    pub(super) fn step(&mut self, p: &Params, now: &Moment, demand: &mut Demand) {
        if self.held.is_some() || may_be_reached(p, now) {
            self.hold_back(p, now, demand);
        }
    }

    fn hold_back(&mut self, p: &Params, now: &Moment, demand: &mut Demand) {
        if let Some(held) = &self.held
            && leads_back(held, now, demand)
        {
            self.held = None;
        }
        if self.held.is_none() {
            let end = [1.0, -1.0].into_iter().find(|end| goes_beyond(p, now, demand, *end));
            self.held = end.map(|end| {
                let closes_position = matches!(demand, Demand::Position { .. });
                let deceleration = Some(p.profile.quick_stop_deceleration);
                Held { end, ramp: Ramp::begin(&now.demanded, demand.offsets(), deceleration, closes_position) }
            });
        }
        if let Some(held) = &mut self.held {
            *demand = held.ramp.step(p.period);
        }
    }
}

fn may_be_reached(p: &Params, now: &Moment) -> bool {
    now.actual.positive_limit || now.actual.negative_limit || p.limits.position.is_some()
}

/// True if the demand continues towards a reached end.
fn goes_beyond(p: &Params, now: &Moment, demand: &Demand, end: f64) -> bool {
    let at_switch = if end > 0.0 { now.actual.positive_limit } else { now.actual.negative_limit };
    let is_beyond =
        |x: f64| p.limits.position.is_some_and(|[lowest, highest]| x > highest && end > 0.0 || x < lowest && end < 0.0);
    match demand {
        Demand::Off => false,
        Demand::Position { setpoint, .. } => end * setpoint.v > 0.0 && (at_switch || is_beyond(setpoint.x)),
        Demand::Velocity { setpoint, .. } => {
            end * setpoint.after(now.period).v > 0.0 && (at_switch || is_beyond(now.actual.position))
        }
        Demand::Effort(effort) => end * effort > 0.0 && (at_switch || is_beyond(now.actual.position)),
    }
}

/// True if the demand leads back from the position at which the axis is held.
fn leads_back(held: &Held, now: &Moment, demand: &Demand) -> bool {
    match demand {
        Demand::Off => true,
        Demand::Position { setpoint, .. } => {
            held.end * (setpoint.x - held.ramp.end()) <= 0.0 && held.end * setpoint.v <= 0.0
        }
        Demand::Velocity { setpoint, .. } => held.end * setpoint.after(now.period).v <= 0.0,
        Demand::Effort(effort) => held.end * effort <= 0.0,
    }
}
