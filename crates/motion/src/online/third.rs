//! The fastest way between two states of a chain of three integrators.
//!
//! Who follows the fastest way to the velocity limit for a while τ, and the fastest way to the target's velocity and
//! acceleration from there on, covers the more the longer τ is. The τ with which the target's position is met is the
//! fastest way: one rate, the other, the first again, with holds where acceleration or velocity is at its limit. When the
//! whole way to the velocity limit is not far enough, a cruise there makes up the rest.
use super::first::{State, THIRD, meeting};
use super::path::{Path, Stretch};
use super::second::{self, Limits2, Sides, State2};
use super::watch::Watch;

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

/// The fastest way from `from` to `to`. A target that is passed with an acceleration may be missed, as there may be no way of
/// this kind.
pub(crate) fn fastest(from: State3, to: State3, limits: &Limits3) -> Path<8> {
    let Limits3 { v, a, j } = *limits;
    let upper = Limits2 { a, j };
    let mut path = Path::EMPTY;
    // Back into the limit of acceleration first.
    let (excess, side) = a.excess(from.a);
    path.push(-side * j, excess / j);
    let start = from.along(&path);
    let home = |turn: State3| turn.p + second::covered(turn.upper(), to.upper(), &upper);
    let missing = to.p - home(start);
    if missing == 0.0 {
        path.extend(&second::fastest(start.upper(), to.upper(), &upper));
        return path;
    }
    let sign = if missing > 0.0 { 1.0 } else { -1.0 };
    let away = second::fastest(start.upper(), State2 { v: v.at(sign), a: 0.0 }, &upper);
    let beyond = |turn: State3| sign * (home(turn) - to.p);
    if let Some(time) = meeting(start, -missing.abs(), away.stretches(), sign * to.v >= 0.0, beyond) {
        path.extend_until(&away, time);
        path.extend(&second::fastest(start.until(&away, time).upper(), to.upper(), &upper));
        return path;
    }
    let limit = start.along(&away);
    let rest = second::fastest(State2 { v: v.at(sign), a: 0.0 }, to.upper(), &upper);
    let short = to.p - limit.along(&rest).p;
    path.extend(&away);
    path.push(0.0, short / v.at(sign));
    path.extend(&rest);
    path
}
