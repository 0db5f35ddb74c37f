//! Paths from any state: the shortest one if it keeps the limits, the next best otherwise.
//!
//! 1. [`fourth::fastest`].
//! 2. First the acceleration to zero, as fast as it can; or, if the velocity limit is too near for that, through zero
//!    with the full jerk. Then 1. The shortest part of that after which 1 keeps the limits is found by bisection, in as
//!    many steps as [`Effort`] allows.
//! 3. The same braking on to zero acceleration and jerk, and by way of a velocity at which both are zero: the distance grows
//!    with it from one limit to the other, so that there is one for every target.
//!
//! When none keeps the limits, the state has left no choice; then the one of 1 and 2 that exceeds them least is taken.
use super::Effort;
use super::first::State;
use super::fourth::{self, Limits4, State4};
use super::path::Path;
use super::second::{self, Limits2, Sides, State2};
use super::third;
use super::watch::ROUNDING;
use crate::root::increasing;

/// Maximum number of stretches: back into the jerk limit, braking twice, and those of [`fourth::fastest`].
pub(crate) const STRETCHES: usize = 1 + 2 * second::STRETCHES + fourth::STRETCHES;

/// A path, and its relative excess over the limits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Plan {
    pub(crate) path: Path<STRETCHES>,
    /// Largest excess.
    pub(crate) excess: f64,
    /// Excess without the path back from the beginning.
    fault: f64,
}

/// Goal at a constant velocity within its limits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Goal {
    /// To this state.
    State(State4),
    /// To this velocity, wherever it is reached.
    Velocity(f64),
}

impl Effort {
    /// Number of times that the braking is halved.
    const fn halvings(self) -> usize {
        match self {
            Self::Fast => 3,
            Self::Refined => 20,
        }
    }
}

impl Goal {
    /// True if an axis that keeps the direction of `from` may get there.
    fn is_ahead(&self, from: State4) -> bool {
        match self {
            Self::State(to) => from.v * (to.x - from.x) > 0.0 && from.v * to.v >= 0.0,
            Self::Velocity(v) => from.v * v >= 0.0,
        }
    }

    fn fastest(&self, from: State4, limits: &Limits4, rounding: f64) -> Option<Path<{ fourth::STRETCHES }>> {
        match self {
            Self::State(to) => fourth::fastest(from, *to, limits, rounding),
            Self::Velocity(v) => {
                let to = third::State3 { p: *v, v: 0.0, a: 0.0 };
                let mut path = Path::EMPTY;
                path.extend(&fourth::rest(from.upper(), to, limits).0);
                Some(path)
            }
        }
    }
}

/// The path from `from` to `goal`, whose distance is known to `rounding`.
pub(crate) fn plan(from: State4, goal: &Goal, limits: &Limits4, rounding: f64, effort: Effort) -> Plan {
    let mut back = Path::<STRETCHES>::EMPTY;
    let (excess, side) = Sides::both(limits.j).excess(from.j);
    back.push(-side * limits.d, excess / limits.d);
    let start = from.along(&back);

    let judged = |path: Path<STRETCHES>| {
        let [velocity, acceleration] = from.watched(&path, limits);
        let (excess, fault) = (velocity.most.max(acceleration.most), velocity.fault.max(acceleration.fault));
        Plan { path, excess, fault }
    };
    // `brake` for a while, then the fastest path.
    let after = |brake: &Path<{ second::STRETCHES }>, time: f64| {
        let rest = goal.fastest(start.until(brake, time).0, limits, rounding)?;
        let mut path = back;
        path.extend_until(brake, time);
        path.extend(&rest);
        Some(judged(path))
    };
    let keeps_the_limits = |plan: &Plan| plan.fault <= ROUNDING;
    let turns_round = |plan: &Plan| {
        let sign = from.v.signum();
        let mut lowest = f64::INFINITY;
        from.velocities(&plan.path, |v| lowest = lowest.min(sign * v));
        goal.is_ahead(from) && lowest < -ROUNDING * limits.v.towards(-sign)
    };
    let direct = after(&Path::EMPTY, 0.0);
    if let Some(plan) = direct.filter(keeps_the_limits) {
        return plan;
    }
    let bring = |state: State4, a: f64| {
        let limits = Limits2 { a: Sides::both(limits.j), j: limits.d };
        second::fastest(State2 { v: state.a, a: state.j }, State2 { v: a, a: 0.0 }, &limits)
    };
    let to_zero = bring(start, 0.0);
    let side = if start.a > 0.0 || (start.a == 0.0 && start.j > 0.0) { 1.0 } else { -1.0 };
    let through_zero = bring(start, limits.a.at(-side));
    let brakes = [(to_zero, to_zero.duration()), (through_zero, crossing(start, &through_zero))];
    let mut best = direct;
    for (brake, longest) in &brakes {
        let Some(plan) = after(brake, *longest) else { continue };
        if keeps_the_limits(&plan) {
            let shorter = |time: f64| after(brake, time).filter(keeps_the_limits);
            return least_braking(&plan, *longest, effort, turns_round, shorter);
        }
        if best.is_none_or(|best| plan.fault < best.fault) {
            best = Some(plan);
        }
    }
    // Through zero for as long as the velocity limit demands, and no longer: the other limit may be near, too.
    let calmed = |time: f64| {
        let mut path = Path::<{ 2 * second::STRETCHES }>::EMPTY;
        path.extend_until(&through_zero, time);
        path.extend(&bring(start.until(&through_zero, time).0, 0.0));
        path
    };
    let room = |time: f64| {
        let mut highest = side * start.v;
        start.velocities(&calmed(time), |v| highest = highest.max(side * v));
        limits.v.towards(side) - highest
    };
    let mut path = back;
    path.extend(&calmed(increasing(0.0, crossing(start, &through_zero), room)));
    path.extend(&by_way_of_a_velocity(from.along(&path), goal, limits));
    let plan = judged(path);
    if best.is_none_or(|best| plan.fault < best.fault) {
        best = Some(plan);
    }
    best.unwrap_or(plan)
}

/// Time at which the acceleration passes zero on `path`.
fn crossing(from: State4, path: &Path<{ second::STRETCHES }>) -> f64 {
    let (mut state, mut start) = (from, 0.0);
    if from.a == 0.0 {
        return 0.0;
    }
    for stretch in path.stretches() {
        let end = state.on(&stretch, stretch.length);
        if end.a * state.a <= 0.0 {
            // a + j·t + d·t²/2 = 0, the first root after the start, without cancellation.
            let root = libm::sqrt((state.j * state.j - 2.0 * stretch.rate() * state.a).max(0.0));
            let towards = if state.a > 0.0 { state.j - root } else { state.j + root };
            return start + (-2.0 * state.a / towards).clamp(0.0, stretch.length);
        }
        (state, start) = (end, start + stretch.length);
    }
    start
}

/// The plan with the shortest braking below `longest`; `braked` gives one only if it keeps the limits.
///
/// Too much braking may reverse an axis that otherwise keeps its direction, `turns_round`: then it is halved further.
fn least_braking(
    whole: &Plan,
    longest: f64,
    effort: Effort,
    turns_round: impl Fn(&Plan) -> bool,
    braked: impl Fn(f64) -> Option<Plan>,
) -> Plan {
    let (mut best, mut low, mut high) = (*whole, 0.0, longest);
    for step in 0..Effort::Refined.halvings() {
        if step >= effort.halvings() && !turns_round(&best) {
            break;
        }
        let time = 0.5 * (low + high);
        match braked(time) {
            Some(plan) => {
                high = time;
                if plan.path.duration() < best.path.duration() {
                    best = plan;
                }
            }
            None => low = time,
        }
    }
    best
}

/// From a constant velocity to another one and to that of `goal`; with a cruise if the limit is not far enough.
fn by_way_of_a_velocity(from: State4, goal: &Goal, limits: &Limits4) -> Path<{ fourth::STRETCHES }> {
    let upper = limits.upper();
    let constant = |velocity: f64| third::State3 { p: velocity, v: 0.0, a: 0.0 };
    let between = |one: third::State3, other: third::State3| third::fastest(one, other, &upper);
    let start = constant(from.v);
    let mut path = Path::EMPTY;
    match goal {
        Goal::Velocity(v) => path.extend(&between(start, constant(*v))),
        Goal::State(to) => {
            let both = |velocity: f64| [between(start, constant(velocity)), between(constant(velocity), to.upper())];
            let beyond = |velocity: f64| {
                let [there, back] = both(velocity);
                from.along(&there).along(&back).x - to.x
            };
            let velocity = increasing(-limits.v.below, limits.v.above, beyond);
            let [there, back] = both(velocity);
            path.extend(&there);
            if velocity >= limits.v.above || velocity <= -limits.v.below {
                path.hold(State4::CRUISE, velocity, -beyond(velocity) / velocity);
            }
            path.extend(&back);
        }
    }
    path
}
