//! Conditions that have to last: windows with a time.
use servobench_base::{ParamError, Stateful, limit, non_negative};

/// Window of a value, and the time for which it has to be inside or may be outside.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Window {
    /// Magnitude (in the unit of the value); infinite if every value is inside.
    pub width: f64,
    /// Time (s).
    pub time: f64,
}

impl Window {
    /// True if a value is inside.
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

/// Number of steps for which a condition has held.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Stateful)]
pub struct Dwell {
    steps: u32,
}

impl Dwell {
    /// Counts a step; returns true if the condition has held for `time` (s).
    #[inline]
    pub fn step(&mut self, holds: bool, time: f64, period: f64) -> bool {
        let lasted = f64::from(self.steps) * period;
        self.steps = if holds { self.steps.saturating_add(1) } else { 0 };
        // Rounding of the product does not miss a time of whole periods.
        holds && lasted >= time * (1.0 - 1e-12)
    }
}
