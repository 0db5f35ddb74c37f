//! Profile velocity (pv): the velocity approaches its target (60FFh) at the profile's acceleration (6083h) away from zero and at its
//! deceleration (6084h) towards zero, linearly or jerk-limited (6086h).
//!
//! | bit | set |
//! |---|---|
//! | 10, target reached | while the velocity has been within its window (606Dh) around the target for the time 606Eh |
//! | 12, speed | unless the velocity has been above its threshold (606Fh) for the time 6070h: the axis stands |
//! | 13, maximum slippage | never: not supported |
//!
//! A target beyond the highest velocity is cut to it (bit 11).
use super::Ramp;
use super::slopes::Slopes;
use super::way::Way;
use crate::Demand;
use crate::device::{Dwell, Window};
use crate::modes::{Answer, Moment};
use servobench_base::{Setpoint, Stateful};
use servobench_motion::online::{Effort, RampLimits, Sides, Target, Transition};

/// Highest velocity (m/s or rad/s) of a plan without a limit.
const UNLIMITED: f64 = 1e30;

/// Ramps, limit and windows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Params {
    /// Motion profile type (6086h).
    pub ramp: Ramp,
    /// Highest velocity (the lower of 607Fh and 6080h), a magnitude; may be infinite.
    pub limit: f64,
    /// Velocity window and time (606Dh, 606Eh).
    pub window: Window,
    /// Velocity threshold and time (606Fh, 6070h).
    pub threshold: Window,
}

/// State from tick to tick.
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub struct State {
    /// Velocity of the next step, on linear ramps.
    velocity: f64,
    /// Profile to the target, if jerk-limited, and the basis of its plan: the bits of target, acceleration and deceleration.
    way: Option<Way>,
    planned_for: [u64; 3],
    /// Expected velocity demand at the next step; a different one comes from outside the mode, which then continues from there.
    expected: f64,
    within_window: Dwell,
    above_threshold: Dwell,
    is_limited: bool,
}

impl State {
    /// Continues from the present velocity.
    #[must_use]
    pub fn begin(now: &Moment) -> Self {
        Self {
            velocity: now.demanded.v,
            way: None,
            planned_for: [0; 3],
            expected: now.demanded.v,
            within_window: Dwell::default(),
            above_threshold: Dwell::default(),
            is_limited: false,
        }
    }

    /// Continues after a halt, from the velocity at its end.
    pub fn resume(&mut self, now: &Moment) {
        *self = Self { above_threshold: self.above_threshold, ..Self::begin(now) };
    }

    /// Executes a step; returns true if the axis stands (bit 12), whatever moves it.
    pub fn stands(&mut self, p: &Params, now: &Moment) -> bool {
        !self.above_threshold.step(!p.threshold.holds(now.actual.velocity), p.threshold.time, now.period)
    }

    /// True if the target is beyond the highest velocity.
    #[must_use]
    pub const fn is_limited(&self) -> bool {
        self.is_limited
    }

    fn linear(&mut self, now: &Moment, goes_on: bool, target: f64) -> Setpoint {
        let slopes = Slopes { away: now.targets.profile_acceleration, back: now.targets.profile_deceleration };
        let velocity = if goes_on { self.velocity } else { now.demanded.v };
        self.velocity = slopes.next(velocity, target, now.period);
        Setpoint { v: velocity, a: (self.velocity - velocity) / now.period, ..Setpoint::at_rest(0.0) }
    }

    /// Jerk-limited set-point; without a plan the velocity stays, and the drive reports a limit.
    fn jerk_limited(&mut self, p: &Params, now: &Moment, goes_on: bool, target: f64) -> Setpoint {
        let [acceleration, deceleration] = [now.targets.profile_acceleration, now.targets.profile_deceleration];
        let asked = [target, acceleration, deceleration].map(f64::to_bits);
        if !goes_on || asked != self.planned_for || self.way.is_none() {
            let velocity = Sides::both(p.limit.min(UNLIMITED));
            let limits = RampLimits { velocity, acceleration, deceleration, jerk: p.ramp.jerk(), snap: f64::INFINITY };
            let to = Target::Velocity(target);
            let planned = Transition::plan_ramps(p.ramp.order(), &now.demanded, &to, &limits, Effort::Fast);
            self.is_limited |= planned.is_err();
            self.way = planned.ok().as_ref().map(Way::along);
            self.planned_for = asked;
        }
        let stays = Setpoint { v: now.demanded.v, ..Setpoint::at_rest(0.0) };
        self.way.as_mut().map_or(stays, |way| way.next(now.period).0)
    }
}

/// Demand of a step.
#[inline]
pub fn step(p: &Params, x: &mut State, now: &Moment) -> Answer {
    let Moment { targets, actual, period, .. } = now;
    let target = targets.velocity.clamp(-p.limit, p.limit);
    x.is_limited = targets.velocity.abs() > p.limit;
    let goes_on = now.demanded.v.to_bits() == x.expected.to_bits();
    let ramp = match p.ramp {
        Ramp::Linear => x.linear(now, goes_on, target),
        Ramp::JerkLimited(_) => x.jerk_limited(p, now, goes_on, target),
    };
    let setpoint = Setpoint { x: actual.position, ..ramp };
    x.expected = setpoint.after(*period).v;
    let error = actual.velocity - targets.velocity;
    Answer {
        demand: Demand::Velocity { setpoint, effort_offset: 0.0 },
        target_reached: x.within_window.step(p.window.holds(error), p.window.time, *period),
        bit_12: x.stands(p, now),
        bit_13: false,
    }
}
