//! Profile position (pp): the drive plans a move to each set-point.
//!
//! # The handshake
//!
//! | | bit | |
//! |---|---|---|
//! | controlword | 4, new set-point | its rising edge gives the target position with the profile of the frame |
//! | | 5, change set immediately | the set-point replaces the active and the waiting one |
//! | | 6, relative | the target is a distance from the target before it (60F2h = 0) |
//! | | 9, change on set-point | the axis passes the active set-point at its profile velocity, without a stop, and continues to this one |
//! | statusword | 10, target reached | the axis has been within the position window (6067h) for its time (6068h) and no set-point waits |
//! | | 12, set-point acknowledge | set when a set-point is accepted; cleared when bit 4 is cleared and another one would be accepted |
//!
//! One set-point may wait while another one is active. A further one is not accepted: bit 12 was not cleared to invite it, and the edge is
//! lost. While the axis is halted no set-point is accepted, but bit 12 falls as usual. Afterwards the move continues, and an edge whose bit
//! 4 is still set is accepted.
//!
//! On an axis whose positions repeat, an absolute target is at the end of a [`Turn`] from the demanded position, or, for a set-point that
//! has to wait, from the target before it. With a prescribed direction (60F2h) a target may be too close for a moving axis to stop there:
//! the axis passes it, and comes back.
//!
//! # The profile
//!
//! Ramps are linear or jerk-limited (6086h), from any state of motion. The profile's acceleration applies while the speed rises, its
//! deceleration while it falls. A target is passed at the end velocity (6082h), or slower if the distance is too short for it, and a
//! set-point without a stop (bit 9) likewise at the profile velocity: the axis never turns back to gain a run-up.
mod set_point;
mod turn;

use super::Ramp;
use super::way::Way;
use crate::Demand;
use crate::device::{Dwell, Window};
use crate::modes::{Answer, Moment};
use servobench_base::{ParamError, Setpoint, Stateful, non_negative};
use servobench_cia402::ControlBit;
use servobench_motion::online::Target;
use set_point::SetPoint;

pub use turn::Turn;

/// Settings that do not come with a set-point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Params {
    /// Motion profile type (6086h).
    pub ramp: Ramp,
    /// Velocity at which a target is passed (6082h), a magnitude; zero to stop there.
    pub end_velocity: f64,
    /// Position window and time (6067h, 6068h).
    pub window: Window,
    /// Lowest and highest target (607Dh).
    pub range: Option<[f64; 2]>,
    /// Path to an absolute target on an axis whose positions repeat; `None` for the direct one.
    pub turn: Option<Turn>,
}

impl Params {
    /// # Errors
    /// [`ParamError`] names the first parameter out of its bound.
    pub fn check(&self) -> Result<(), ParamError> {
        self.ramp.check()?;
        non_negative("end_velocity", self.end_velocity).map(|_| ())
    }
}

/// Bit 4 of the last controlword and bit 12 of the statusword.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Stateful)]
struct Handshake {
    asks: bool,
    acknowledges: bool,
}

fn asks(now: &Moment) -> bool {
    now.targets.controlword.has(ControlBit::ModeSpecific4)
}

/// State from tick to tick.
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub struct State {
    way: Option<Way>,
    /// Position at which the axis is held without a profile.
    rest: f64,
    active: Option<SetPoint>,
    waiting: Option<SetPoint>,
    /// True if the active set-point is passed without a stop on the way to the waiting one.
    is_passed: bool,
    /// Origin of a relative set-point.
    target: f64,
    handshake: Handshake,
    within_window: Dwell,
    is_limited: bool,
}

impl State {
    /// Stops a moving axis and waits for a set-point: a bit 4 that is already set gives none.
    #[must_use]
    pub fn begin(p: &Params, now: &Moment) -> Self {
        let mut state = Self {
            way: None,
            rest: now.demanded.x,
            active: None,
            waiting: None,
            is_passed: false,
            target: now.demanded.x,
            handshake: Handshake { asks: asks(now), acknowledges: false },
            within_window: Dwell::default(),
            is_limited: false,
        };
        state.stop(p, now);
        state
    }

    /// Continues after a halt, from the remaining motion.
    pub fn resume(&mut self, p: &Params, now: &Moment) {
        (self.way, self.rest) = (None, now.demanded.x);
        match self.active {
            Some(active) => self.go_to(p, &active, &now.demanded),
            None => self.stop(p, now),
        }
    }

    /// Executes a step of a halt; returns true if the last set-point is acknowledged. A cleared bit 4 is registered, a set one waits for
    /// the end of the halt.
    pub fn halted(&mut self, now: &Moment) -> bool {
        self.handshake.asks &= asks(now);
        self.release();
        self.handshake.acknowledges
    }

    /// Ends the acknowledgement when bit 4 is cleared and another set-point would be accepted.
    const fn release(&mut self) {
        if !self.handshake.asks && self.waiting.is_none() {
            self.handshake.acknowledges = false;
        }
    }

    /// Begins to brake to standstill, which becomes the target.
    fn stop(&mut self, p: &Params, now: &Moment) {
        let brake = SetPoint::at(now.demanded.x, &now.targets);
        if let Ok(transition) = brake.plan(p, &now.demanded, &Target::Velocity(0.0)) {
            self.target = transition.at(f64::INFINITY).x;
            self.way = Some(Way::along(&transition));
        }
    }

    /// True if the last target was cut to the software limits, or could not be planned.
    #[must_use]
    pub const fn is_limited(&self) -> bool {
        self.is_limited
    }

    /// Accepts a new set-point.
    fn take(&mut self, p: &Params, now: &Moment) {
        let targets = &now.targets;
        let has = |bit| targets.controlword.has(bit);
        let at_once = has(ControlBit::ModeSpecific5) || self.active.is_none();
        if !at_once && self.waiting.is_some() {
            return;
        }
        let asked = match &p.turn {
            _ if has(ControlBit::ModeSpecific6) => self.target + targets.distance,
            Some(turn) => turn.target(if at_once { now.demanded.x } else { self.target }, targets.distance),
            None => targets.position,
        };
        self.target = p.range.map_or(asked, |[lowest, highest]| asked.clamp(lowest, highest));
        self.is_limited = self.target.to_bits() != asked.to_bits();
        self.handshake.acknowledges = true;
        let given = SetPoint::at(self.target, targets);
        if at_once {
            (self.active, self.waiting, self.is_passed) = (Some(given), None, false);
            self.go_to(p, &given, &now.demanded);
        } else {
            self.waiting = Some(given);
            self.is_passed = has(ControlBit::ModeSpecific9);
            if let Some(active) = self.active.filter(|_| self.is_passed) {
                self.go_to(p, &active, &now.demanded);
            }
        }
    }

    /// Heads for the active set-point. If no profile can be planned, the axis continues unchanged and the drive reports a limit.
    fn go_to(&mut self, p: &Params, active: &SetPoint, from: &Setpoint) {
        self.within_window = Dwell::default();
        let most = if self.is_passed { active.velocity } else { p.end_velocity.min(active.velocity) };
        let velocity = active.passing(p, from, most);
        if let Ok(transition) = velocity.and_then(|v| active.plan(p, from, &Target::Position { x: active.x, v })) {
            self.way = Some(Way::along(&transition));
        } else {
            self.is_limited = true;
        }
    }
}

/// Demand of a step.
#[inline]
pub fn step(p: &Params, x: &mut State, now: &Moment) -> Answer {
    let asked_before = core::mem::replace(&mut x.handshake.asks, asks(now));
    if x.handshake.asks && !asked_before {
        x.take(p, now);
    }
    let (mut setpoint, mut is_there) =
        x.way.as_mut().map_or((Setpoint::at_rest(x.rest), true), |way| way.next(now.period));
    let goes_on = x.is_passed || p.end_velocity > 0.0;
    if is_there
        && goes_on
        && let Some(next) = x.waiting.take()
    {
        (x.active, x.is_passed) = (Some(next), false);
        x.go_to(p, &next, &setpoint);
        if let Some(way) = &mut x.way {
            (setpoint, is_there) = way.next(now.period);
        }
    }
    let error = now.actual.position - x.active.map_or(x.target, |active| active.x);
    let is_reached = x.within_window.step(is_there && p.window.holds(error), p.window.time, now.period);
    if is_reached {
        // The next one begins with the next step.
        x.active = x.waiting.take();
        if let Some(active) = x.active {
            x.go_to(p, &active, &setpoint.after(now.period));
        }
    }
    x.release();
    let demand = Demand::position(setpoint);
    Answer { demand, target_reached: is_reached && x.active.is_none(), bit_12: x.handshake.acknowledges, bit_13: false }
}
