//! Stop by an option code (605Ah to 605Eh): braking of the axis in every mode.
//!
//! On a ramp the velocity decreases linearly to zero, at the deceleration of the profile (6084h) or of the quick stop (6085h),
//!
//! ```text
//! v = v0 − sgn(v0)·d·t,   x = x0 + v0·t − sgn(v0)·d·t²/2,   until t = |v0|/d at x0 + v0·|v0|/(2d).
//! ```
//!
//! The offsets of the master (60B1h, 60B2h) decrease with the velocity, offset·v/v0: if they were cut off at once, the position loop would
//! have to replace them by a position error of v0/K_v, and the axis would undershoot its ramp.
//!
//! A closed position loop stays closed and holds the axis at the end; otherwise the velocity loop brakes. At the current or the voltage
//! limit the velocity loop gets a demand of standstill at once, and its limits determine the braking.
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
    /// Ramp from the present set-point and its offsets; without a deceleration standstill is demanded at once.
    #[must_use]
    pub fn begin(now: &Setpoint, offsets: Offsets, deceleration: Option<f64>, closes_position: bool) -> Self {
        let (from, duration) = match deceleration {
            Some(d) => (Setpoint { v: now.v, a: -d.copysign(now.v), ..Setpoint::at_rest(now.x) }, now.v.abs() / d),
            None => (Setpoint::at_rest(now.x), 0.0),
        };
        Self { from, duration, steps: 0, closes_position, offsets }
    }

    /// End position of the ramp.
    #[must_use]
    pub fn end(&self) -> f64 {
        self.from.after(self.duration).x
    }

    /// Demand of the next step, beginning with the present one.
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
