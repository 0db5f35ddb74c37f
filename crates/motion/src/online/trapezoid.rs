//! Order 2 in closed form: one ramp to the highest velocity, a cruise there, and one ramp to the target's velocity.
//!
//! A ramp of the rate r from the velocity v to w covers (w² − v²)/2r upwards, and the opposite of that downwards. The rate may be
//! one while the speed grows and another while it falls; then a ramp through zero is two, and each square has the rate of its own
//! side. With u the rate at which the speed grows in the direction of the move and d that at which it falls, r₀ that of the ramp
//! up at v₀ and r₁ that of the ramp down at v₁,
//!
//! ```text
//! x₁ − x₀ = w²/2u − v₀²/2r₀ + w²/2d − v₁²/2r₁      w = √(2·(x₁ − x₀ + v₀²/2r₀ + v₁²/2r₁)·u·d/(u + d))
//! ```
//!
//! gives the highest velocity w. The move is in the direction in which the ramp from v₀ directly to v₁ falls short of x₁; a
//! longer path is later at every velocity below, so that no other path is shorter (Athans & Falb, *Optimal Control*,
//! §7.2).
use super::arrival::NEGLIGIBLE;
use super::path::Path;
use super::second::Sides;

/// Maximum number of stretches: two ramps, each through zero, and the cruise.
pub(crate) const STRETCHES: usize = 5;

/// The rates of the velocity, each by direction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Rates {
    /// While the speed grows.
    pub(crate) growing: Sides,
    /// While it falls.
    pub(crate) falling: Sides,
}

impl Rates {
    /// The same rates whether the speed grows or falls.
    pub(crate) const fn by_direction(acceleration: Sides) -> Self {
        Self { growing: acceleration, falling: acceleration }
    }

    /// In the direction of `sign` at the velocity `v`, on its side of zero.
    fn towards(&self, sign: f64, v: f64) -> f64 {
        if sign * v > 0.0 { self.growing.towards(sign) } else { self.falling.towards(sign) }
    }

    /// v²/2r on a ramp in the direction of `sign`.
    fn square(&self, sign: f64, v: f64) -> f64 {
        0.5 * v * v / self.towards(sign, v)
    }

    /// Distance of the ramp from `v` to `w`.
    pub(crate) fn covered(&self, v: f64, w: f64) -> f64 {
        let sign = direction(w - v);
        sign * (self.square(sign, w) - self.square(sign, v))
    }

    /// Appends the ramp from `v` to `w` to `path`.
    pub(crate) fn ramp<const N: usize>(&self, v: f64, w: f64, path: &mut Path<N>) {
        let sign = direction(w - v);
        let mut from = v;
        if sign * v < 0.0 && sign * w > 0.0 {
            let rate = self.falling.towards(sign);
            path.push(sign * rate, v.abs() / rate);
            from = 0.0;
        }
        let rate = self.towards(sign, if from == 0.0 { w } else { from });
        path.push(sign * rate, (w - from).abs() / rate);
    }
}

fn direction(difference: f64) -> f64 {
    if difference >= 0.0 { 1.0 } else { -1.0 }
}

/// Appends the fastest path from the velocity `from` to the velocity `to` that covers `distance`, which is known to `rounding`, to `path`.
///
/// If the ramp alone covers it to rounding, it is the rest of the present path, and taken: the root would make up for a
/// part of 1e-16 by 1e-8 of the velocity.
pub(crate) fn fastest(
    [from, to]: [f64; 2],
    distance: f64,
    rounding: f64,
    limit: Sides,
    rates: &Rates,
    path: &mut Path<STRETCHES>,
) {
    let towards = direction(to - from);
    let [start, end] = [rates.square(towards, from), rates.square(towards, to)];
    let missing = distance - towards * (end - start);
    let rounding = rounding + 2.0 * f64::EPSILON * (start + end);
    if (to - from).abs() > 0.0 && missing.abs() <= rounding.max(NEGLIGIBLE * distance.abs()) {
        return rates.ramp(from, to, path);
    }
    if missing == 0.0 {
        return;
    }
    let sign = direction(missing);
    let (up, down) = (rates.growing.towards(sign), rates.falling.towards(-sign));
    let squares = rates.square(sign, from) + rates.square(-sign, to);
    let free = libm::sqrt((2.0 * (sign * distance + squares) * up * down / (up + down)).max(0.0));
    let (highest, limit) = (free.max(sign * from).max(sign * to), limit.towards(sign));
    if highest <= limit {
        rates.ramp(from, sign * highest, path);
        rates.ramp(sign * highest, to, path);
    } else {
        let cruise = sign * limit;
        let ramps = rates.covered(from, cruise) + rates.covered(cruise, to);
        rates.ramp(from, cruise, path);
        path.hold(1, cruise, (distance - ramps) / cruise);
        rates.ramp(cruise, to, path);
    }
}
