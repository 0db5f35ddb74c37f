//! Limits of drives and function blocks: separate accelerations for speeding up and for braking.
use super::second::Sides;
use super::trapezoid::Rates;
use super::watch::ROUNDING;
use super::{DirectionalLimits, check_limits};
use crate::{Order, PlanError, Trajectory};
use servobench_base::Setpoint;

/// Limits of a transition, acceleration while the speed grows and while it falls; in the axis unit (m or rad).
///
/// Profile acceleration and deceleration of a drive (CiA 402, objects 6083h and 6084h), `Acceleration` ("increasing energy of
/// the motor") and `Deceleration` of a block (`PLCopen` Motion Control, part 1).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RampLimits {
    /// Velocity (m/s or rad/s).
    pub velocity: Sides,
    /// Acceleration while the speed grows (m/s² or rad/s²), a magnitude.
    pub acceleration: f64,
    /// Acceleration while the speed falls (m/s² or rad/s²), a magnitude.
    pub deceleration: f64,
    /// Jerk (m/s³ or rad/s³), a magnitude; order 2 does not use it.
    pub jerk: f64,
    /// Snap (m/s⁴ or rad/s⁴), a magnitude; orders 2 and 3 do not use it.
    pub snap: f64,
}

impl RampLimits {
    /// The limits for an axis that moves in the direction of `sign` only: acceleration is then on one side,
    /// deceleration on the other.
    #[must_use]
    pub fn towards(&self, sign: f64) -> DirectionalLimits {
        let Self { acceleration, deceleration, .. } = *self;
        self.with(if sign >= 0.0 {
            Sides { above: acceleration, below: deceleration }
        } else {
            Sides { above: deceleration, below: acceleration }
        })
    }

    /// Limits that keep these in either direction: the smaller of both accelerations.
    #[must_use]
    pub const fn either_way(&self) -> DirectionalLimits {
        self.with(Sides::both(self.acceleration.min(self.deceleration)))
    }

    /// Bounds on the limits for an axis that reverses once, to the direction of `sign`: it brakes on that side and may speed up
    /// on it, and brakes on the other one.
    pub(crate) fn turning(&self, sign: f64) -> DirectionalLimits {
        let (larger, away) = (self.acceleration.max(self.deceleration), self.deceleration);
        self.with(if sign >= 0.0 { Sides { above: larger, below: away } } else { Sides { above: away, below: larger } })
    }

    /// Relative excess of a state of `order` over the limits; negative within them.
    pub(crate) fn excess_of(&self, order: Order, state: &Setpoint) -> f64 {
        let Setpoint { v, a, j, .. } = *state;
        let acceleration = if v * a > 0.0 { self.acceleration } else { self.deceleration };
        // At rest the speed can only grow.
        let acceleration = if v == 0.0 { self.acceleration } else { acceleration };
        let (beyond, side) = self.velocity.excess(v);
        let velocity = beyond / self.velocity.towards(side);
        let jerk = if order == Order::Fourth { j.abs() / self.jerk - 1.0 } else { f64::NEG_INFINITY };
        velocity.max(a.abs() / acceleration - 1.0).max(jerk)
    }

    /// Relative excess of `way` over the limits.
    pub(crate) fn excess_on<const N: usize>(&self, way: &Trajectory<N>) -> f64 {
        let speeds = way.pieces().map(|(anchor, length)| anchor.v.abs().max(anchor.after(length).v.abs()));
        // The last bits of a velocity that is zero have a sign, too.
        let zero = ROUNDING * speeds.fold(0.0, f64::max);
        let mut most = f64::NEG_INFINITY;
        for (anchor, length) in way.pieces() {
            // Turning points of the acceleration, a + j·t + s·t²/2, and of the velocity.
            let middle = (-anchor.j / anchor.s).clamp(0.0, length);
            let middle = if middle.is_nan() { length } else { middle };
            for (start, end) in [(0.0, middle), (middle, length)] {
                let (start, length) = (anchor.after(start), end - start);
                for sign in [1.0, -1.0] {
                    most = most.max(self.excess_of_rise(&start, length, sign, zero));
                }
            }
            most = most.max(self.velocity_excess(&anchor, length));
        }
        most
    }

    /// The same of the acceleration to the side of `sign` in a time without a turning point, with speeds up to `zero` as rest.
    fn excess_of_rise(&self, start: &Setpoint, length: f64, sign: f64, zero: f64) -> f64 {
        let Self { acceleration, deceleration, .. } = *self;
        let (smaller, larger) = (acceleration.min(deceleration), acceleration.max(deceleration));
        let end = start.after(length);
        let highest = (sign * start.a).max(sign * end.a);
        if highest <= smaller * (1.0 + ROUNDING) {
            return highest / smaller - 1.0;
        }
        // Time at which the smaller one holds: j·t + s·t²/2 = rise, without cancellation.
        let rise = sign * smaller - start.a;
        let root = libm::sqrt((start.j * start.j + 2.0 * start.s * rise).max(0.0));
        let passes = 2.0 * rise / (start.j + root.copysign(end.a - start.a));
        let passes = if passes.is_nan() { 0.0 } else { passes.clamp(0.0, length) };
        let is_within = |state: &Setpoint| sign * state.a <= smaller;
        let first = sign * if is_within(start) { start.after(passes).v } else { start.v };
        let last = sign * if is_within(&end) { start.after(passes).v } else { end.v };
        // In between the velocity grows to the side of `sign`: below zero that is braking.
        let is_beyond = if deceleration < acceleration { first < -zero } else { last > zero };
        highest / if is_beyond { smaller } else { larger } - 1.0
    }

    fn velocity_excess(&self, start: &Setpoint, length: f64) -> f64 {
        let root = libm::sqrt((start.j * start.j - 2.0 * start.s * start.a).max(0.0));
        let sum = -start.j - root.copysign(start.j);
        let turns = [sum / start.s, 2.0 * start.a / sum].into_iter().filter(|t| *t > 0.0 && *t < length);
        let velocities = turns.chain([0.0, length]).map(|t| start.after(t).v);
        let part = |v: f64| {
            let (beyond, side) = self.velocity.excess(v);
            beyond / self.velocity.towards(side)
        };
        velocities.map(part).fold(f64::NEG_INFINITY, f64::max)
    }

    const fn with(&self, acceleration: Sides) -> DirectionalLimits {
        let Self { velocity, jerk, snap, .. } = *self;
        DirectionalLimits { velocity, acceleration, jerk, snap }
    }

    pub(crate) const fn rates(&self) -> Rates {
        Rates { growing: Sides::both(self.acceleration), falling: Sides::both(self.deceleration) }
    }

    pub(crate) fn check(&self, order: Order) -> Result<(), PlanError> {
        let Self { velocity, acceleration, deceleration, jerk, snap } = *self;
        let magnitudes = [
            ("velocity.above", velocity.above),
            ("velocity.below", velocity.below),
            ("acceleration", acceleration),
            ("deceleration", deceleration),
        ];
        check_limits(order, magnitudes, jerk, snap)
    }
}
