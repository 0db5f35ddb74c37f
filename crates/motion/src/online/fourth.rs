//! A fast path between two states of a chain of four integrators.
//!
//! Towards the largest acceleration, which is then held, for a while τ; then the fastest path to the target's velocity
//! ([`super::third`]). If that would exceed the velocity limit, the limit is touched for an instant, with the jerk for
//! which the target's position is met; if a touch at rest (jerk zero) is not far enough, it cruises.
use super::arrival::{NEGLIGIBLE, is_met, meet, rounding_within};
use super::first::{State, THIRD, meeting};
use super::newton::{Bracket, Near};
use super::path::Path;
use super::second::{self, Limits2, Sides, State2};
use super::third::{self, Limits3, State3};
use super::watch::{ROUNDING, Watch};
use crate::root::increasing;

/// Maximum number of stretches: there, a cruise, and back.
pub(crate) const STRETCHES: usize = third::FASTEST + 1 + third::FASTEST;

/// A state of four integrators in a row.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct State4 {
    pub(crate) x: f64,
    pub(crate) v: f64,
    pub(crate) a: f64,
    pub(crate) j: f64,
}

/// Limits of velocity, acceleration, jerk and snap.
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
    /// Limits of the chain (v, a, j).
    pub(crate) const fn upper(&self) -> Limits3 {
        Limits3 { v: self.a, a: Sides::both(self.j), j: self.d }
    }
}

impl State for State4 {
    const CRUISE: u8 = 3;

    fn position(self) -> f64 {
        self.x
    }

    fn velocity(self) -> f64 {
        self.v
    }

    fn after(self, d: f64, t: f64) -> Self {
        let Self { x, v, a, j } = self;
        Self {
            x: x + t * (v + t / 2.0 * (a + t * THIRD * (j + t / 4.0 * d))),
            v: v + t * (a + t / 2.0 * (j + t * THIRD * d)),
            a: a + t * (j + t / 2.0 * d),
            j: j + t * d,
        }
    }

    #[inline]
    fn held(self, zeros: u8, value: f64) -> Self {
        match zeros {
            1 => Self { j: value, ..self },
            2 => Self { a: value, j: 0.0, ..self },
            _ => Self { v: value, a: 0.0, j: 0.0, ..self },
        }
    }
}

impl State4 {
    pub(crate) const fn upper(self) -> State3 {
        State3 { p: self.v, v: self.a, a: self.j }
    }

    /// Passes the velocities at the turning points of `path` and at the ends of its stretches to `see`, in the order of time.
    pub(crate) fn velocities<const N: usize>(self, path: &Path<N>, see: impl FnMut(f64)) {
        self.extremes(path, see, |_| ());
    }

    /// The same, and the accelerations at theirs; returns the state at the end.
    #[inline]
    fn extremes<const N: usize>(
        self,
        path: &Path<N>,
        mut see_velocity: impl FnMut(f64),
        mut see_acceleration: impl FnMut(f64),
    ) -> Self {
        let mut state = self;
        for stretch in path.stretches() {
            // a + j·t + d·t²/2 = 0
            let [one, other] = if stretch.zeros > 0 {
                state = state.held(stretch.zeros, stretch.value);
                [-state.a / state.j, f64::NAN]
            } else {
                let d = stretch.value;
                let root = libm::sqrt(state.j * state.j - 2.0 * d * state.a);
                [(-state.j - root) / d, (-state.j + root) / d]
            };
            let in_order = if one > other { [other, one] } else { [one, other] };
            for t in in_order.into_iter().filter(|t| *t > 0.0 && *t < stretch.length) {
                see_velocity(state.after(stretch.rate(), t).v);
            }
            let turn = -state.j / stretch.rate();
            if turn > 0.0 && turn < stretch.length {
                see_acceleration(state.after(stretch.rate(), turn).a);
            }
            state = state.after(stretch.rate(), stretch.length);
            see_velocity(state.v);
            see_acceleration(state.a);
        }
        state
    }

    /// Compliance of velocity and acceleration with their limits on `path`.
    pub(crate) fn watched<const N: usize>(self, path: &Path<N>, limits: &Limits4) -> [Watch; 2] {
        let (mut velocity, mut acceleration) = (Watch::new(limits.v, self.v), Watch::new(limits.a, self.a));
        self.extremes(path, |v| velocity.see(v), |a| acceleration.see(a));
        [velocity, acceleration]
    }

    /// True if `path` keeps the limits, or comes back into them.
    fn keeps<const N: usize>(self, path: &Path<N>, limits: &Limits4) -> bool {
        self.watched(path, limits).iter().all(|watch| watch.fault <= ROUNDING)
    }
}

/// The path from `from` to `to`, which is at rest or passed at a constant velocity; `None` when this family has none.
///
/// There is room for one more cruise at the end: that of [`cruise`] is where the path back begins, which is not led back first.
pub(crate) fn fastest(from: State4, to: State4, limits: &Limits4, rounding: f64) -> Option<Path<STRETCHES>> {
    let (straight, is_rest) = rest(from.upper(), to.upper(), limits);
    let (missing, time) = (to.x - from.along(&straight).x, straight.duration());
    let rounding_v = rounding_within(limits.v, from.v.abs() + to.v.abs());
    let covered = (to.x - from.x).abs() + to.v.abs() * time;
    if missing == 0.0 || time > 0.0 && missing.abs() <= (NEGLIGIBLE * covered).max(rounding + rounding_v * time) {
        let mut path = Path::EMPTY;
        path.extend(&straight);
        return Some(path);
    }
    let straight = if is_rest { third::fastest(from.upper(), to.upper(), &limits.upper()) } else { straight };
    let path = through(from, to, limits, &straight)?;
    if to.v == 0.0 || is_met(from, to, from.along(&path), &path) {
        return Some(path);
    }
    let mut longer = Path::EMPTY;
    longer.extend(&straight);
    meet([from, to], path, |x| through(from, State4 { x, ..to }, limits, &straight), &longer)
}

/// [`third::rest`] of the velocity and its derivatives.
pub(crate) fn rest(from: State3, to: State3, limits: &Limits4) -> (Path<{ third::STRETCHES }>, bool) {
    let rounding = rounding_within(limits.v, from.p.abs() + to.p.abs());
    third::rest(from, to, &limits.upper(), rounding)
}

/// The same, met except for the rounding of its pulses.
fn through(from: State4, to: State4, limits: &Limits4, direct: &Path<{ third::STRETCHES }>) -> Option<Path<STRETCHES>> {
    let Limits4 { v, a, j, d } = *limits;
    let upper = limits.upper();
    let missing = to.x - from.along(direct).x;
    let mut path = Path::EMPTY;
    if missing == 0.0 {
        path.extend(direct);
        return Some(path);
    }
    let sign = if missing > 0.0 { 1.0 } else { -1.0 };
    let grows = sign * to.v >= 0.0;
    if grows && let Some(path) = cruise(from, to, sign, limits) {
        return Some(path);
    }
    // Up to the largest acceleration, which is held until the velocity limit would be passed.
    let limit = State2 { v: a.at(sign), a: 0.0 };
    let mut away = Path::<{ second::STRETCHES + 1 }>::EMPTY;
    away.extend(&second::fastest(State2 { v: from.a, a: from.j }, limit, &Limits2 { a: Sides::both(j), j: d }));
    away.hold(2, limit.v, (v.towards(sign) - sign * from.along(&away).v) / a.towards(sign));
    let near = Near::nothing();
    let home = |turn: State4| third::way(turn.upper(), to.upper(), &upper, &near);
    let beyond = |turn: State4, rate: f64| {
        let third::Fastest { path, by_a } = home(turn);
        let first = path.stretches().next().map_or(0.0, |first| first.rate());
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
        meeting(from, &away, beyond)
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

/// The path with a cruise at the velocity limit on the side of `sign`, if that is not too far.
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
    path.hold(State4::CRUISE, limit.p, short / v.towards(sign));
    path.extend(&rest);
    Some(path)
}

/// The path that reaches the velocity limit on the side of `sign` for an instant.
///
/// The jerk there, −`sign`·jerk, is at most that with which the last stretch to the limit and the first one from it vanish:
/// beyond, the limit is met on a very different path.
fn touch(from: State4, to: State4, sign: f64, limits: &Limits4) -> Option<Path<STRETCHES>> {
    let upper = limits.upper();
    let near = [Near::nothing(), Near::nothing()];
    let halves = |jerk: f64| {
        let join = State3 { p: limits.v.at(sign), v: 0.0, a: -sign * jerk };
        let there = third::way(from.upper(), join, &upper, &near[0]).path;
        let back = third::way(join, to.upper(), &upper, &near[1]).path;
        let arrives = there.stretches().next_back().is_none_or(|last| last.rate() * sign >= 0.0);
        let leaves = back.stretches().next().is_none_or(|first| first.rate() * sign <= 0.0);
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
    // Both paths have rounding of the size of the distance that they cover.
    let covered = (limits.v.below + limits.v.above) * path.duration();
    let is_met = missed(&there, &back).abs() <= ROUNDING * (beyond + covered);
    (is_met && from.keeps(&path, limits)).then_some(path)
}
