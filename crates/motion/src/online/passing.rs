//! Velocity at which a target may be passed on the path to the next one.
//!
//! The fastest path from a state to the velocity w covers g(w). To pass a target at w at the distance s without turning
//! back before it, an axis needs g(w) ≤ s: the rest is made up for by higher speed on the path. Let w_c be the velocity that remains
//! when the derivatives above it are brought to zero at once. From there on g grows with w. Below, where the axis only
//! brakes, it first grows as w falls, since that takes longer, and then may shrink a little, since the last of it is slow:
//!
//! ```text
//! g(w)  |  ·˙˙·                 ·
//!       | ·      ·           ·
//!       |           ·     ·
//!       +--------------·-------------- w
//!       0             w_c
//! ```
//!
//! So g meets s once between w_c and the highest w, or once between zero and w_c, or nowhere. The root is bracketed, and
//! found in a few evaluations, each of which is in closed form at orders 2 and 3 and a plan of order 3 at order 4.
//!
//! That is the fastest path at once. Two things may permit a higher speed, both of them by braking first
//! ([`super::braking`]): a longer run-up, if the axis is braking already; and, at order 4, keeping a state next to its velocity
//! limit from passing it. There the possible passing speeds need not be an interval, and each is tried by a plan.
use super::arrival::rounding_of;
use super::braking::{Braking, least};
use super::first::State;
use super::fourth::{Limits4, State4};
use super::ladder::{self, Goal};
use super::newton::Near;
use super::path::Path;
use super::second::{self, Limits2, Sides, State2};
use super::third::{self, Limits3, State3};
use super::transition::check_state;
use super::trapezoid::Rates;
use super::watch;
use super::{DirectionalLimits, Effort};
use crate::limits::within_range;
use crate::root::{increasing, increasing_from};
use crate::{Order, PlanError};
use servobench_base::{Setpoint, non_negative};

/// Relative reduction of a distance by rounding, also relative to the positions between which it lies.
const ROUNDING: f64 = 1e-12;

/// Relative reductions of a speed that is reached by one path only, until a plan finds a path.
const LOWER: [f64; 3] = [1e-6, 1e-4, 1e-2];

/// Number of times at which the benefit of braking until then is tested, and of halvings of the step between them.
const SAMPLES: u32 = 4;
const STEPS: usize = 5;

/// Number of parts of the highest speed that are tried if no path is found that keeps the velocity limit.
const PARTS: u32 = 16;

/// The highest speed, `most` at most (m/s or rad/s), that the fastest path from the state `from` reaches before `x` (m or rad),
/// so that `x` can be passed at it without turning back; `None` when there is none, as when braking that has begun cannot be
/// released soon enough.
///
/// It is a magnitude, towards `x`; an axis that moves away from `x` has to reverse once to reach it. If the path is just
/// long enough, the speed is about 1e-12 below the exact one, so that rounding reverses no axis.
///
/// The guarantee is that the plan to `x` at this speed does not turn back. That property is not monotonic in the speed, so that a
/// higher one may be possible, too. An axis that is braking may be faster at `x` after braking further, for a longer run-up: that is
/// tested at a few times. And from a state of order 4 so near its velocity limit that the fastest path would pass it, the least braking
/// that keeps it is halved a few times. In 30 000 random situations each a speed higher by more than 0.1 % of the limit passed in 0.2 % of
/// them at order 3, in 2 % at order 4; higher by 3 % at most at order 3, by 25 % at order 4; none at order 2.
///
/// With [`braking_velocity`] for the distance of the next move as `most`, it serves blending (`PLCopen` Motion Control,
/// part 1, `BufferMode`): the velocity at which one move ends and the next one begins. With
/// [`RampLimits`](super::RampLimits) the limits are those [`towards`](super::RampLimits::towards) `x`.
///
/// ```
/// use servobench_base::Setpoint;
/// use servobench_motion::Order;
/// use servobench_motion::online::{DirectionalLimits, Sides, braking_velocity, passing_velocity};
/// let (velocity, acceleration) = (Sides::both(1.0), Sides::both(2.0));
/// let limits = DirectionalLimits { velocity, acceleration, jerk: 50.0, snap: 2000.0 };
/// // 0.16 m to the next position, and 0.04 m from there to the one behind it: 2·2 m/s²·0.04 m = (0.4 m/s)².
/// let most = braking_velocity(Order::Second, 0.04, &limits)?;
/// assert!((most - 0.4).abs() < 1e-11);
/// let here = Setpoint::at_rest(0.5);
/// assert_eq!(passing_velocity(Order::Second, &here, 0.66, &limits, most)?, Some(most));
/// // Without a need to brake for another position, the run-up decides.
/// let fastest = passing_velocity(Order::Second, &here, 0.66, &limits, 1.0)?;
/// assert!(fastest.is_some_and(|fastest| (fastest - 0.8).abs() < 1e-11));
/// # Ok::<(), servobench_motion::PlanError>(())
/// ```
///
/// # Errors
/// [`PlanError`] when [`Transition::plan`](super::Transition::plan) refuses the limits or the state; or if `x` is not a number within
/// ±1e30, or `most` is not positive or zero.
pub fn passing_velocity(
    order: Order,
    from: &Setpoint,
    x: f64,
    limits: &DirectionalLimits,
    most: f64,
) -> Result<Option<f64>, PlanError> {
    limits.check(order)?;
    check_state(order, from)?;
    within_range("x", x)?;
    non_negative("most", most)?;
    let sign = if x >= from.x { 1.0 } else { -1.0 };
    let search = Search { order, x, sign, limits, most: most.min(limits.velocity.towards(sign)) };
    Ok(search.highest(from))
}

/// A search for the highest speed.
struct Search<'a> {
    order: Order,
    x: f64,
    /// Sign of the direction towards `x`.
    sign: f64,
    limits: &'a DirectionalLimits,
    most: f64,
}

impl Search<'_> {
    #[inline]
    fn highest(&self, from: &Setpoint) -> Option<f64> {
        let calm = self.sign * calmed(self.order, from, self.limits);
        let Some(at_once) = self.by_the_fastest_way(from, calm) else {
            // There is a path if only the velocity limit makes the fastest one too long.
            let is_too_fast = calm > self.most;
            return if self.order == Order::Fourth && is_too_fast { self.by_trying(from) } else { None };
        };
        if self.order == Order::Second {
            return Some(at_once);
        }
        if self.keeps_the_velocity(from, at_once) {
            let is_highest = at_once >= self.most || !self.is_braking(from, calm);
            return Some(if is_highest { at_once } else { self.after_braking_on(from, at_once).unwrap_or(at_once) });
        }
        // As little braking as the velocity limit demands; either on through zero, or to zero acceleration.
        let braking = Braking::towards(self.order, from, -self.sign, self.limits);
        let calming = Braking::calming(from, self.limits);
        let ways = [(&braking, braking.crossing()), (&calming, calming.duration())];
        let most = ways.into_iter().filter_map(|(way, longest)| least(longest, |time| self.kept(&way.after(time))));
        let by_braking = most.reduce(f64::max).and_then(|most| self.lowered(from, most));
        by_braking.or_else(|| self.by_trying(from))
    }

    /// The highest speed found by plans, from the highest one down.
    fn by_trying(&self, from: &Setpoint) -> Option<f64> {
        let part = self.most / f64::from(PARTS);
        let mut low = (0..=PARTS).rev().map(|k| f64::from(k) * part).find(|speed| self.is_passed(from, *speed))?;
        let mut high = (low + part).min(self.most);
        for _ in 0..STEPS {
            let middle = 0.5 * (low + high);
            if self.is_passed(from, middle) { low = middle } else { high = middle }
        }
        Some(low)
    }

    /// A higher speed than `at_once` by braking further, for a longer run-up.
    fn after_braking_on(&self, from: &Setpoint, at_once: f64) -> Option<f64> {
        let braking = Braking::towards(self.order, from, -self.sign, self.limits);
        // Until it would stand.
        let end = braking.end(|at| self.sign * calmed(self.order, at, self.limits));
        let reaches_after = |part: f64| self.reaches(&braking.after(part * end), at_once);
        if !self.is_nearer_braked(from, at_once) && !reaches_after(1.0) && !reaches_after(0.5) {
            return None;
        }
        // If the highest so far is not reached, no root is computed.
        let mut best = at_once;
        let mut higher = |time: f64| {
            let at = braking.after(time);
            let found = if self.reaches(&at, best) { self.kept(&at) } else { None };
            found.filter(|speed| *speed > best).is_some_and(|speed| {
                best = speed;
                true
            })
        };
        let (mut time, mut step) = (0.0, end / f64::from(SAMPLES));
        for k in (1..=SAMPLES).rev() {
            let sample = step * f64::from(k);
            if higher(sample) {
                time = sample;
            }
        }
        let steps = if self.order == Order::Third { 2 * STEPS } else { STEPS };
        for _ in 0..steps {
            step *= 0.5;
            for next in [(time - step).max(0.0), (time + step).min(end)] {
                if higher(next) {
                    time = next;
                    break;
                }
            }
        }
        if best > at_once { self.lowered(from, best).filter(|speed| *speed > at_once) } else { None }
    }

    /// `speed`, or a little less, at which a plan passes `x` without turning back: a speed that is reached by one path only is met
    /// from next to it.
    fn lowered(&self, from: &Setpoint, speed: f64) -> Option<f64> {
        let lowered = LOWER.into_iter().map(|part| speed * (1.0 - part));
        lowered.into_iter().find(|speed| *speed > 0.0 && self.is_passed(from, *speed))
    }

    /// True if the plan that passes `x` at `speed` does not turn back.
    fn is_passed(&self, from: &Setpoint, speed: f64) -> bool {
        let &DirectionalLimits { velocity, acceleration, jerk, .. } = self.limits;
        let (distance, v) = (self.x - from.x, self.sign * speed);
        let rounding = rounding_of(from.x, self.x);
        let mut lowest = f64::INFINITY;
        if self.order == Order::Third {
            let start = State3 { p: 0.0, v: from.v, a: from.a };
            let to = State3 { p: distance, v, a: 0.0 };
            let mut path = Path::EMPTY;
            third::passing(start, to, &Limits3 { v: velocity, a: acceleration, j: jerk }, rounding, &mut path);
            start.velocities(&path, |v| lowest = lowest.min(self.sign * v));
        } else {
            let start = State4 { x: 0.0, v: from.v, a: from.a, j: from.j };
            let goal = Goal::State(State4 { x: distance, v, a: 0.0, j: 0.0 });
            let plan = ladder::plan(start, &goal, &limits4(self.limits), rounding, Effort::Fast);
            start.velocities(&plan.path, |v| lowest = lowest.min(self.sign * v));
        }
        lowest >= -watch::ROUNDING * velocity.towards(self.sign)
    }

    /// Speed reached by the fastest path from here, if that keeps the velocity limit and does not turn back.
    fn kept(&self, from: &Setpoint) -> Option<f64> {
        let calm = self.sign * calmed(self.order, from, self.limits);
        let is_ahead = calm >= 0.0 && self.distance(from) >= 0.0;
        let speed = if is_ahead { self.by_the_fastest_way(from, calm)? } else { return None };
        self.keeps_the_velocity(from, speed).then_some(speed)
    }

    #[inline]
    fn covered(&self, from: &Setpoint, speed: f64) -> f64 {
        self.sign * covered(self.order, from, self.sign * speed, self.limits)
    }

    fn distance(&self, from: &Setpoint) -> f64 {
        self.sign * (self.x - from.x)
    }

    fn rounding(&self, from: &Setpoint) -> f64 {
        ROUNDING * self.distance(from) + 4.0 * f64::EPSILON * (self.x.abs() + from.x.abs())
    }

    fn reaches(&self, from: &Setpoint, speed: f64) -> bool {
        self.covered(from, speed) <= self.distance(from) - self.rounding(from)
    }

    /// The highest speed that the fastest path reaches before `x`; `calm` is the one that remains when the acceleration is brought to
    /// zero at once.
    #[inline]
    fn by_the_fastest_way(&self, from: &Setpoint, calm: f64) -> Option<f64> {
        let (distance, rounding) = (self.distance(from), self.rounding(from));
        let beyond = |covered: f64| covered - (distance - rounding);
        let beyond_at = |speed: f64| beyond(self.covered(from, speed));
        let calm = calm.max(0.0).min(self.most);
        let by_calm = self.covered(from, calm);
        let (low, high) = if by_calm <= distance {
            ((calm, beyond(by_calm)), (self.most, beyond_at(self.most)))
        } else {
            let by_zero = self.covered(from, 0.0);
            if by_zero > distance {
                return None;
            }
            ((0.0, beyond(by_zero)), (calm, beyond(by_calm)))
        };
        let mut highest = increasing_from(low, high, beyond_at);
        // Next to w_c the distance rises so steeply that the numbers next to the root are too large.
        let mut step = f64::EPSILON * highest;
        while self.covered(from, highest) > distance && highest > low.0 {
            (highest, step) = ((highest - step).max(low.0), 2.0 * step);
        }
        Some(highest)
    }

    /// True if the fastest path of order 4 to a speed keeps the limits of velocity, or comes back into them.
    fn keeps_the_velocity(&self, from: &Setpoint, speed: f64) -> bool {
        if self.order < Order::Fourth {
            return true;
        }
        let (start, limits) = (within_jerk(from, self.limits), limits4(self.limits));
        let to = State3 { p: self.sign * speed, v: 0.0, a: 0.0 };
        let [velocity, _] = start.watched(&third::fastest(start.upper(), to, &limits.upper()), &limits);
        velocity.fault <= watch::ROUNDING
    }

    /// True if it slows down on its path to `x` when brought to a constant velocity at once.
    fn is_braking(&self, from: &Setpoint, calm: f64) -> bool {
        self.sign * from.v > 0.0 && calm < self.sign * from.v
    }

    /// True if the fastest path to a speed covers less after braking further for an instant: the change is known in the same way as in
    /// [`second`] and [`super::costate`].
    fn is_nearer_braked(&self, from: &Setpoint, speed: f64) -> bool {
        let DirectionalLimits { acceleration, jerk, snap, .. } = *self.limits;
        if self.order == Order::Third {
            let start = within_acceleration(from, self.limits);
            let (start, to) = (State2 { v: start.v, a: start.a }, State2 { v: self.sign * speed, a: 0.0 });
            let way = second::way(start, to, &Limits2 { a: acceleration, j: jerk });
            return self.sign * way.grows(start, to, -self.sign * jerk) < 0.0;
        }
        let (start, to) = (within_jerk(from, self.limits), State3 { p: self.sign * speed, v: 0.0, a: 0.0 });
        let third::Fastest { path, by_a } =
            third::way(start.upper(), to, &limits4(self.limits).upper(), &Near::nothing());
        let first = path.stretches().next().map_or(0.0, |first| first.rate());
        self.sign * (-self.sign * snap - first) * by_a < 0.0
    }
}

/// The highest speed (m/s or rad/s) within its limit from which an axis without acceleration stops within `distance`
/// (m or rad, its sign the direction).
///
/// # Errors
/// [`PlanError`] when [`Transition::plan`](super::Transition::plan) refuses the limits, or `distance` is not a number within ±1e30.
pub fn braking_velocity(order: Order, distance: f64, limits: &DirectionalLimits) -> Result<f64, PlanError> {
    limits.check(order)?;
    within_range("distance", distance)?;
    let sign = if distance >= 0.0 { 1.0 } else { -1.0 };
    let room = sign * distance * (1.0 - ROUNDING);
    let beyond = |speed: f64| {
        let from = Setpoint { v: sign * speed, ..Setpoint::default() };
        sign * covered(order, &from, 0.0, limits) - room
    };
    Ok(increasing(0.0, limits.velocity.towards(sign), beyond))
}

const fn limits4(limits: &DirectionalLimits) -> Limits4 {
    let DirectionalLimits { velocity, acceleration, jerk, snap } = *limits;
    Limits4 { v: velocity, a: acceleration, j: jerk, d: snap }
}

/// Distance of the fastest path from `from` to the velocity `to`.
#[inline]
fn covered(order: Order, from: &Setpoint, to: f64, limits: &DirectionalLimits) -> f64 {
    let DirectionalLimits { acceleration, jerk, .. } = *limits;
    match order {
        Order::Second => Rates::by_direction(acceleration).covered(from.v, to),
        Order::Third => {
            let start = within_acceleration(from, limits);
            let (from, to) = (State2 { v: start.v, a: start.a }, State2 { v: to, a: 0.0 });
            let way = second::way(from, to, &Limits2 { a: acceleration, j: jerk });
            start.p + way.covered(from, to)
        }
        Order::Fourth => {
            let start = within_jerk(from, limits);
            start.along(&third::fastest(start.upper(), State3 { p: to, v: 0.0, a: 0.0 }, &limits4(limits).upper())).x
        }
    }
}

/// The velocity that remains when the derivatives above it are brought to zero at once.
fn calmed(order: Order, from: &Setpoint, limits: &DirectionalLimits) -> f64 {
    match order {
        Order::Second => from.v,
        Order::Third => {
            let start = within_acceleration(from, limits);
            start.v + start.a * start.a.abs() / (2.0 * limits.jerk)
        }
        Order::Fourth => {
            let start = within_jerk(from, limits);
            let (from, to) = (State2 { v: start.a, a: start.j }, State2 { v: 0.0, a: 0.0 });
            let way = second::way(from, to, &Limits2 { a: Sides::both(limits.jerk), j: limits.snap });
            start.v + way.covered(from, to)
        }
    }
}

/// At order 3: the state after the path back into the limits of acceleration, from the position zero.
fn within_acceleration(from: &Setpoint, limits: &DirectionalLimits) -> State3 {
    let (excess, side) = limits.acceleration.excess(from.a);
    let start = State3 { p: 0.0, v: from.v, a: from.a };
    if excess > 0.0 { start.after(-side * limits.jerk, excess / limits.jerk) } else { start }
}

/// At order 4: the state after the path back into the limits of jerk, from the position zero.
fn within_jerk(from: &Setpoint, limits: &DirectionalLimits) -> State4 {
    let (excess, side) = Sides::both(limits.jerk).excess(from.j);
    let start = State4 { x: 0.0, v: from.v, a: from.a, j: from.j };
    if excess > 0.0 { start.after(-side * limits.snap, excess / limits.snap) } else { start }
}
