//! The stop that an option code asks for (605Ah to 605Eh): how the axis is braked whatever the mode.
//!
//! On a ramp the velocity goes linearly to zero, by the deceleration of the profile (6084h) or of the quick stop (6085h),
//!
//! ```text
//! v = v0 − sgn(v0)·d·t,   x = x0 + v0·t − sgn(v0)·d·t²/2,   until t = |v0|/d at x0 + v0·|v0|/(2d).
//! ```
//!
//! Where a position loop was closed it stays closed and holds the axis at the end; where none was, the velocity loop brakes.
//! At the current or the voltage limit the velocity loop is asked for standstill at once, and whatever limits it brakes.
use crate::Demand;
use servobench_base::Setpoint;

/// A ramp to standstill.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ramp {
    from: Setpoint,
    duration: f64,
    steps: u32,
    closes_position: bool,
}

impl Ramp {
    /// From the set-point of now; without a deceleration standstill is asked for at once.
    #[must_use]
    pub fn begin(now: &Setpoint, deceleration: Option<f64>, closes_position: bool) -> Self {
        let (from, duration) = match deceleration {
            Some(d) => (Setpoint { v: now.v, a: -d.copysign(now.v), ..Setpoint::at_rest(now.x) }, now.v.abs() / d),
            None => (Setpoint::at_rest(now.x), 0.0),
        };
        Self { from, duration, steps: 0, closes_position }
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
        if self.closes_position {
            Demand::position(setpoint)
        } else {
            Demand::Velocity { setpoint, effort_offset: 0.0 }
        }
    }
}
