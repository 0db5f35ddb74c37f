//! A planned transition, and the set-point at any time of it.
use super::arrival::rounding_of;
use super::first::State;
use super::fourth::{Limits4, State4};
use super::ladder::{self, Goal};
use super::path::Path;
use super::second::{self, Limits2, Sides, State2};
use super::third::{self, Limits3, State3};
use super::trapezoid::{self, Rates};
use super::watch::{ROUNDING, Watch};
use super::{DirectionalLimits, Effort, RampLimits, Target, turning};
use crate::limits::within_range;
use crate::stretch::LONGEST;
use crate::{Order, Piece, PlanError, Segment, Trajectory};
use servobench_base::{Setpoint, Stateful};

/// Maximum number of stretches: those of a plan to a stop, which has neither a second path home nor a cruise, and those of one from
/// rest, which needs no leading back.
const STRETCHES: usize = ladder::STRETCHES + third::FASTEST;

/// The path from one state to a target, in the axis unit (m or rad) and seconds from its start.
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub struct Transition {
    way: Trajectory<STRETCHES>,
    excess: f64,
}

impl Transition {
    /// Plans the path from `from` to `target`.
    ///
    /// `from` may be any state: that of a running move, or one beyond the limits, which is led back on the shortest path. Its
    /// snap does not matter, nor its jerk at order 3, nor its acceleration at order 2.
    ///
    /// # Errors
    /// [`PlanError`] when a state is not a number within ±1e30, a limit that the order uses is not positive or lies outside
    /// 1e-30 … 1e30 (SI), or the velocity of the target is beyond its limits; and when the path would take more than 1e60 s.
    pub fn plan(
        order: Order,
        from: &Setpoint,
        target: &Target,
        limits: &DirectionalLimits,
        effort: Effort,
    ) -> Result<Self, PlanError> {
        limits.check(order)?;
        target.check(limits.velocity)?;
        check_state(order, from)?;
        match order {
            Order::Second => second_order(from, target, limits.velocity, &Rates::by_direction(limits.acceleration)),
            Order::Third => third_order(from, target, limits),
            Order::Fourth => fourth_order(from, target, limits, effort),
        }
    }

    /// The same with one acceleration while the speed grows and another one while it falls.
    ///
    /// Order 2 is the shortest path that keeps them. At orders 3 and 4 so is the path of an axis that keeps its direction, planned
    /// [`towards`](RampLimits::towards) it. An axis that has to reverse brakes with the deceleration, passes zero with the smaller
    /// of both accelerations at most, and speeds up with the acceleration: at order 3 in the shortest time, at order 4 within about
    /// 0.2 % of it. To reverse more than once, the shorter of two paths is taken: one with the smaller acceleration throughout
    /// ([`either_way`](RampLimits::either_way)), and one with a stop. That takes up to five plans, at order 4 up to a dozen.
    ///
    /// # Errors
    /// As [`plan`](Self::plan).
    pub fn plan_ramps(
        order: Order,
        from: &Setpoint,
        target: &Target,
        limits: &RampLimits,
        effort: Effort,
    ) -> Result<Self, PlanError> {
        limits.check(order)?;
        target.check(limits.velocity)?;
        check_state(order, from)?;
        if order == Order::Second {
            return second_order(from, target, limits.velocity, &limits.rates());
        }
        turning::Request { order, target, limits, effort }.plan(from)
    }

    /// Appends `next`, which begins where this one ends.
    pub(super) fn then(self, next: &Self) -> Self {
        Self { way: self.way.then(&next.way), excess: self.excess.max(next.excess) }
    }

    /// The same, with this known excess over the limits.
    pub(super) fn exceeding(self, excess: f64) -> Self {
        Self { excess: if excess > 2.0 * ROUNDING { excess } else { 0.0 }, ..self }
    }

    /// Its trajectory.
    pub(super) const fn way(&self) -> &Trajectory<STRETCHES> {
        &self.way
    }

    fn new<const N: usize>(
        order: Order,
        from: Setpoint,
        path: &Path<N>,
        target: &Target,
        excess: f64,
    ) -> Result<Self, PlanError> {
        let path = within_time(path)?;
        let way = Trajectory::new(order, from, path.stretches(), |end| match target {
            Target::Position { x, v } => Setpoint { v: *v, ..Setpoint::at_rest(*x) },
            Target::Velocity(v) => Setpoint { v: *v, ..Setpoint::at_rest(end.x) },
        });
        Ok(Self { way, excess: excess.max(0.0) })
    }

    /// The path along `path` to `a` and `j` at rest.
    pub(super) fn through_rest<const N: usize>(
        order: Order,
        from: Setpoint,
        path: &Path<N>,
        a: f64,
        j: f64,
    ) -> Result<Self, PlanError> {
        let path = within_time(path)?;
        let way = Trajectory::new(order, from, path.stretches(), |end| Setpoint { a, j, ..Setpoint::at_rest(end.x) });
        Ok(Self { way, excess: 0.0 })
    }

    /// The set-point `t` seconds after the start; before it the first one, from the end on the target, continued at its
    /// velocity. NaN counts as before the start.
    #[must_use]
    #[inline]
    pub fn at(&self, t: f64) -> Setpoint {
        self.way.at(t)
    }

    /// The polynomial that [`at`](Self::at) evaluates at `t` (s).
    #[must_use]
    pub fn piece(&self, t: f64) -> Piece {
        self.way.piece(t)
    }

    /// Duration (s).
    #[must_use]
    pub const fn duration(&self) -> f64 {
        self.way.duration()
    }

    /// True if the velocity never leaves the side of `sign`, except by rounding.
    #[must_use]
    pub fn keeps_direction(&self, sign: f64) -> bool {
        self.way.keeps_direction(sign)
    }

    /// Order of the profile.
    #[must_use]
    pub const fn order(&self) -> Order {
        self.way.order()
    }

    /// The segments with their highest derivative.
    #[must_use]
    pub fn segments(&self) -> impl ExactSizeIterator<Item = Segment> + '_ {
        self.way.segments()
    }

    /// Relative excess over the limits of velocity and acceleration. Zero, unless the state from which it
    /// starts is beyond them, or leaves only paths that are.
    #[must_use]
    pub const fn excess(&self) -> f64 {
        self.excess
    }
}

/// The derivatives of a state that `order` uses.
pub(super) fn check_state(order: Order, from: &Setpoint) -> Result<(), PlanError> {
    let state = [("from.x", from.x), ("from.v", from.v), ("from.a", from.a), ("from.j", from.j)];
    for (name, value) in &state[..order.derivative()] {
        within_range(name, *value)?;
    }
    Ok(())
}

/// The path, if it does not take too long.
fn within_time<const N: usize>(path: &Path<N>) -> Result<&Path<N>, PlanError> {
    let value = path.duration();
    if value.is_nan() || value > LONGEST {
        let remedy = "start nearer to the limits, or raise them";
        return Err(PlanError::OutOfRange { name: "duration", value, lowest: 0.0, highest: LONGEST, remedy });
    }
    Ok(path)
}

fn second_order(from: &Setpoint, target: &Target, velocity: Sides, rates: &Rates) -> Result<Transition, PlanError> {
    let mut path = Path::EMPTY;
    match target {
        Target::Position { x, v } => {
            let rounding = rounding_of(from.x, *x);
            trapezoid::fastest([from.v, *v], x - from.x, rounding, velocity, rates, &mut path);
        }
        Target::Velocity(v) => rates.ramp(from.v, *v, &mut path),
    }
    // The speed never exceeds its initial value.
    let excess = Watch::new(velocity, from.v).most;
    Transition::new(Order::Second, Setpoint { a: 0.0, j: 0.0, s: 0.0, ..*from }, &path, target, excess)
}

fn third_order(from: &Setpoint, target: &Target, limits: &DirectionalLimits) -> Result<Transition, PlanError> {
    let DirectionalLimits { velocity, acceleration, jerk, .. } = *limits;
    // Only the distance matters.
    let start = State3 { p: 0.0, v: from.v, a: from.a };
    let mut path = Path::EMPTY;
    let excess = match target {
        Target::Position { x, v } => {
            let to = State3 { p: x - from.x, v: *v, a: 0.0 };
            let limits = Limits3 { v: velocity, a: acceleration, j: jerk };
            third::passing(start, to, &limits, rounding_of(from.x, *x), &mut path)
        }
        Target::Velocity(v) => {
            let (beyond, side) = acceleration.excess(start.a);
            path.push(-side * jerk, beyond / jerk);
            let turn = start.along(&path);
            let limits = Limits2 { a: acceleration, j: jerk };
            path.extend(&second::rest(State2 { v: turn.v, a: turn.a }, State2 { v: *v, a: 0.0 }, velocity, &limits));
            start.excess(&path, velocity, acceleration).1
        }
    };
    Transition::new(Order::Third, Setpoint { j: 0.0, s: 0.0, ..*from }, &path, target, excess)
}

fn fourth_order(
    from: &Setpoint,
    target: &Target,
    limits: &DirectionalLimits,
    effort: Effort,
) -> Result<Transition, PlanError> {
    let DirectionalLimits { velocity, acceleration, jerk, snap } = *limits;
    let limits = Limits4 { v: velocity, a: acceleration, j: jerk, d: snap };
    let start = State4 { x: 0.0, v: from.v, a: from.a, j: from.j };
    let (goal, rounding) = match target {
        Target::Position { x, v } => {
            (Goal::State(State4 { x: x - from.x, v: *v, a: 0.0, j: 0.0 }), rounding_of(from.x, *x))
        }
        Target::Velocity(v) => (Goal::Velocity(*v), 0.0),
    };
    let ladder::Plan { path, excess, .. } = ladder::plan(start, &goal, &limits, rounding, effort);
    let excess = excess.max(Sides::both(jerk).excess(from.j).0 / jerk);
    Transition::new(Order::Fourth, Setpoint { s: 0.0, ..*from }, &path, target, excess)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Limits;

    /// Found by the fuzz target: states so far beyond the limits that the path back left the range of `f64`.
    #[test]
    fn a_way_that_takes_too_long_is_refused() {
        let limits = Limits { velocity: 1.0, acceleration: 1.0, jerk: 1e-18, snap: 1e-28 };
        let target = Target::Position { x: 1.0, v: 0.0 };
        let message = |from: Setpoint| {
            Transition::plan(Order::Fourth, &from, &target, &limits.into(), Effort::Fast).unwrap_err().to_string()
        };
        let refused = message(Setpoint { j: 7.5, ..Setpoint::default() });
        assert!(refused.starts_with("`duration` must be between 0e0 and 1e60 (SI), got "), "{refused}");
        assert!(refused.ends_with(": start nearer to the limits, or raise them"), "{refused}");
        let refused = message(Setpoint { v: -2e30, ..Setpoint::default() });
        assert_eq!(refused, "`from.v` must be a number within ±1e30, got -2000000000000000000000000000000");
    }

    /// The published generator of order 4 needs 3 kB for an axis (Pietrusewicz, Waszczuk & Kubicki 2019).
    #[test]
    fn an_axis_of_order_4_needs_less_than_3_kilobytes() {
        let (planned, rest) = (size_of::<Transition>(), size_of::<crate::Profile>());
        println!("a transition takes {planned} bytes, a move from rest to rest {rest} bytes");
        assert!(planned + rest < 3000, "{planned} {rest}");
    }
}
