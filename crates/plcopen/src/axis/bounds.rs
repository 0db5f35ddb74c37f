//! From the inputs of a block, the limits of the axis and the override factors to a planned way.
//!
//! # Acceleration and Deceleration
//!
//! A way that goes on in one direction speeds up with Acceleration and slows down with Deceleration. One that turns back has
//! both in the same direction: it brakes before the turn and speeds up after it. Where they differ, such a way has the smaller
//! of both all along, so that neither is exceeded.
use crate::command::Dynamics;
use servobench_base::Setpoint;
use servobench_motion::online::{DirectionalLimits, Effort, Sides, Target, Transition};
use servobench_motion::{Limits, Order, PlanError};

/// The factors of MC_SetOverride.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Override {
    pub(crate) velocity: f64,
    pub(crate) acceleration: f64,
    pub(crate) jerk: f64,
}

impl Override {
    pub(crate) const NONE: Self = Self { velocity: 1.0, acceleration: 1.0, jerk: 1.0 };
}

/// What a way may not exceed, magnitudes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Bounds {
    pub(crate) velocity: f64,
    pub(crate) acceleration: f64,
    pub(crate) deceleration: f64,
    /// Infinite at order 2.
    pub(crate) jerk: f64,
    /// Infinite at orders 2 and 3.
    pub(crate) snap: f64,
}

impl Bounds {
    pub(crate) fn of(dynamics: &Dynamics, limits: &Limits, factors: &Override) -> Self {
        Self {
            velocity: dynamics.velocity.min(limits.velocity) * factors.velocity,
            acceleration: dynamics.acceleration * factors.acceleration,
            deceleration: dynamics.deceleration * factors.acceleration,
            jerk: dynamics.jerk.unwrap_or(limits.jerk) * factors.jerk,
            snap: dynamics.snap.unwrap_or(limits.snap) * factors.jerk,
        }
    }

    /// All that the axis has.
    pub(crate) const fn of_axis(limits: &Limits) -> Self {
        let Limits { velocity, acceleration, jerk, snap } = *limits;
        Self { velocity, acceleration, deceleration: acceleration, jerk, snap }
    }

    fn order(&self) -> Order {
        if self.snap < f64::INFINITY {
            Order::Fourth
        } else if self.jerk < f64::INFINITY {
            Order::Third
        } else {
            Order::Second
        }
    }

    /// The way from `from` to `target`.
    pub(crate) fn plan(&self, from: &Setpoint, target: &Target) -> Result<Transition, PlanError> {
        let (acceleration, deceleration) = (self.acceleration, self.deceleration);
        let direct = match heading(from, target) {
            1.0 => Sides { above: acceleration, below: deceleration },
            _ => Sides { above: deceleration, below: acceleration },
        };
        let way = self.within(direct, from, target)?;
        let is_symmetric = (acceleration - deceleration).abs() == 0.0;
        if is_symmetric || !turns_back(&way, TURN * self.velocity) {
            return Ok(way);
        }
        self.within(Sides::both(acceleration.min(deceleration)), from, target)
    }

    fn within(&self, acceleration: Sides, from: &Setpoint, target: &Target) -> Result<Transition, PlanError> {
        let Self { jerk, snap, .. } = *self;
        let limits = DirectionalLimits { velocity: Sides::both(self.velocity), acceleration, jerk, snap };
        Transition::plan(self.order(), from, target, &limits, Effort::Fast)
    }

    /// How far it is from `from` to the velocity `v`.
    pub(crate) fn covered(&self, from: &Setpoint, v: f64) -> Result<f64, PlanError> {
        let way = self.plan(from, &Target::Velocity(v))?;
        Ok(way.at(way.duration()).x - from.x)
    }
}

/// A velocity against the direction of a way that is no more than this part of the limit is rounding, not a turn.
const TURN: f64 = 1e-6;

/// The direction, 1 or −1, in which a way goes that does not turn back.
pub(crate) fn heading(from: &Setpoint, target: &Target) -> f64 {
    let towards = match *target {
        Target::Position { x, .. } if (x - from.x).abs() > 0.0 => x - from.x,
        Target::Velocity(v) if v != 0.0 => v,
        Target::Position { .. } | Target::Velocity(_) => from.v,
    };
    if towards < 0.0 { -1.0 } else { 1.0 }
}

/// Whether velocities above `threshold` of both signs occur on `way`.
fn turns_back(way: &Transition, threshold: f64) -> bool {
    let (mut lowest, mut highest) = (0.0_f64, 0.0_f64);
    let mut see = |v: f64| (lowest, highest) = (lowest.min(v), highest.max(v));
    see(way.at(0.0).v);
    see(way.at(way.duration()).v);
    for segment in way.segments() {
        let start = way.at(segment.start);
        see(start.v);
        // a + j·t + s·t²/2 = 0
        let root = libm::sqrt((start.j * start.j - 2.0 * start.s * start.a).max(0.0));
        let turns = [-2.0 * start.a / (start.j + root), -2.0 * start.a / (start.j - root)];
        for turn in turns.into_iter().filter(|turn| *turn > 0.0 && *turn < segment.length) {
            see(start.after(turn).v);
        }
    }
    lowest < -threshold && highest > threshold
}
