//! Conditions that have to last: windows with a time.
use servobench_base::{ParamError, Stateful, limit, non_negative};

/// How near a value must be, or how far it may be, and for how long.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Window {
    /// Magnitude (the unit of the value); infinite where everything is inside.
    pub width: f64,
    /// Time (s).
    pub time: f64,
}

impl Window {
    /// Whether a value is inside.
    #[inline]
    #[must_use]
    pub fn holds(&self, value: f64) -> bool {
        value.abs() <= self.width
    }

    /// # Errors
    /// [`ParamError`] with one of the two names.
    pub fn check(&self, [width, time]: [&'static str; 2]) -> Result<(), ParamError> {
        limit(width, self.width)?;
        non_negative(time, self.time).map(|_| ())
    }
}

/// For how many steps a condition has held.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Stateful)]
pub struct Dwell {
    steps: u32,
}

impl Dwell {
    /// Counts a step; whether the condition has held since `time` (s) ago or before.
    #[inline]
    pub fn step(&mut self, holds: bool, time: f64, period: f64) -> bool {
        let lasted = f64::from(self.steps) * period;
        self.steps = if holds { self.steps.saturating_add(1) } else { 0 };
        // A time of whole periods is not missed by a rounding of the product.
        holds && lasted >= time * (1.0 - 1e-12)
    }
}
