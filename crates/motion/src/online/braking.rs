//! Braking for a while before the fastest path begins.
use super::DirectionalLimits;
use super::first::State;
use super::fourth::State4;
use super::path::Path;
use super::second::{self, Limits2, Sides, State2};
use super::third::State3;
use crate::Order;
use servobench_base::Setpoint;

/// Number of times that a time is halved.
const HALVINGS: usize = 12;

/// A path on which an axis brakes, and holds that.
pub(crate) struct Braking {
    from: Setpoint,
    path: Path<{ second::STRETCHES + 1 }>,
    order: Order,
}

impl Braking {
    /// Braking to the largest acceleration on the side of `sign`, which is then held.
    pub(crate) fn towards(order: Order, from: &Setpoint, sign: f64, limits: &DirectionalLimits) -> Self {
        let mut path = Path::EMPTY;
        let a = limits.acceleration.at(sign);
        // After this time an axis has stopped.
        let hold = 2.0 * from.v.abs() / a.abs();
        if order == Order::Third {
            let rise = sign * (a - from.a);
            path.push(sign * limits.jerk, rise / limits.jerk);
            path.hold(1, a, hold);
        } else {
            let upper = Limits2 { a: Sides::both(limits.jerk), j: limits.snap };
            path.extend(&second::fastest(State2 { v: from.a, a: from.j }, State2 { v: a, a: 0.0 }, &upper));
            path.hold(2, a, hold);
        }
        Self { from: *from, path, order }
    }

    /// Braking to zero acceleration, at order 4.
    pub(crate) fn calming(from: &Setpoint, limits: &DirectionalLimits) -> Self {
        let mut path = Path::EMPTY;
        let upper = Limits2 { a: Sides::both(limits.jerk), j: limits.snap };
        path.extend(&second::fastest(State2 { v: from.a, a: from.j }, State2 { v: 0.0, a: 0.0 }, &upper));
        Self { from: *from, path, order: Order::Fourth }
    }

    /// The state after `time` (s).
    pub(crate) fn after(&self, time: f64) -> Setpoint {
        let Setpoint { x, v, a, j, .. } = self.from;
        if self.order == Order::Third {
            let State3 { p: x, v, a } = State3 { p: x, v, a }.until(&self.path, time).0;
            return Setpoint { x, v, a, ..Setpoint::default() };
        }
        let State4 { x, v, a, j } = State4 { x, v, a, j }.until(&self.path, time).0;
        Setpoint { x, v, a, j, s: 0.0 }
    }

    /// Its longest duration (s).
    pub(crate) fn duration(&self) -> f64 {
        self.path.duration()
    }

    /// Time at which `left`, which decreases, is zero (s).
    pub(crate) fn end(&self, left: impl Fn(&Setpoint) -> f64) -> f64 {
        crate::root::increasing(0.0, self.duration(), |time| -left(&self.after(time)))
    }

    /// Time at which the acceleration has changed its sign (s).
    pub(crate) fn crossing(&self) -> f64 {
        let side = if self.from.a > 0.0 { 1.0 } else { -1.0 };
        self.end(|at| side * at.a)
    }
}

/// The highest value of `f` found on the search for the smallest time that has one, up to `longest`.
pub(crate) fn least(longest: f64, f: impl Fn(f64) -> Option<f64>) -> Option<f64> {
    let parts = [1.0, 0.75, 0.5, 0.25];
    let (mut high, mut best) =
        parts.into_iter().find_map(|part| f(part * longest).map(|value| (part * longest, value)))?;
    let mut low = 0.0;
    for _ in 0..HALVINGS {
        let time = 0.5 * (low + high);
        match f(time) {
            Some(value) => (high, best) = (time, best.max(value)),
            None => low = time,
        }
    }
    Some(best)
}
