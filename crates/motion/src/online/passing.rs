//! At which velocity a target may be passed on the way to the next one.
//!
//! The fastest way from a state to the velocity w covers g(w). Who is to pass a target at w at the distance s, and is not to turn
//! back before it, needs g(w) ≤ s: what is missing is made up for by going faster on the way. Let w_c be the velocity that is left
//! when the derivatives above it are brought to zero at once. From there on g grows with w. Below, where there is nothing but
//! braking, it first grows as w falls, since that takes longer, and then may shrink a little, since the last of it is slow:
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
//! found in a few looks, each of which is closed at orders 2 and 3 and a plan of order 3 at order 4.
use super::DirectionalLimits;
use super::first::State;
use super::fourth::{Limits4, State4};
use super::second::{self, Limits2, Sides, State2};
use super::third::{self, State3};
use super::transition::check_state;
use super::trapezoid::Rates;
use super::watch;
use crate::limits::within_range;
use crate::root::increasing;
use crate::{Order, PlanError};
use servobench_base::{Setpoint, non_negative};

/// What rounding may take from a distance, as a part of it and of the positions between which it lies.
const ROUNDING: f64 = 1e-12;

/// Into how many parts a speed is divided of which the highest is taken that does without passing the velocity limit.
const PARTS: u32 = 8;

/// The highest speed, `most` at most (m/s or rad/s), to which the fastest way from the state `from` reaches before `x` (m or rad),
/// so that `x` can be passed at it without turning back; `None` when there is none, as when a brake that has been put on cannot be
/// released soon enough.
///
/// It is a magnitude, towards `x`; an axis that moves away from `x` has to turn round once, to come to it. One that is braking
/// may be a little faster at `x` when it brakes on first, for a longer run-up: that is not looked for. Where the way is just long
/// enough, the speed is by about 1e-12 below the one with which it would be, so that rounding turns no axis round. At order 4, from
/// a state so near its velocity limit that the fastest way would pass it, the speed is rounded down to eighths of that.
///
/// With [`braking_velocity`] for the distance of the next move as `most` it is what blending needs (`PLCopen` Motion Control,
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
/// // Where nothing follows that has to be braked for, the way up to speed decides.
/// let fastest = passing_velocity(Order::Second, &here, 0.66, &limits, 1.0)?;
/// assert!(fastest.is_some_and(|fastest| (fastest - 0.8).abs() < 1e-11));
/// # Ok::<(), servobench_motion::PlanError>(())
/// ```
///
/// # Errors
/// [`PlanError`] when [`Transition::plan`](super::Transition::plan) refuses the limits or the state; or `x` is no number within
/// ±1e30, or `most` not positive or zero.
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
    let distance = sign * (x - from.x);
    let most = most.min(limits.velocity.towards(sign));
    let covered = |speed: f64| sign * covered(order, from, sign * speed, limits);
    let rounding = ROUNDING * distance + 4.0 * f64::EPSILON * (x.abs() + from.x.abs());
    let beyond = |speed: f64| covered(speed) - (distance - rounding);
    let calm = (sign * calmed(order, from, limits)).max(0.0).min(most);
    let (low, high) = if covered(calm) <= distance {
        (calm, most)
    } else if covered(0.0) <= distance {
        (0.0, calm)
    } else {
        return Ok(None);
    };
    let mut highest = increasing(low, high, beyond);
    // Next to w_c what is covered rises so steeply that the numbers next to the root are too much.
    let mut step = f64::EPSILON * highest;
    while covered(highest) > distance && highest > low {
        (highest, step) = ((highest - step).max(low), 2.0 * step);
    }
    if order < Order::Fourth || keeps_the_velocity(from, sign * highest, limits) {
        return Ok(Some(highest));
    }
    let lower = (0..PARTS).rev().map(|k| highest * f64::from(k) / f64::from(PARTS));
    let fits = |speed: &f64| beyond(*speed) <= 0.0 && keeps_the_velocity(from, sign * speed, limits);
    Ok(lower.into_iter().find(fits))
}

/// The highest speed (m/s or rad/s) within its limit from which an axis without acceleration comes to a stop within `distance`
/// (m or rad, its sign the direction).
///
/// # Errors
/// [`PlanError`] when [`Transition::plan`](super::Transition::plan) refuses the limits, or `distance` is no number within ±1e30.
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

/// Whether the fastest way of order 4 to the velocity `to` keeps the limits of velocity, or comes back into them.
fn keeps_the_velocity(from: &Setpoint, to: f64, limits: &DirectionalLimits) -> bool {
    let (start, limits) = (within_jerk(from, limits), limits4(limits));
    let path = third::fastest(start.upper(), State3 { p: to, v: 0.0, a: 0.0 }, &limits.upper());
    let [velocity, _] = start.watched(&path, &limits);
    velocity.fault <= watch::ROUNDING
}

const fn limits4(limits: &DirectionalLimits) -> Limits4 {
    let DirectionalLimits { velocity, acceleration, jerk, snap } = *limits;
    Limits4 { v: velocity, a: acceleration, j: jerk, d: snap }
}

/// What the fastest way from `from` to the velocity `to` covers.
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

/// The velocity that is left when the derivatives above it are brought to zero at once.
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

/// At order 3: after the way back into the limits of acceleration, from the position zero.
fn within_acceleration(from: &Setpoint, limits: &DirectionalLimits) -> State3 {
    let (excess, side) = limits.acceleration.excess(from.a);
    let start = State3 { p: 0.0, v: from.v, a: from.a };
    if excess > 0.0 { start.after(-side * limits.jerk, excess / limits.jerk) } else { start }
}

/// At order 4: after the way back into the limits of jerk, from the position zero.
fn within_jerk(from: &Setpoint, limits: &DirectionalLimits) -> State4 {
    let (excess, side) = Sides::both(limits.jerk).excess(from.j);
    let start = State4 { x: 0.0, v: from.v, a: from.a, j: from.j };
    if excess > 0.0 { start.after(-side * limits.snap, excess / limits.snap) } else { start }
}
