//! The fastest way between two states of a chain of two integrators.

use super::first::THIRD;
use super::path::Path;

/// A state of two integrators in a row: `v` and its rate `a`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct State2 {
    pub(crate) v: f64,
    pub(crate) a: f64,
}

/// How far a quantity may go on either side of zero.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sides {
    /// Largest magnitude below zero.
    pub below: f64,
    /// Largest value above zero.
    pub above: f64,
}

/// What `a` and its rate may be.
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

    /// How far `value` is beyond, above zero where it is; and on which side.
    pub(crate) fn excess(self, value: f64) -> (f64, f64) {
        if value > 0.0 { (value - self.above, 1.0) } else { (-value - self.below, -1.0) }
    }
}

/// The fastest way between two states, as it is in the direction in which it begins.
struct Way {
    /// The direction.
    sign: f64,
    /// Rates up, none, and down: how long each lasts.
    up: f64,
    hold: f64,
    down: f64,
    /// Largest value of `a`.
    peak: f64,
}

/// One rate, a hold, and the other rate. Which comes first is told by the straight way between the two values of `a`: who has
/// to gain more than that way gains goes up first (Athans & Falb, *Optimal Control*, §7.2).
#[inline]
fn way(from: State2, to: State2, limits: &Limits2) -> Way {
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
    Way { sign, up: (peak - a_0) / limits.j, hold, down: (peak - a_1) / limits.j, peak }
}

/// The fastest way from `from`, with `a` within its limits, to `to`.
pub(crate) fn fastest(from: State2, to: State2, limits: &Limits2) -> Path<3> {
    let Way { sign, up, hold, down, .. } = way(from, to, limits);
    let mut path = Path::EMPTY;
    path.push(sign * limits.j, up);
    path.push(0.0, hold);
    path.push(-sign * limits.j, down);
    path
}

/// The integral of `v` over that way.
#[inline]
pub(crate) fn covered(from: State2, to: State2, limits: &Limits2) -> f64 {
    let Way { sign, up, hold, down, peak } = way(from, to, limits);
    let hold = hold.max(0.0);
    let (v, a, j) = (sign * from.v, sign * from.a, limits.j);
    let risen = v + 0.5 * (a + peak) * up;
    let held = risen + peak * hold;
    let rise = up * (v + up / 2.0 * (a + up * THIRD * j));
    let fall = down * (held + down / 2.0 * (peak - down * THIRD * j));
    sign * (rise + hold * (risen + 0.5 * peak * hold) + fall)
}
