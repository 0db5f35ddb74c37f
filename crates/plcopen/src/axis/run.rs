//! A planned way under way.
use super::bounds::Bounds;
use servobench_base::Setpoint;
use servobench_motion::online::{Target, Transition};
use servobench_motion::{Piece, PlanError};

/// What rounding may make of a whole: an end that is nearer to a cycle than this part of its time is in that cycle, a way that is
/// beyond a limit by this part of it is not.
const ROUNDING: f64 = 1e-9;

/// A way and how much of it is behind.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Run {
    way: Transition,
    piece: Piece,
    /// Time at cycle 0 (s).
    lead: f64,
    cycles: u64,
    /// Time of this cycle (s).
    time: f64,
    /// What follows at the end of the way, planned when it is reached.
    then: Option<(Target, Bounds)>,
    /// What there is of the axis for the way where it may use more than its command does.
    axis: Bounds,
}

impl Run {
    /// `way`, begun `lead` seconds before this cycle, on an axis with the bounds `axis`.
    #[expect(clippy::large_types_passed_by_value, reason = "it is moved in, once per command")]
    pub(crate) fn new(way: Transition, lead: f64, then: Option<(Target, Bounds)>, axis: &Bounds) -> Self {
        Self { piece: way.piece(lead), way, lead, cycles: 0, time: lead, then, axis: *axis }
    }

    /// The set-point one cycle later.
    #[inline]
    pub(crate) fn advance(&mut self, cycle_time: f64) -> Result<Setpoint, PlanError> {
        self.cycles += 1;
        let (time, end) = (self.lead + self.cycles as f64 * cycle_time, self.way.duration());
        self.time = if (time - end).abs() <= ROUNDING * cycle_time { end } else { time };
        if let Some((target, bounds)) = self.then
            && self.beyond() >= 0.0
        {
            *self = Self::new(bounds.plan(&self.end(), &target)?, self.beyond(), None, &self.axis);
        }
        Ok(self.now())
    }

    /// The set-point of this cycle.
    #[inline]
    pub(crate) fn now(&mut self) -> Setpoint {
        if !self.piece.holds(self.time) {
            self.piece = self.way.piece(self.time);
        }
        self.piece.at(self.time)
    }

    /// By how much its end is behind (s), below zero before it.
    #[inline]
    pub(crate) fn beyond(&self) -> f64 {
        self.time - self.way.duration()
    }

    /// Whether its end is reached, and nothing follows.
    #[inline]
    pub(crate) fn is_over(&self) -> bool {
        self.beyond() >= 0.0 && self.then.is_none()
    }

    /// What there is of the axis for it, while it may use more than its command does.
    pub(crate) fn bounds_beyond_command(&self) -> Option<&Bounds> {
        self.is_leading_in().then_some(&self.axis)
    }

    /// Whether it may use more than its command does: on the way back into the limits of that, or before it.
    pub(crate) fn is_leading_in(&self) -> bool {
        self.then.is_some() || (self.way.excess() > ROUNDING && self.beyond() < 0.0)
    }

    /// The set-point at its end.
    pub(crate) fn end(&self) -> Setpoint {
        self.way.at(self.way.duration())
    }
}
