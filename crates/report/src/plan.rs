//! A rest-to-rest move on paper: for a person, as JSON, as a table of samples, as a drawing.
mod axis;
mod csv;
mod curve;
mod drawing;
mod given;
mod json;
mod panel;
mod table;
mod ticks;
mod times;

use given::Given;
use servobench_motion::{Limits, Profile};

/// Names of position and its derivatives.
const NAMES: [&str; 5] = ["position", "velocity", "acceleration", "jerk", "snap"];
/// Equal steps in which a plan is shown that has no samples of its own.
const STEPS: u32 = 1000;

/// A planned move and what was asked for.
#[derive(Debug, Clone, PartialEq)]
pub struct PlannedMove {
    profile: Profile,
    limits: Limits,
    unit: &'static str,
    /// Distance and limits of velocity, acceleration, jerk, snap in the units of whoever asked.
    given: [Option<Given>; 5],
}

impl PlannedMove {
    /// The move `profile`, planned under `limits`; `unit` is that of positions, `m` or `rad`.
    #[must_use]
    pub const fn new(profile: Profile, limits: Limits, unit: &'static str) -> Self {
        Self { profile, limits, unit, given: [None, None, None, None, None] }
    }

    /// The same, with distance and limits (velocity, acceleration, jerk, snap) shown in the units in which they were
    /// written.
    #[must_use]
    pub fn as_given<'a>(mut self, distance: &'a str, limits: impl IntoIterator<Item = &'a str>) -> Self {
        for (slot, text) in self.given.iter_mut().zip([distance].into_iter().chain(limits)) {
            *slot = Given::read(text);
        }
        self
    }

    /// Unit of the derivative `n` of position.
    fn unit_of(&self, n: usize) -> String {
        let power = ["", "/s", "/s²", "/s³", "/s⁴"][n];
        format!("{}{power}", self.unit)
    }

    /// Limits of velocity, acceleration, jerk and snap that the order uses.
    fn limits(&self) -> impl Iterator<Item = f64> {
        let Limits { velocity, acceleration, jerk, snap } = self.limits;
        [velocity, acceleration, jerk, snap].into_iter().take(self.profile.order().derivative())
    }

    /// Peaks of the same derivatives.
    fn peaks(&self) -> impl Iterator<Item = f64> {
        let peaks = self.profile.peaks();
        [peaks.velocity, peaks.acceleration, peaks.jerk, peaks.snap].into_iter().take(self.profile.order().derivative())
    }

    /// How long each derivative stays at its peak within one pulse of it: name in the literature, meaning, time (s).
    fn dwells(&self) -> impl Iterator<Item = (&'static str, &'static str, f64)> {
        let times = self.profile.times();
        [
            ("t_d", "snap at its peak", times.and_then(|times| times.t_d)),
            ("t_j", "jerk at its peak", times.and_then(|times| times.t_j)),
            ("t_a", "acceleration at its peak", times.map(|times| times.t_a)),
            ("t_v", "velocity at its peak", times.map(|times| times.t_v)),
        ]
        .into_iter()
        .filter_map(|(name, meaning, value)| Some((name, meaning, value?)))
    }

    /// Times that cut the move into [`STEPS`] equal steps (s).
    fn steps(&self) -> impl Iterator<Item = f64> {
        (0..=STEPS).map(|k| self.profile.duration() * f64::from(k) / f64::from(STEPS))
    }
}

/// Moves for the tests.
#[cfg(test)]
mod moves {
    use super::*;
    use servobench_motion::Order;

    const LAMBRECHTS: Limits = Limits { velocity: 1.0, acceleration: 5.0, jerk: 50.0, snap: 1000.0 };

    /// 1 m under the limits of Lambrechts: 1.35 s at order 4, t_d = t_j = t_a = 0.05 s, t_v = 0.65 s.
    pub(super) fn lambrechts(order: Order) -> PlannedMove {
        PlannedMove::new(Profile::plan(order, 1.0, &LAMBRECHTS).unwrap(), LAMBRECHTS, "m")
    }

    /// The same with samples of `time` (s).
    pub(super) fn sampled(time: f64) -> PlannedMove {
        PlannedMove::new(Profile::plan_sampled(Order::Fourth, 1.0, &LAMBRECHTS, time).unwrap(), LAMBRECHTS, "m")
    }
}
