//! Cyclic synchronous modes: the master gives a target every cycle, the drive interpolates in between.
//!
//! A target that comes with a frame is reached at the end of the cycle that begins with it. The offsets of the frame are approached
//! linearly in the same time. A cycle that begins without a new frame continues with the velocity of the one before it, or with the same
//! velocity or effort target.
use servobench_base::Stateful;
pub mod effort;
pub mod position;
pub mod velocity;

use crate::device::CycleEvent;

/// A value that approaches each target linearly within a cycle.
#[derive(Debug, Clone, Copy, PartialEq, Default, Stateful)]
struct Linear {
    from: f64,
    to: f64,
}

impl Linear {
    const fn resting(value: f64) -> Self {
        Self { from: value, to: value }
    }

    /// Starts from the end of the last cycle, or from the fraction `broken_off` at which it was aborted.
    const fn go_to(&mut self, target: f64, broken_off: Option<f64>) {
        let from = match broken_off {
            Some(passed) => self.at(passed),
            None => self.to,
        };
        *self = Self { from, to: target };
    }

    /// Value after a fraction of the cycle.
    const fn at(&self, fraction: f64) -> f64 {
        self.from + fraction * (self.to - self.from)
    }
}

/// Progress within a cycle.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Stateful)]
struct Progress {
    steps: u32,
}

impl Progress {
    /// Fraction of the cycle at which a late frame aborts it.
    fn broken_off(self, event: CycleEvent, steps: u32) -> Option<f64> {
        (event == CycleEvent::Late).then(|| f64::from(self.steps) / f64::from(steps))
    }

    /// Elapsed fraction at a step of a cycle of `steps`; counts the step. It stays at 1 in a cycle that lasts too long.
    fn next(&mut self, steps: u32) -> f64 {
        let passed = f64::from(self.steps) / f64::from(steps);
        self.steps = (self.steps + 1).min(steps);
        passed
    }
}
