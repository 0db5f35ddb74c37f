//! The fastest way between two states of a chain of three integrators.
//!
//! Who follows the fastest way to the velocity limit for a while τ, and the fastest way to the target's velocity and
//! acceleration from there on, covers the more the longer τ is. The τ with which the target's position is met is the
//! fastest way: one rate, the other, the first again, with holds where acceleration or velocity is at its limit. When the
//! whole way to the velocity limit is not far enough, a cruise there makes up the rest.
use super::costate;
use super::first::{State, THIRD, meeting};
use super::newton::{Bracket, Near};
use super::path::{Path, Stretch};
use super::second::{self, Limits2, Sides, State2};
use super::watch::Watch;

/// Stretches at most: back into the limit of acceleration, there, a cruise, and back.
pub(crate) const STRETCHES: usize = 1 + second::STRETCHES + 1 + second::STRETCHES;

/// A state of three integrators in a row.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct State3 {
    pub(crate) p: f64,
    pub(crate) v: f64,
    pub(crate) a: f64,
}

/// What `v`, `a` and the rate of `a` may be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Limits3 {
    pub(crate) v: Sides,
    pub(crate) a: Sides,
    /// Magnitude.
    pub(crate) j: f64,
}

impl State for State3 {
    fn after(self, j: f64, t: f64) -> Self {
        let Self { p, v, a } = self;
        Self { p: p + t * (v + t / 2.0 * (a + t * THIRD * j)), v: v + t * (a + t / 2.0 * j), a: a + t * j }
    }
}

impl State3 {
    /// How far `path` is beyond these limits of `v` and `a`, as a part of them.
    pub(crate) fn excess<const N: usize>(self, path: &Path<N>, v: Sides, a: Sides) -> f64 {
        let (mut state, mut velocity, mut acceleration) = (self, Watch::new(v, self.v), Watch::new(a, self.a));
        for Stretch { value, length } in path.stretches() {
            let turn = -state.a / value;
            if turn > 0.0 && turn < *length {
                velocity.see(state.after(*value, turn).v);
            }
            state = state.after(*value, *length);
            velocity.see(state.v);
            acceleration.see(state.a);
        }
        velocity.most.max(acceleration.most)
    }

    const fn upper(self) -> State2 {
        State2 { v: self.v, a: self.a }
    }
}

/// A fastest way.
pub(crate) struct Way {
    pub(crate) path: Path<STRETCHES>,
    /// The change of the integral of `p` over it with `a` where it begins.
    pub(crate) by_a: f64,
}

/// The fastest way from `from` to `to`. A target that is passed with an acceleration may be missed, as there may be no way of
/// this kind.
pub(crate) fn fastest(from: State3, to: State3, limits: &Limits3) -> Path<STRETCHES> {
    way(from, to, limits, &Near::nothing()).path
}

/// The same, where τ is `near` the one of the last way.
pub(crate) fn way(from: State3, to: State3, limits: &Limits3, near: &Near) -> Way {
    let Limits3 { v, a, j } = *limits;
    let upper = Limits2 { a, j };
    let mut path = Path::EMPTY;
    // Back into the limit of acceleration first.
    let (excess, side) = a.excess(from.a);
    path.push(-side * j, excess / j);
    let start = from.along(&path);
    let home = |turn: State3| second::way(turn.upper(), to.upper(), &upper);
    let direct = home(start);
    let missing = to.p - (start.p + direct.covered(start.upper(), to.upper()));
    if missing == 0.0 {
        path.extend(&direct.path());
        return Way { path, by_a: 0.0 };
    }
    let sign = if missing > 0.0 { 1.0 } else { -1.0 };
    let limit = State2 { v: v.at(sign), a: 0.0 };
    let there = second::way(start.upper(), limit, &upper);
    let away = there.path();
    let beyond = |turn: State3, rate: f64| {
        let back = home(turn);
        let covered = turn.p + back.covered(turn.upper(), to.upper());
        (sign * (covered - to.p), sign * back.grows(turn.upper(), to.upper(), rate))
    };
    let time = if sign * to.v >= 0.0 {
        // From where the ways part to where they are the same again.
        let bracket = Bracket {
            low: if there.rate * direct.rate > 0.0 { there.up.min(direct.up) } else { 0.0 },
            high: if there.rate * sign > 0.0 { there.up + there.hold } else { there.duration() },
            missing: missing.abs(),
        };
        bracket.root(near, libm::cbrt, |time| {
            let (turn, rate) = start.until(&away, time);
            beyond(turn, rate)
        })
    } else {
        meeting(start, away.stretches(), beyond)
    };
    if let Some(time) = time {
        let back = home(start.until(&away, time).0);
        path.extend_until(&away, time);
        path.extend(&back.path());
        let risen = time.min(there.up);
        let held = (time - risen).min(there.hold);
        return Way { path, by_a: costate::by_a([risen, held, time - risen - held], None, &back, to.p) };
    }
    let back = second::way(limit, to.upper(), &upper);
    let cruise = (to.p - start.along(&away).along(&back.path()).p) / limit.v;
    path.extend(&away);
    path.push(0.0, cruise);
    path.extend(&back.path());
    Way { path, by_a: costate::by_a([there.up, there.hold, there.down], Some(cruise), &back, to.p) }
}
