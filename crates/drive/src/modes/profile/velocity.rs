//! Profile velocity (pv): the velocity goes linearly to its target (60FFh), by the profile's acceleration (6083h) away from
//! zero and by its deceleration (6084h) towards zero.
//!
//! | bit | is set |
//! |---|---|
//! | 10, target reached | while the velocity has been within its window (606Dh) around the target for the time 606Eh |
//! | 12, speed | unless the velocity has been above its threshold (606Fh) for the time 6070h: the axis stands |
//! | 13, maximum slippage | never: there is none |
//!
//! A target beyond the highest velocity is approached as far as that (bit 11).
use super::ramp::Slopes;
use crate::Demand;
use crate::device::{Dwell, Window};
use crate::modes::{Answer, Moment};
use servobench_base::Setpoint;

/// Limit and windows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Params {
    /// Highest velocity (the lower of 607Fh and 6080h), a magnitude; may be infinite.
    pub limit: f64,
    /// Velocity window and time (606Dh, 606Eh).
    pub window: Window,
    /// Velocity threshold and time (606Fh, 6070h).
    pub threshold: Window,
}

/// All that a snapshot must hold.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct State {
    /// Velocity of the next step.
    velocity: f64,
    /// What the loops follow then, up to a rounding the same; anything else was asked of them by others, and is gone on from.
    expected: f64,
    within_window: Dwell,
    above_threshold: Dwell,
    is_limited: bool,
}

impl State {
    /// Goes on from the velocity of now.
    #[must_use]
    pub fn begin(now: &Moment) -> Self {
        Self {
            velocity: now.demanded.v,
            expected: now.demanded.v,
            within_window: Dwell::default(),
            above_threshold: Dwell::default(),
            is_limited: false,
        }
    }

    /// Whether the target is beyond the highest velocity.
    #[must_use]
    pub const fn is_limited(&self) -> bool {
        self.is_limited
    }
}

/// The demand of a step.
#[inline]
pub fn step(p: &Params, x: &mut State, now: &Moment) -> Answer {
    let Moment { targets, actual, period, .. } = now;
    let target = targets.velocity.clamp(-p.limit, p.limit);
    x.is_limited = targets.velocity.abs() > p.limit;
    let slopes = Slopes { away: targets.profile_acceleration, back: targets.profile_deceleration };
    let goes_on = now.demanded.v.to_bits() == x.expected.to_bits();
    let velocity = if goes_on { x.velocity } else { now.demanded.v };
    let next = slopes.next(velocity, target, *period);
    let setpoint = Setpoint { v: velocity, a: (next - velocity) / period, ..Setpoint::at_rest(actual.position) };
    (x.velocity, x.expected) = (next, setpoint.after(*period).v);
    Answer {
        demand: Demand::Velocity { setpoint, effort_offset: 0.0 },
        target_reached: x.within_window.step(
            p.window.holds(actual.velocity - targets.velocity),
            p.window.time,
            *period,
        ),
        bit_12: !x.above_threshold.step(!p.threshold.holds(actual.velocity), p.threshold.time, *period),
        bit_13: false,
    }
}
