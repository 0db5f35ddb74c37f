//! The fastest path between two states of a chain of two integrators.

use super::arrival::{NEGLIGIBLE, rounding_within};
use super::first::{State, THIRD};
use super::path::Path;

/// Maximum number of stretches: a rate, a hold, and the other rate.
pub(crate) const STRETCHES: usize = 3;

/// A state of two integrators in a row: `v` and its rate `a`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct State2 {
    pub(crate) v: f64,
    pub(crate) a: f64,
}

/// Limits of a quantity on either side of zero.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sides {
    /// Largest magnitude below zero.
    pub below: f64,
    /// Largest value above zero.
    pub above: f64,
}

/// Limits of `a` and its rate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Limits2 {
    pub(crate) a: Sides,
    /// Magnitude.
    pub(crate) j: f64,
}

impl Sides {
    /// The same magnitude on both sides.
    #[must_use]
    pub const fn both(magnitude: f64) -> Self {
        Self { below: magnitude, above: magnitude }
    }

    /// The magnitude on the side of `sign`.
    pub(crate) fn towards(self, sign: f64) -> f64 {
        if sign > 0.0 { self.above } else { self.below }
    }

    /// The value at the limit on the side of `sign`.
    pub(crate) fn at(self, sign: f64) -> f64 {
        if sign > 0.0 { self.above } else { -self.below }
    }

    /// Excess of `value` over its limit, negative within it; and its side.
    pub(crate) fn excess(self, value: f64) -> (f64, f64) {
        if value > 0.0 { (value - self.above, 1.0) } else { (-value - self.below, -1.0) }
    }
}

/// The fastest path between two states: one rate, none, and the opposite one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Fastest {
    /// The first rate.
    pub(crate) rate: f64,
    /// Duration of each.
    pub(crate) up: f64,
    pub(crate) hold: f64,
    pub(crate) down: f64,
    /// Largest value of `a` in the direction of the first rate.
    peak: f64,
}

impl Fastest {
    pub(crate) fn path(&self) -> Path<STRETCHES> {
        let mut path = Path::EMPTY;
        self.add_to(&mut path);
        path
    }

    /// Adds its stretches to `path`.
    #[inline]
    pub(crate) fn add_to<const N: usize>(&self, path: &mut Path<N>) {
        path.push(self.rate, self.up);
        path.hold(1, self.peak.copysign(self.rate), self.hold);
        path.push(-self.rate, self.down);
    }

    /// The first `time` seconds of it.
    #[inline]
    pub(crate) fn first(&self, time: f64) -> Self {
        let up = time.min(self.up);
        let hold = (time - up).min(self.hold);
        Self { up, hold, down: time - up - hold, ..*self }
    }

    /// The state at its end.
    #[inline]
    pub(crate) fn end<S: State>(&self, from: S) -> S {
        let Self { rate, up, hold, down, peak } = *self;
        let top = from.after(rate, up);
        let top = if hold == 0.0 { top } else { top.held(1, peak.copysign(rate)).after(0.0, hold) };
        top.after(-rate, down)
    }

    /// The state after `time` on it, and the rate there.
    #[inline]
    pub(crate) fn until<S: State>(&self, from: S, time: f64) -> (S, f64) {
        if time <= self.up {
            return (from.after(self.rate, time), self.rate);
        }
        let part = self.first(time);
        (part.end(from), if time - self.up <= self.hold { 0.0 } else { -self.rate })
    }

    pub(crate) fn duration(&self) -> f64 {
        self.up + self.hold + self.down
    }

    /// The integral of `v` over it.
    #[inline]
    pub(crate) fn covered(&self, from: State2, to: State2) -> f64 {
        let Self { rate, up, hold, down, .. } = *self;
        let rise = up * (from.v + 0.5 * up * (from.a + up * THIRD * rate));
        let fall = down * (to.v - 0.5 * down * (to.a + down * THIRD * rate));
        rise + hold * self.middle(from, to) + fall
    }

    /// `v` in the middle of the hold.
    #[inline]
    fn middle(&self, from: State2, to: State2) -> f64 {
        0.5 * (from.v + to.v) + (to.a * to.a - from.a * from.a) / (4.0 * self.rate)
    }

    /// Growth of [`covered`](Self::covered) plus the distance before it with the time for which `a` has changed at the rate `w` before.
    ///
    /// It is the same from every state on this path: F(p, v, a) with v + a·∂F/∂v + u·∂F/∂a = 0 at the first rate u. Another
    /// rate w for dt before changes it by (w − u)·∂F/∂a·dt = (1 − w/u)·(v + a·∂F/∂v)·dt. As v rises by dv, the middle
    /// of the path is reached dv/peak earlier: ∂F/∂v = up + hold/2 − (v in the middle)/peak.
    #[inline]
    pub(crate) fn grows(&self, from: State2, to: State2, w: f64) -> f64 {
        let Self { rate, up, hold, peak, .. } = *self;
        let by_v = up + 0.5 * hold - self.middle(from, to) / peak.copysign(rate);
        (1.0 - w / rate) * (from.v + from.a * by_v)
    }
}

/// One rate, a hold, and the other rate. The direct path between the two values of `a` decides the first one: if the
/// required gain exceeds that of the direct path, the first rate is upwards (Athans & Falb, *Optimal Control*, §7.2).
///
/// The times are quotients, not products with 1/j: the rate times such a time is, except for few values, exactly the difference
/// from which it was computed, so that no residue is integrated over a hold.
#[inline]
pub(crate) fn way(from: State2, to: State2, limits: &Limits2) -> Fastest {
    let straight = (to.a + from.a) * (to.a - from.a).abs() / (2.0 * limits.j);
    let gain = to.v - from.v;
    let sign = if gain >= straight { 1.0 } else { -1.0 };
    let (gain, a_0, a_1) = (sign * gain, sign * from.a, sign * to.a);
    // (a² − a_0²)/2j + (a² − a_1²)/2j = gain
    let squares = 0.5 * (a_0 * a_0 + a_1 * a_1);
    let free = libm::sqrt((limits.j * gain + squares).max(0.0)).max(a_0).max(a_1);
    let limit = limits.a.towards(sign);
    let (peak, hold) =
        if free <= limit { (free, 0.0) } else { (limit, (gain - (limit * limit - squares) / limits.j) / limit) };
    Fastest {
        rate: sign * limits.j,
        up: (peak - a_0) / limits.j,
        hold: hold.max(0.0),
        down: (peak - a_1) / limits.j,
        peak,
    }
}

/// The single rate that leads from `from` to the `a` of `to`, if that meets its `v`, which has the limits `v`, to rounding: the end of a
/// path on which `from` lies, whose rounding [`way`] would make up for by pulses of the length √ε.
#[inline]
pub(crate) fn ramp(from: State2, to: State2, v: Sides, limits: &Limits2) -> Option<Fastest> {
    let rise = to.a - from.a;
    let up = rise.abs() / limits.j;
    let missing = to.v - from.v - 0.5 * up * (from.a + to.a);
    let size = from.v.abs() + to.v.abs();
    let is_met = up > 0.0 && missing.abs() <= (NEGLIGIBLE * size).max(rounding_within(v, size));
    is_met.then(|| Fastest { rate: limits.j.copysign(rise), up, hold: 0.0, down: 0.0, peak: rise.signum() * to.a })
}

/// The rest of a path from `from` to `to` as it is, if that is met to rounding; the fastest path otherwise.
pub(crate) fn rest(from: State2, to: State2, v: Sides, limits: &Limits2) -> Path<STRETCHES> {
    ramp(from, to, v, limits).unwrap_or_else(|| way(from, to, limits)).path()
}

/// The fastest path from `from`, with `a` within its limits, to `to`.
pub(crate) fn fastest(from: State2, to: State2, limits: &Limits2) -> Path<STRETCHES> {
    way(from, to, limits).path()
}
