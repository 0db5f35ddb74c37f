//! A planned way under way.
use super::bounds::Bounds;
use servobench_base::Setpoint;
use servobench_motion::online::{Target, Transition};
use servobench_motion::{Piece, PlanError};

/// An end that is nearer to a cycle than this part of its time is in that cycle: only rounding keeps it from being there.
const ROUNDING: f64 = 1e-9;

/// A way and how much of it is behind.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Run {
    way: Transition,
    piece: Piece,
    /// Time at cycle 0 (s).
    lead: f64,
    cycles: u64,
    /// What follows at the end of the way: the rest of a passage that is faster than the way to it.
    then: Option<(Target, Bounds)>,
}

impl Run {
    /// `way`, begun `lead` seconds before this cycle.
    #[expect(clippy::large_types_passed_by_value, reason = "it is moved in, once per command")]
    pub(crate) fn new(way: Transition, lead: f64, then: Option<(Target, Bounds)>) -> Self {
        Self { piece: way.piece(lead), way, lead, cycles: 0, then }
    }

    /// The set-point one cycle later.
    #[inline]
    pub(crate) fn advance(&mut self, cycle_time: f64) -> Result<Setpoint, PlanError> {
        self.cycles += 1;
        let setpoint = self.now(cycle_time);
        match self.then {
            Some((target, bounds)) if self.beyond(cycle_time) >= 0.0 => {
                let end = self.way.at(self.way.duration());
                *self = Self::new(bounds.plan(&end, &target)?, self.beyond(cycle_time), None);
                Ok(self.now(cycle_time))
            }
            _ => Ok(setpoint),
        }
    }

    /// The set-point of this cycle.
    #[inline]
    pub(crate) fn now(&mut self, cycle_time: f64) -> Setpoint {
        let t = self.time(cycle_time);
        if !self.piece.holds(t) {
            self.piece = self.way.piece(t);
        }
        self.piece.at(t)
    }

    /// By how much its end is behind (s), below zero before it.
    #[inline]
    pub(crate) fn beyond(&self, cycle_time: f64) -> f64 {
        self.time(cycle_time) - self.way.duration()
    }

    /// Whether its end is reached, and nothing follows.
    #[inline]
    pub(crate) fn is_over(&self, cycle_time: f64) -> bool {
        self.then.is_none() && self.beyond(cycle_time) >= 0.0
    }

    /// Whether something follows that is not yet planned.
    pub(crate) const fn is_preliminary(&self) -> bool {
        self.then.is_some()
    }

    /// The set-point at its end.
    pub(crate) fn end(&self) -> Setpoint {
        self.way.at(self.way.duration())
    }

    #[inline]
    fn time(&self, cycle_time: f64) -> f64 {
        let (time, end) = (self.lead + self.cycles as f64 * cycle_time, self.way.duration());
        if (time - end).abs() <= ROUNDING * cycle_time { end } else { time }
    }
}
