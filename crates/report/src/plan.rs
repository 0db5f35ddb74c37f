//! A move without an axis, by any planner: for a person, as JSON, as a table of samples, as a drawing.
mod csv;
mod curve;
mod drawing;
mod envelope;
mod json;
mod marks;
mod panel;
mod points;
mod rows;
mod sheet;
mod table;
mod times;
mod window;
mod words;

pub use points::{PointChoice, Unsent};

use points::Points;
use servobench_base::Setpoint;
use servobench_metrics::{DisplayUnit, DisplayUnits};
use servobench_motion::sampled::Shortest;
use servobench_motion::{PlanError, Profile};
use servobench_planner::{Plan, PlanDetails, Request};

/// Names of position and its derivatives.
const NAMES: [&str; 5] = ["position", "velocity", "acceleration", "jerk", "snap"];
/// Equal steps in which a plan without samples is shown.
const STEPS: u32 = 1000;

/// A planned move and its request.
#[derive(Debug, Clone)]
pub struct PlannedMove {
    request: Request,
    plan: Plan,
    /// Units of position and its derivatives as written in the request.
    units: DisplayUnits,
    /// The move as points, if requested.
    points: Option<Points>,
}

impl PlannedMove {
    /// Plans `request`; `unit` is that of positions, `m` or `rad`.
    ///
    /// # Errors
    /// [`PlanError`] of the planner.
    pub fn new(request: Request, unit: &'static str) -> Result<Self, PlanError> {
        let plan = request.plan()?;
        Ok(Self { request, plan, units: DisplayUnits::new(unit), points: None })
    }

    /// Shows derivative `k` of position, 0 to 4, in the unit in which `text` was written, whose value is `value`
    /// (SI). A text without a unit, or a value of zero, which does not determine the size of the unit, changes nothing.
    #[must_use]
    pub fn as_given(mut self, k: usize, text: &str, value: f64) -> Self {
        self.units = self.units.as_given(k, text, value);
        self
    }

    /// Unit in which derivative `k` is drawn: the one in which it is printed.
    fn drawn_unit(&self, k: usize) -> DisplayUnit {
        self.units.unit(k).pretty()
    }

    /// Derivative `k` of position (SI) as text.
    fn show(&self, k: usize, value: f64) -> String {
        self.units.unit(k).text(value)
    }

    /// Distance of the move (m or rad); zero if it is only rounding.
    fn distance(&self) -> f64 {
        let (from, to) = (self.plan.start().x, self.plan.end().x);
        let way = self.plan.largest()[0] * self.plan.duration();
        without_dust(to - from, from.abs().max(to.abs()).max(way))
    }

    /// The planned profile from rest to rest, if it is not filtered.
    fn profile(&self) -> Option<&Profile> {
        match self.plan.details() {
            PlanDetails::Profile(profile) if self.plan.filter_length() == 0.0 => Some(profile),
            _ => None,
        }
    }

    /// The sampled move of the fewest samples, if that was planned and is not filtered.
    fn shortest(&self) -> Option<&Shortest> {
        match self.plan.details() {
            PlanDetails::Shortest(shortest) if self.plan.filter_length() == 0.0 => Some(shortest),
            _ => None,
        }
    }

    /// Duration of each derivative at its peak within one pulse of it: name in the literature, meaning, time (s).
    fn dwells(&self) -> impl Iterator<Item = (&'static str, &'static str, f64)> {
        let times = self.profile().and_then(Profile::times);
        [
            ("t_d", "snap at its peak", times.and_then(|times| times.t_d)),
            ("t_j", "jerk at its peak", times.and_then(|times| times.t_j)),
            ("t_a", "acceleration at its peak", times.map(|times| times.t_a)),
            ("t_v", "velocity at its peak", times.map(|times| times.t_v)),
        ]
        .into_iter()
        .filter_map(|(name, meaning, value)| Some((name, meaning, value?)))
    }

    /// Sample time (s) and number of samples of a sampled plan.
    fn samples(&self) -> Option<(f64, u64)> {
        if let Some(samples) = self.profile().and_then(Profile::samples) {
            return Some((samples.time, samples.total()));
        }
        if let Some(shortest) = self.shortest() {
            return Some((shortest.sample_time(), shortest.samples()));
        }
        let time = self.plan.held()?;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "ten million at most are planned")]
        Some((time, (self.plan.duration() / time - 1e-6).ceil() as u64))
    }

    /// Duration of the published profile (s), filters included, and the relative gain over it.
    fn gain(&self) -> Option<(f64, f64)> {
        let published = self.plan.published_duration()? + self.plan.filter_length();
        (published > 0.0).then(|| (published, 1.0 - self.plan.duration() / published))
    }
}

/// `value`, or zero if it is only rounding beside values up to `largest`.
fn without_dust(value: f64, largest: f64) -> f64 {
    if value.abs() <= 1e-12 * largest { 0.0 } else { value }
}

/// Position and its derivatives.
const fn derivatives(setpoint: &Setpoint) -> [f64; 5] {
    let Setpoint { x, v, a, j, s } = *setpoint;
    [x, v, a, j, s]
}

/// Moves for the tests.
#[cfg(test)]
mod moves {
    use super::*;
    use servobench_motion::sampled::Execution;
    use servobench_motion::{Limits, Order};
    use servobench_planner::{Generator, Grid, Method, PointToPoint, Sampling};

    pub(super) const LAMBRECHTS: Limits = Limits { velocity: 1.0, acceleration: 5.0, jerk: 50.0, snap: 1000.0 };

    /// A move over `distance` (m) under `limits`.
    pub(super) fn published(order: Order, distance: f64, limits: Limits) -> PlannedMove {
        let asked = PointToPoint { distance, order, limits, method: Method::Published, grid: None };
        of(Generator::PointToPoint(asked))
    }

    /// 1 m under the limits of Lambrechts: 1.35 s at order 4, t_d = t_j = t_a = 0.05 s, t_v = 0.65 s.
    pub(super) fn lambrechts(order: Order) -> PlannedMove {
        published(order, 1.0, LAMBRECHTS)
    }

    /// Lambrechts' move with samples of `time` (s).
    pub(super) fn sampled(time: f64) -> PlannedMove {
        executed(time, Execution::ExactHold)
    }

    pub(super) fn executed(sample_time: f64, execution: Execution) -> PlannedMove {
        let grid = Some(Grid { sample_time, sampling: Sampling::Published, execution });
        let (order, method) = (Order::Fourth, Method::Published);
        of(Generator::PointToPoint(PointToPoint { distance: 1.0, order, limits: LAMBRECHTS, method, grid }))
    }

    pub(super) fn of(generator: Generator) -> PlannedMove {
        PlannedMove::new(Request::new(generator), "m").unwrap()
    }
}
