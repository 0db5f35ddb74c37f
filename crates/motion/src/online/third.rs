//! The fastest path between two states of a chain of three integrators.
//!
//! A path that follows the fastest one to the velocity limit for a while τ, and then the fastest one to the target's velocity and
//! acceleration, covers the more the longer τ is. The τ for which the target's position is met is the
//! fastest path: one rate, the other, the first again, with holds where acceleration or velocity is at its limit. If the
//! whole path to the velocity limit is not far enough, a cruise there makes up the rest.
use super::arrival::{NEGLIGIBLE, is_met, meet, rounding_within};
use super::costate;
use super::first::{State, THIRD, meeting};
use super::newton::{Bracket, Near};
use super::path::Path;
use super::second::{self, Limits2, Sides, State2};
use super::watch::Watch;

/// Maximum number of stretches of a fastest path: back into the limit of acceleration, there, a cruise, and back.
pub(crate) const FASTEST: usize = 1 + second::STRETCHES + 1 + second::STRETCHES;
/// The same, and a cruise at the velocity of the target.
pub(crate) const STRETCHES: usize = FASTEST + 1;

/// A state of three integrators in a row.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct State3 {
    pub(crate) p: f64,
    pub(crate) v: f64,
    pub(crate) a: f64,
}

/// Limits of `v`, `a` and the rate of `a`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Limits3 {
    pub(crate) v: Sides,
    pub(crate) a: Sides,
    /// Magnitude.
    pub(crate) j: f64,
}

impl State for State3 {
    const CRUISE: u8 = 2;

    fn position(self) -> f64 {
        self.p
    }

    fn velocity(self) -> f64 {
        self.v
    }

    fn after(self, j: f64, t: f64) -> Self {
        let Self { p, v, a } = self;
        Self { p: p + t * (v + t / 2.0 * (a + t * THIRD * j)), v: v + t * (a + t / 2.0 * j), a: a + t * j }
    }

    #[inline]
    fn held(self, zeros: u8, value: f64) -> Self {
        if zeros == 1 { Self { a: value, ..self } } else { Self { v: value, a: 0.0, ..self } }
    }
}

impl State3 {
    /// Passes the velocities at the turning points of `path` and at the ends of its stretches to `see`, in the order of time.
    pub(crate) fn velocities<const N: usize>(self, path: &Path<N>, see: impl FnMut(f64)) {
        self.extremes(path, see, |_| ());
    }

    /// The same, and the accelerations at the ends; returns the state at the end.
    #[inline]
    fn extremes<const N: usize>(
        self,
        path: &Path<N>,
        mut see_velocity: impl FnMut(f64),
        mut see_acceleration: impl FnMut(f64),
    ) -> Self {
        let mut state = self;
        for stretch in path.stretches() {
            let turn = -state.a / stretch.rate();
            if turn > 0.0 && turn < stretch.length {
                see_velocity(state.on(&stretch, turn).v);
            }
            state = state.on(&stretch, stretch.length);
            see_velocity(state.v);
            see_acceleration(state.a);
        }
        state
    }

    /// State at the end of `path`, and its relative excess over these limits of `v` and `a`.
    #[inline]
    pub(crate) fn excess<const N: usize>(self, path: &Path<N>, v: Sides, a: Sides) -> (Self, f64) {
        let (mut velocity, mut acceleration) = (Watch::new(v, self.v), Watch::new(a, self.a));
        let end = self.extremes(path, |v| velocity.see(v), |a| acceleration.see(a));
        (end, velocity.most.max(acceleration.most))
    }

    const fn upper(self) -> State2 {
        State2 { v: self.v, a: self.a }
    }
}

/// A fastest path.
pub(crate) struct Fastest {
    pub(crate) path: Path<STRETCHES>,
    /// Change of the integral of `p` over it with the initial `a`.
    pub(crate) by_a: f64,
}

/// Sets `path` to the fastest path from `from` to `to`, which is passed without acceleration at its velocity, and returns its excess
/// over the limits. The distance between both is known to `rounding`.
#[inline]
pub(crate) fn passing(from: State3, to: State3, limits: &Limits3, rounding: f64, path: &mut Path<STRETCHES>) -> f64 {
    let (_, is_rest) = find::<false, true>(from, to, limits, rounding, &Near::nothing(), path);
    let (end, excess) = from.excess(path, limits.v, limits.a);
    if is_rest || is_met(from, to, end, path) {
        return excess;
    }
    let plan = |p: f64| Some(fastest(from, State3 { p, ..to }, limits));
    *path = meet([from, to], *path, plan, &straight(from, to, limits)).unwrap_or(*path);
    from.excess(path, limits.v, limits.a).1
}

/// The fastest path from `from` to the derivatives of `to`, at any position.
pub(crate) fn straight<const N: usize>(from: State3, to: State3, limits: &Limits3) -> Path<N> {
    let mut path = Path::EMPTY;
    let start = led_back(from, limits, &mut path);
    path.extend(&second::rest(start.upper(), to.upper(), limits.v, &Limits2 { a: limits.a, j: limits.j }));
    path
}

/// Adds the path back into the limits of acceleration to `path`, and returns the state behind it.
#[inline]
fn led_back<const N: usize>(from: State3, limits: &Limits3, path: &mut Path<N>) -> State3 {
    let (excess, side) = limits.a.excess(from.a);
    path.push(-side * limits.j, excess / limits.j);
    from.along(path)
}

/// The fastest path from `from` to `to`. A target that is passed with an acceleration may be missed, as there may be no path of
/// this kind.
#[inline]
pub(crate) fn fastest(from: State3, to: State3, limits: &Limits3) -> Path<STRETCHES> {
    let mut path = Path::EMPTY;
    find::<false, false>(from, to, limits, 0.0, &Near::nothing(), &mut path);
    path
}

/// The rest of a path from `from` to `to` as it is, if that is met to rounding, and true; the fastest path otherwise.
#[inline]
pub(crate) fn rest(from: State3, to: State3, limits: &Limits3, rounding: f64) -> (Path<STRETCHES>, bool) {
    let mut path = Path::EMPTY;
    let (_, is_rest) = find::<false, true>(from, to, limits, rounding, &Near::nothing(), &mut path);
    (path, is_rest)
}

/// The same, with τ `near` that of the last path.
#[inline]
pub(crate) fn way(from: State3, to: State3, limits: &Limits3, near: &Near) -> Fastest {
    let mut way = Fastest { path: Path::EMPTY, by_a: 0.0 };
    way.by_a = find::<true, false>(from, to, limits, 0.0, near, &mut way.path).0;
    way
}

/// Adds the fastest path to `path`, which is empty, and returns its [`Fastest::by_a`] if requested; and true if it is the direct
/// path to the derivatives of `to`, which is taken with `REST` if it meets the position to rounding.
///
/// If a path is a function of its start, as in the roots of order 4, that would be a step in it.
fn find<const BY_A: bool, const REST: bool>(
    from: State3,
    to: State3,
    limits: &Limits3,
    rounding: f64,
    near: &Near,
    path: &mut Path<STRETCHES>,
) -> (f64, bool) {
    let Limits3 { v, a, j } = *limits;
    let upper = Limits2 { a, j };
    let start = led_back(from, limits, path);
    let home = |turn: State3| second::way(turn.upper(), to.upper(), &upper);
    let missing = |straight: &second::Fastest| to.p - (start.p + straight.covered(start.upper(), to.upper()));
    let is_negligible = |straight: &second::Fastest, missing: f64| {
        let time = straight.duration();
        let covered = start.p.abs() + to.p.abs() + to.v.abs() * time;
        let rounding = rounding + rounding_within(v, start.v.abs() + to.v.abs()) * time;
        time > 0.0 && missing.abs() <= (NEGLIGIBLE * covered).max(rounding)
    };
    if REST
        && let Some(ramp) = second::ramp(start.upper(), to.upper(), v, &upper)
        && is_negligible(&ramp, missing(&ramp))
    {
        ramp.add_to(path);
        return (0.0, true);
    }
    let direct = home(start);
    let missing = missing(&direct);
    if missing == 0.0 || (REST || to.v != 0.0) && is_negligible(&direct, missing) {
        direct.add_to(path);
        return (0.0, true);
    }
    let sign = if missing > 0.0 { 1.0 } else { -1.0 };
    let limit = State2 { v: v.at(sign), a: 0.0 };
    let there = second::way(start.upper(), limit, &upper);
    let beyond = |turn: State3, rate: f64| {
        let back = home(turn);
        let covered = turn.p + back.covered(turn.upper(), to.upper());
        (sign * (covered - to.p), sign * back.grows(turn.upper(), to.upper(), rate))
    };
    let time = if sign * to.v >= 0.0 {
        // From where the paths part to where they are the same again.
        let bracket = Bracket {
            low: if there.rate * direct.rate > 0.0 { there.up.min(direct.up) } else { 0.0 },
            high: if there.rate * sign > 0.0 && sign * to.a <= 0.0 { there.up + there.hold } else { there.duration() },
            missing: missing.abs(),
        };
        bracket.root(near, libm::cbrt, |time| {
            let (turn, rate) = there.until(start, time);
            beyond(turn, rate)
        })
    } else {
        meeting(start, &there.path(), beyond)
    };
    if let Some(time) = time {
        let back = home(there.until(start, time).0);
        let away = there.first(time);
        away.add_to(path);
        back.add_to(path);
        let by_a = if BY_A { costate::by_a([away.up, away.hold, away.down], None, &back, to.p) } else { 0.0 };
        return (by_a, false);
    }
    let back = second::way(limit, to.upper(), &upper);
    let at_limit = there.end(start).held(State3::CRUISE, limit.v);
    let cruise = (to.p - back.end(at_limit).p) / limit.v;
    there.add_to(path);
    path.hold(State3::CRUISE, limit.v, cruise);
    back.add_to(path);
    let by_a = if BY_A { costate::by_a([there.up, there.hold, there.down], Some(cruise), &back, to.p) } else { 0.0 };
    (by_a, false)
}
