//! A fast way between two states of a chain of four integrators.
//!
//! Towards the largest acceleration, and on with it, for a while τ; then the fastest way to the target's velocity
//! ([`super::third`]). Where that would exceed the velocity limit, the limit is touched for an instant, with the jerk with
//! which the target's position is met; where a touch at rest (jerk zero) is not far enough, it cruises.
use super::first::{State, THIRD, meeting};
use super::newton::{Bracket, Near};
use super::path::{Path, Stretch};
use super::second::{self, Limits2, Sides, State2};
use super::third::{self, Limits3, State3};
use super::watch::{ROUNDING, Watch};
use crate::root::increasing;

/// Stretches at most: there, a cruise, and back.
pub(crate) const STRETCHES: usize = third::STRETCHES + 1 + third::STRETCHES;

/// A state of four integrators in a row.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct State4 {
    pub(crate) x: f64,
    pub(crate) v: f64,
    pub(crate) a: f64,
    pub(crate) j: f64,
}

/// What velocity, acceleration, jerk and snap may be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Limits4 {
    pub(crate) v: Sides,
    pub(crate) a: Sides,
    /// Magnitude.
    pub(crate) j: f64,
    /// Magnitude.
    pub(crate) d: f64,
}

impl Limits4 {
    /// Those of the chain (v, a, j).
    pub(crate) const fn upper(&self) -> Limits3 {
        Limits3 { v: self.a, a: Sides::both(self.j), j: self.d }
    }
}

impl State for State4 {
    fn after(self, d: f64, t: f64) -> Self {
        let Self { x, v, a, j } = self;
        Self {
            x: x + t * (v + t / 2.0 * (a + t * THIRD * (j + t / 4.0 * d))),
            v: v + t * (a + t / 2.0 * (j + t * THIRD * d)),
            a: a + t * (j + t / 2.0 * d),
            j: j + t * d,
        }
    }
}

impl State4 {
    pub(crate) const fn upper(self) -> State3 {
        State3 { p: self.v, v: self.a, a: self.j }
    }

    /// Hands the velocities at the turning points of `path` and at the ends of its stretches to `see`, in the order of time.
    pub(crate) fn velocities<const N: usize>(self, path: &Path<N>, mut see: impl FnMut(f64)) {
        let mut state = self;
        for Stretch { value, length } in path.stretches() {
            // a + j·t + d·t²/2 = 0
            let [one, other] = if *value == 0.0 {
                [-state.a / state.j, f64::NAN]
            } else {
                let root = libm::sqrt(state.j * state.j - 2.0 * value * state.a);
                [(-state.j - root) / value, (-state.j + root) / value]
            };
            let in_order = if one > other { [other, one] } else { [one, other] };
            for t in in_order.into_iter().filter(|t| *t > 0.0 && *t < *length) {
                see(state.after(*value, t).v);
            }
            state = state.after(*value, *length);
            see(state.v);
        }
    }

    /// The same of the accelerations.
    fn accelerations<const N: usize>(self, path: &Path<N>, mut see: impl FnMut(f64)) {
        let mut state = self;
        for Stretch { value, length } in path.stretches() {
            let turn = -state.j / value;
            if turn > 0.0 && turn < *length {
                see(state.after(*value, turn).a);
            }
            state = state.after(*value, *length);
            see(state.a);
        }
    }

    /// How velocity and acceleration keep their limits on `path`.
    pub(crate) fn watched<const N: usize>(self, path: &Path<N>, limits: &Limits4) -> [Watch; 2] {
        let (mut velocity, mut acceleration) = (Watch::new(limits.v, self.v), Watch::new(limits.a, self.a));
        self.velocities(path, |v| velocity.see(v));
        self.accelerations(path, |a| acceleration.see(a));
        [velocity, acceleration]
    }

    /// Whether `path` keeps the limits, or comes back into them.
    fn keeps<const N: usize>(self, path: &Path<N>, limits: &Limits4) -> bool {
        self.watched(path, limits).iter().all(|watch| watch.fault <= ROUNDING)
    }
}

/// The way from `from` to `to`, which is at rest or passed at a constant velocity; `None` when this family has none.
pub(crate) fn fastest(from: State4, to: State4, limits: &Limits4) -> Option<Path<STRETCHES>> {
    let Limits4 { v, a, j, d } = *limits;
    let upper = limits.upper();
    let direct = third::fastest(from.upper(), to.upper(), &upper);
    let missing = to.x - from.along(&direct).x;
    let mut path = Path::EMPTY;
    if missing == 0.0 {
        path.extend(&direct);
        return Some(path);
    }
    let sign = if missing > 0.0 { 1.0 } else { -1.0 };
    let grows = sign * to.v >= 0.0;
    if grows && let Some(path) = cruise(from, to, sign, limits) {
        return Some(path);
    }
    // Up to the largest acceleration, and on with it until the velocity limit would be passed.
    let limit = State2 { v: a.at(sign), a: 0.0 };
    let mut away = Path::<{ second::STRETCHES + 1 }>::EMPTY;
    away.extend(&second::fastest(State2 { v: from.a, a: from.j }, limit, &Limits2 { a: Sides::both(j), j: d }));
    away.push(0.0, (v.towards(sign) - sign * from.along(&away).v) / a.towards(sign));
    let near = Near::nothing();
    let home = |turn: State4| third::way(turn.upper(), to.upper(), &upper, &near);
    let beyond = |turn: State4, rate: f64| {
        let third::Way { path, by_a } = home(turn);
        let first = path.stretches().first().map_or(0.0, |first| first.value);
        (sign * (turn.along(&path).x - to.x), sign * (rate - first) * by_a)
    };
    let time = if grows {
        let bracket = Bracket { low: 0.0, high: away.duration(), missing: missing.abs() };
        let fourth_root = |part: f64| libm::sqrt(libm::sqrt(part));
        bracket.root(&Near::nothing(), fourth_root, |time| {
            let (turn, rate) = from.until(&away, time);
            beyond(turn, rate)
        })
    } else {
        meeting(from, away.stretches(), beyond)
    };
    if let Some(time) = time {
        path.extend_until(&away, time);
        path.extend(&home(from.until(&away, time).0).path);
        if from.keeps(&path, limits) {
            return Some(path);
        }
    }
    if grows { None } else { cruise(from, to, sign, limits) }.or_else(|| touch(from, to, sign, limits))
}

/// The way with a cruise at the velocity limit on the side of `sign`, where that is not too far.
fn cruise(from: State4, to: State4, sign: f64, limits: &Limits4) -> Option<Path<STRETCHES>> {
    let (v, upper) = (limits.v, limits.upper());
    let limit = State3 { p: v.at(sign), v: 0.0, a: 0.0 };
    let away = third::fastest(from.upper(), limit, &upper);
    let at_limit = State4 { v: v.at(sign), a: 0.0, j: 0.0, ..from.along(&away) };
    let rest = third::fastest(limit, to.upper(), &upper);
    let short = sign * (to.x - at_limit.along(&rest).x);
    if short < 0.0 {
        return None;
    }
    let mut path = Path::EMPTY;
    path.extend(&away);
    path.push(0.0, short / v.towards(sign));
    path.extend(&rest);
    Some(path)
}

/// The way that reaches the velocity limit on the side of `sign` for an instant.
///
/// The jerk there, −`sign`·jerk, is at most that with which the last stretch to the limit and the first one from it vanish:
/// beyond, the limit is met in quite another way.
fn touch(from: State4, to: State4, sign: f64, limits: &Limits4) -> Option<Path<STRETCHES>> {
    let upper = limits.upper();
    let near = [Near::nothing(), Near::nothing()];
    let halves = |jerk: f64| {
        let join = State3 { p: limits.v.at(sign), v: 0.0, a: -sign * jerk };
        let there = third::way(from.upper(), join, &upper, &near[0]).path;
        let back = third::way(join, to.upper(), &upper, &near[1]).path;
        let arrives = there.stretches().last().is_none_or(|last| last.value * sign >= 0.0);
        let leaves = back.stretches().first().is_none_or(|first| first.value * sign <= 0.0);
        (arrives && leaves).then_some((there, back))
    };
    let missed = |there: &Path<{ third::STRETCHES }>, back: &Path<{ third::STRETCHES }>| {
        sign * (to.x - from.along(there).along(back).x)
    };
    let beyond = (to.x - from.x).abs();
    let short = |jerk: f64| halves(jerk).map_or(beyond, |(there, back)| missed(&there, &back));
    let (there, back) = halves(increasing(0.0, limits.j, short))?;
    let mut path = Path::EMPTY;
    path.extend(&there);
    path.extend(&back);
    // Both ways round at the size of what they cover.
    let covered = (limits.v.below + limits.v.above) * path.duration();
    let is_met = missed(&there, &back).abs() <= ROUNDING * (beyond + covered);
    (is_met && from.keeps(&path, limits)).then_some(path)
}
