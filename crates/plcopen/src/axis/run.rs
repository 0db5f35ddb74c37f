//! Progress along a planned trajectory.
use super::bounds::Bounds;
use servobench_base::{Setpoint, Stateful};
use servobench_motion::online::{Target, Transition};
use servobench_motion::{Piece, PlanError};

/// Relative tolerance for rounding: an end nearer to a cycle than this part of the cycle time is in that cycle, and a trajectory that
/// exceeds a limit by this part of it does not.
const ROUNDING: f64 = 1e-9;

/// A trajectory and the time spent on it.
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub(crate) struct Run {
    way: Transition,
    piece: Piece,
    /// Time at cycle 0 (s).
    lead: f64,
    cycles: u64,
    /// Time of this cycle (s).
    time: f64,
    /// Continuation at the end of the trajectory, planned when that is reached.
    then: Option<(Target, Bounds)>,
    /// Share of the axis for a trajectory that may use more than its command does.
    axis: Bounds,
    /// Target and bounds of the plan.
    planned_for: Option<(Target, Bounds)>,
    /// Position that is passed although it is not the end, and the sign of the velocity there.
    passed: Option<(f64, f64)>,
}

impl Run {
    /// `way`, begun `lead` seconds before this cycle, on an axis with the bounds `axis`.
    #[expect(clippy::large_types_passed_by_value, reason = "it is moved in, once per command")]
    pub(crate) fn new(way: Transition, lead: f64, then: Option<(Target, Bounds)>, axis: &Bounds) -> Self {
        let (piece, axis) = (way.piece(lead), *axis);
        Self { way, piece, lead, cycles: 0, time: lead, then, axis, planned_for: None, passed: None }
    }

    /// The same run, marked as planned for `target` within `bounds`.
    pub(crate) fn planned_for(self, target: Target, bounds: Bounds) -> Self {
        Self { planned_for: Some((target, bounds)), ..self }
    }

    /// The same run for the request of `other`, passing its position `x` in the direction of `sign`.
    pub(crate) fn passing(self, x: f64, sign: f64, other: &Self) -> Self {
        Self { planned_for: other.planned_for, passed: Some((x, sign)), ..self }
    }

    /// The same run, continued from its end to the target of `other`.
    pub(crate) fn then_as(self, other: &Self) -> Self {
        Self { then: self.then.or(other.planned_for), ..self }
    }

    /// True if the run already leads from `from` to `target` within `bounds`, on an axis with the bounds `axis`.
    pub(crate) fn is_for(&self, from: &Setpoint, target: Target, bounds: Bounds, axis: &Bounds) -> bool {
        let is_same = self.planned_for == Some((target, bounds)) && self.axis == *axis;
        is_same && self.beyond() < 0.0 && self.way.at(self.time) == *from
    }

    /// True if the run has passed, at `x`, the position that is not its end.
    pub(crate) fn has_passed(&self, x: f64) -> bool {
        self.passed.is_some_and(|(position, sign)| sign * (x - position) >= 0.0)
    }

    /// True if the velocity never leaves the side of `sign`.
    pub(crate) fn keeps_direction(&self, sign: f64) -> bool {
        let goes_on = |(target, bounds): (Target, Bounds)| {
            bounds.plan(&self.end(), &target).is_ok_and(|way| way.keeps_direction(sign))
        };
        self.way.keeps_direction(sign) && self.then.is_none_or(goes_on)
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
            let next = Self::new(bounds.plan(&self.end(), &target)?, self.beyond(), None, &self.axis);
            *self = Self { planned_for: self.planned_for, passed: self.passed, ..next };
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

    /// Time since the end (s), below zero before it.
    #[inline]
    pub(crate) fn beyond(&self) -> f64 {
        self.time - self.way.duration()
    }

    /// True if the end is reached and nothing follows.
    #[inline]
    pub(crate) fn is_over(&self) -> bool {
        self.beyond() >= 0.0 && self.then.is_none()
    }

    /// Share of the axis, while the run may use more than its command does.
    pub(crate) fn bounds_beyond_command(&self) -> Option<&Bounds> {
        self.is_leading_in().then_some(&self.axis)
    }

    /// True while the run may use more than its command does: on the return into the limits of that, or before it.
    pub(crate) fn is_leading_in(&self) -> bool {
        self.then.is_some() || (self.way.excess() > ROUNDING && self.beyond() < 0.0)
    }

    /// Set-point at the end.
    pub(crate) fn end(&self) -> Setpoint {
        self.way.at(self.way.duration())
    }
}
