//! An axis that reverses, with one acceleration while its speed grows and another one while it falls.
//!
//! Let it come from below zero. Below zero it brakes, and its acceleration is at most the deceleration; above zero it speeds
//! up, with the acceleration at most. So at zero it has the smaller of both at most. A path that reverses once is one of two:
//!
//! - with the larger one all along, if that happens to keep the rule;
//! - or, if that would pass zero with too much, it passes zero with the smaller one and is two consecutive paths, each with
//!   constant limits: to v = 0 with that acceleration, and from there. At order 3 no choice remains, at order 4 the
//!   jerk at zero: [`Request::jerk_at_zero`].
//!
//! The smaller one all along, and a stop before the other path begins, serve an axis that reverses more than once.
use super::arrival::rounding_within;
use super::first::State;
use super::second::Sides;
use super::third::{self, Limits3, State3};
use super::watch::ROUNDING;
use super::{DirectionalLimits, Effort, RampLimits, Target, Transition};
use crate::{Order, PlanError};
use core::f64::consts::FRAC_1_SQRT_2;
use servobench_base::Setpoint;

/// Number of cuts by a third of the range of the jerk at zero: its cost is flat there.
const THIRDS: usize = 12;

/// Number of halvings of the step by which another jerk is tried.
const STEPS: usize = 4;

/// A request for a plan of order 3 or 4.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Request<'a> {
    pub(crate) order: Order,
    pub(crate) target: &'a Target,
    pub(crate) limits: &'a RampLimits,
    pub(crate) effort: Effort,
}

/// A path, and its relative excess over the limits; negative within them.
struct Candidate {
    way: Transition,
    excess: f64,
}

impl Request<'_> {
    /// The shortest of the paths that keep the limits; without one, that which exceeds them least.
    pub(crate) fn plan(&self, from: &Setpoint) -> Result<Transition, PlanError> {
        if let Some(planned) = self.one_way(from)? {
            return Ok(planned);
        }
        let judged = |way: Transition| Candidate { way, excess: self.limits.excess_on(way.way()) };
        // The excess of the start belongs to every path.
        let allowed = self.limits.excess_of(self.order, from).max(0.0) + ROUNDING;
        let is_kept = |one: &Candidate| one.excess <= allowed;
        let wide = judged(self.towards_target(from, self.limits.turning(-self.heading(from)))?);
        let other = if allowed <= 2.0 * ROUNDING && is_kept(&wide) {
            wide
        } else if let Some(way) = self.through_zero(from)? {
            judged(way)
        } else {
            judged(self.by_a_stop(from)?)
        };
        let slow = judged(self.towards_target(from, self.limits.either_way())?);
        let is_shorter = other.way.duration() < slow.way.duration();
        let is_other = match (is_kept(&slow), is_kept(&other)) {
            (true, true) => is_shorter,
            (false, false) => other.excess < slow.excess || (other.excess <= slow.excess && is_shorter),
            (_, is_kept) => is_kept,
        };
        let chosen = if is_other { other } else { slow };
        Ok(chosen.way.exceeding(chosen.excess))
    }

    fn towards_target(&self, from: &Setpoint, limits: DirectionalLimits) -> Result<Transition, PlanError> {
        Transition::plan(self.order, from, self.target, &limits, self.effort)
    }

    /// Direction of an axis that does not reverse.
    fn heading(&self, from: &Setpoint) -> f64 {
        let state = &[from.v, from.a, from.j][..self.order.derivative() - 1];
        let towards = match self.target {
            Target::Position { x, v } => [x - from.x, *v],
            Target::Velocity(v) => [*v, *v],
        };
        state.iter().chain(&towards).find(|value| **value != 0.0).map_or(1.0, |value| value.signum())
    }

    /// The shortest path that does not reverse, if there is one.
    fn one_way(&self, from: &Setpoint) -> Result<Option<Transition>, PlanError> {
        let sign = self.heading(from);
        let limits = self.limits.towards(sign);
        let planned = self.towards_target(from, limits)?;
        Ok((limits == self.limits.either_way() || planned.way().keeps_direction(sign)).then_some(planned))
    }

    /// The path that passes zero once, with the smaller of both accelerations.
    fn through_zero(&self, from: &Setpoint) -> Result<Option<Transition>, PlanError> {
        if self.order == Order::Third {
            return self.through(from, 0.0);
        }
        let RampLimits { acceleration, deceleration, .. } = *self.limits;
        let (smaller, turn) = (acceleration.min(deceleration), -self.heading(from));
        let side = if acceleration < deceleration { -1.0 } else { 1.0 };
        let [mut jerk, most] = self.jerk_at_zero();
        let mut best = self.through(from, side * jerk)?;
        let is_hold = |at: &Setpoint| at.s == 0.0 && at.j == 0.0 && (turn * at.a - smaller).abs() < 1e-9 * smaller;
        if best.is_some_and(|way| way.way().pieces().any(|(at, _)| is_hold(&at))) {
            return Ok(best);
        }
        // No hold is left for it or reached by it: another one may be better.
        let mut step = 0.5 * most;
        for _ in 0..STEPS {
            for next in [(jerk + step).min(most), (jerk - step).max(0.0)] {
                let way = self.through(from, side * next)?;
                let duration = |way: &Transition| way.duration();
                if way.is_some_and(|way| best.as_ref().is_none_or(|best| duration(&way) < duration(best))) {
                    (best, jerk) = (way, next);
                }
            }
            step *= 0.5;
        }
        Ok(best)
    }

    /// The path that passes zero once with the smaller acceleration and the jerk `j`, in the direction of the turn, if there is one.
    fn through(&self, from: &Setpoint, j: f64) -> Result<Option<Transition>, PlanError> {
        let sign = self.heading(from);
        let a = -sign * self.limits.acceleration.min(self.limits.deceleration);
        let Some(to_zero) = self.through_rest(from, a, -sign * j, self.limits.towards(sign).acceleration)? else {
            return Ok(None);
        };
        if !to_zero.way().keeps_direction(sign) {
            return Ok(None);
        }
        let onwards = self.towards_target(&to_zero.way().end(), self.limits.towards(-sign))?;
        Ok(onwards.way().keeps_direction(-sign).then(|| to_zero.then(&onwards)))
    }

    /// Jerk, a magnitude, with which an axis of order 4 passes zero at the smaller acceleration, and the largest possible one. It is
    /// towards the larger one.
    ///
    /// On one side of zero the larger acceleration is left (or reached), with the jerk q at zero not at rest; on the other side the
    /// smaller one is left by the dip that q makes, and reached again. Either side loses the time in which it is not held there:
    /// ∫(a_max − a)·dt/a_max. That is least for one q, whatever is before and behind both holds.
    fn jerk_at_zero(&self) -> [f64; 2] {
        let RampLimits { acceleration, deceleration, jerk, snap, .. } = *self.limits;
        let (smaller, larger) = (acceleration.min(deceleration), acceleration.max(deceleration));
        let fall = larger - smaller;
        let lost = |q: f64| {
            let peak = libm::sqrt(snap * fall + 0.5 * q * q).min(jerk);
            let hold = ((fall - (peak * peak - 0.5 * q * q) / snap) / peak).max(0.0);
            let (begins, ends) = (peak / snap, (peak - q) / snap);
            let fallen = 0.5 * peak * begins + peak * hold;
            let larger_side = peak * begins * begins / 6.0
                + (0.5 * peak * begins + 0.5 * peak * hold) * hold
                + (fallen + 0.5 * peak * ends - snap * ends * ends / 6.0) * ends;
            // Jerks −q, q/√2 and 0, with snap and against it.
            let (back, again) = (q * (1.0 + FRAC_1_SQRT_2) / snap, q * FRAC_1_SQRT_2 / snap);
            let deepest = 0.25 * q * q / snap;
            let smaller_side = (0.5 * q - snap * back / 6.0) * back * back
                + (deepest - 0.5 * FRAC_1_SQRT_2 * q * again + snap * again * again / 6.0) * again;
            larger_side / larger + smaller_side / smaller
        };
        let most = jerk.min(libm::sqrt(2.0 * snap * fall));
        let (mut low, mut high) = (0.0, most);
        for _ in 0..THIRDS {
            let third = (high - low) / 3.0;
            if lost(low + third) < lost(high - third) { high -= third } else { low += third }
        }
        [0.5 * (low + high), most]
    }

    /// The fastest path to v = 0 with the acceleration `a` and, at order 4, the jerk `j`; there may be none.
    fn through_rest(&self, from: &Setpoint, a: f64, j: f64, sides: Sides) -> Result<Option<Transition>, PlanError> {
        let RampLimits { velocity, jerk, snap, .. } = *self.limits;
        let path = if self.order == Order::Third {
            let (start, rest) = (State3 { p: 0.0, v: from.v, a: from.a }, State3 { p: 0.0, v: 0.0, a });
            third::straight(start, rest, &Limits3 { v: velocity, a: sides, j: jerk })
        } else {
            let (start, rest) = (State3 { p: from.v, v: from.a, a: from.j }, State3 { p: 0.0, v: a, a: j });
            let limits = Limits3 { v: sides, a: Sides::both(jerk), j: snap };
            let (path, _) = third::rest(start, rest, &limits, rounding_within(velocity, from.v.abs()));
            let rounding = ROUNDING * (from.v.abs() + a.abs() * path.duration());
            if start.along(&path).p.abs() > rounding {
                return Ok(None);
            }
            path
        };
        let start = if self.order == Order::Third { Setpoint { j: 0.0, ..*from } } else { *from };
        Transition::through_rest(self.order, Setpoint { s: 0.0, ..start }, &path, a, j).map(Some)
    }

    /// The path to a stop, and from there.
    fn by_a_stop(&self, from: &Setpoint) -> Result<Transition, PlanError> {
        let limits = self.limits.towards(self.heading(from));
        let stop = Transition::plan(self.order, from, &Target::Velocity(0.0), &limits, self.effort)?;
        let rest = stop.way().end();
        let onwards = match self.one_way(&rest)? {
            Some(planned) => planned,
            None => self.towards_target(&rest, self.limits.either_way())?,
        };
        Ok(stop.then(&onwards))
    }
}
