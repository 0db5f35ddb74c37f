//! The stop that an option code asks for (605Ah to 605Eh): how the axis is braked whatever the mode.
//!
//! On a ramp the velocity goes linearly to zero, by the deceleration of the profile (6084h) or of the quick stop (6085h),
//!
//! ```text
//! v = v0 − sgn(v0)·d·t,   x = x0 + v0·t − sgn(v0)·d·t²/2,   until t = |v0|/d at x0 + v0·|v0|/(2d).
//! ```
//!
//! What the master fed forward (60B1h, 60B2h) goes with the velocity, offset·v/v0: cut off at once, the position loop would have
//! to build up in its error what the offset had spared it, v0/K_v, and the axis would dive under its ramp.
//!
//! Where a position loop was closed it stays closed and holds the axis at the end; where none was, the velocity loop brakes.
//! At the current or the voltage limit the velocity loop is asked for standstill at once, and whatever limits it brakes.
use crate::{Demand, Offsets};
use servobench_base::{Setpoint, Stateful};

/// A ramp to standstill.
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub struct Ramp {
    from: Setpoint,
    duration: f64,
    steps: u32,
    closes_position: bool,
    offsets: Offsets,
}

impl Ramp {
    /// From the set-point of now and what was fed forward with it; without a deceleration standstill is asked for at once.
    #[must_use]
    pub fn begin(now: &Setpoint, offsets: Offsets, deceleration: Option<f64>, closes_position: bool) -> Self {
        let (from, duration) = match deceleration {
            Some(d) => (Setpoint { v: now.v, a: -d.copysign(now.v), ..Setpoint::at_rest(now.x) }, now.v.abs() / d),
            None => (Setpoint::at_rest(now.x), 0.0),
        };
        Self { from, duration, steps: 0, closes_position, offsets }
    }

    /// Where the ramp ends.
    #[must_use]
    pub fn end(&self) -> f64 {
        self.from.after(self.duration).x
    }

    /// The demand of the next step, the first one being that of now.
    pub fn step(&mut self, period: f64) -> Demand {
        let passed = f64::from(self.steps) * period;
        let setpoint = if passed < self.duration {
            self.steps += 1;
            self.from.after(passed)
        } else {
            Setpoint::at_rest(self.end())
        };
        let left = if self.from.v == 0.0 { 0.0 } else { setpoint.v / self.from.v };
        let Offsets { velocity: velocity_offset, effort: effort_offset } = self.offsets.scaled(left);
        if self.closes_position {
            Demand::Position { setpoint, velocity_offset, effort_offset }
        } else {
            Demand::Velocity { setpoint, effort_offset }
        }
    }
}
