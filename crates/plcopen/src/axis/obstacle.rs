//! Homing steps against an obstacle, with limited effort.
//!
//! While the axis gives its maximum permitted effort, its set-point stays: one that continued beyond the obstacle would build up a
//! following error, and a push as soon as the limit is lifted. Once the obstacle is found, the remaining following error is led to zero
//! before the step is done. A drive in velocity mode follows no position, and receives the velocity until then.
use super::Axis;
use super::activity::Activity;
use super::bounds::{Bounds, Override};
use super::run::Run;
use crate::command::{Command, Obstacle};
use crate::error::AxisError;
use crate::ledger::{CommandId, Progress};
use crate::state::AxisState;
use servobench_base::{Setpoint, Stateful};
use servobench_fieldbus::AxisFeedback;
use servobench_motion::PlanError;
use servobench_motion::online::Target;

/// Part of a cycle within which a duration counts as a whole number of cycles.
const ROUNDING: f64 = 1e-9;

/// A search under way.
#[derive(Debug, Clone, PartialEq, Stateful)]
pub(super) struct Search {
    pub(super) id: CommandId,
    pub(super) command: Command,
    obstacle: Obstacle,
    /// Actual position at the start.
    from: f64,
    /// Trajectory of the set-point while it moves.
    run: Option<Run>,
    /// Once the obstacle is found: offset that the program then adds to the position of the drive.
    offset: Option<f64>,
    /// Cycles since the start.
    cycles: u64,
    /// True if the axis gives its maximum permitted effort, and number of cycles in which it did so below the velocity threshold.
    is_pushing: bool,
    held: u64,
}

/// Results of homing steps: the axis stays in Homing until a block ends it.
#[derive(Debug, Clone, Copy, PartialEq, Default, Stateful)]
pub(super) struct HomingSteps {
    /// Effort with which the axis stays at the obstacle.
    effort_limit: Option<f64>,
    /// True if the axis has found its reference.
    pub(super) has_reference: bool,
}

/// Result of one cycle of a search.
enum Finding {
    /// The axis is held.
    Obstacle,
    /// No obstacle within this limit.
    Nothing(AxisError),
    /// No obstacle yet.
    Continues,
}

impl Search {
    pub(super) const fn new(id: CommandId, command: Command, obstacle: Obstacle, from: f64) -> Self {
        Self { id, command, obstacle, from, run: None, offset: None, cycles: 0, is_pushing: false, held: 0 }
    }

    /// True if the axis is held; another command then continues from the actual position.
    pub(super) const fn is_held(&self) -> bool {
        self.is_pushing || self.offset.is_some()
    }

    fn look(&mut self, feedback: &AxisFeedback, cycle_time: f64) -> Finding {
        let Obstacle { velocity, time, effort, effort_tolerance, time_limit, distance_limit, .. } = self.obstacle;
        let lasted = |cycles: u64| (cycles as f64 + ROUNDING) * cycle_time;
        self.cycles += 1;
        self.is_pushing = self.obstacle.sign() * feedback.effort >= effort - effort_tolerance;
        self.held = if self.is_pushing && feedback.velocity.abs() < velocity { self.held + 1 } else { 0 };
        if self.held > 0 && lasted(self.held - 1) >= time {
            Finding::Obstacle
        } else if lasted(self.cycles) > time_limit {
            Finding::Nothing(AxisError::NoObstacle { input: "TimeLimit", limit: time_limit })
        } else if (feedback.position - self.from).abs() > distance_limit {
            Finding::Nothing(AxisError::NoObstacle { input: "DistanceLimit", limit: distance_limit })
        } else {
            Finding::Continues
        }
    }
}

impl Axis {
    /// Largest permitted effort of the axis; `None` leaves it to the drive.
    pub(super) const fn effort_limit(&self) -> Option<f64> {
        match (&self.activity, self.state) {
            (Activity::Search(search), _) => Some(search.obstacle.effort),
            (Activity::Rest, AxisState::Homing) => self.homing_steps.effort_limit,
            _ => None,
        }
    }

    /// Advances a search by one cycle.
    pub(super) fn advance_search(&mut self) {
        let follows_positions = self.params.velocity_ramps.is_none();
        let Activity::Search(search) = &mut self.activity else { return };
        if search.offset.is_none() {
            match search.look(&self.feedback, self.params.cycle_time) {
                Finding::Obstacle => {
                    search.offset = Some(search.obstacle.position - self.feedback.position);
                    search.run = None;
                }
                Finding::Nothing(error) => return self.fail(error),
                Finding::Continues if search.is_pushing && follows_positions => {
                    search.run = None;
                    self.base = Setpoint::at_rest(self.base.x);
                    return;
                }
                Finding::Continues => {}
            }
        }
        match self.search_on() {
            Ok(setpoint) => self.base = setpoint,
            Err(error) => return self.fail(AxisError::PlanLost { error }),
        }
        self.take_for_reference();
    }

    /// Next set-point of a search: towards the obstacle, or back to the position at which the obstacle holds the axis.
    fn search_on(&mut self) -> Result<Setpoint, PlanError> {
        let Self { params, feedback, base, .. } = self;
        let Activity::Search(search) = &mut self.activity else { return Ok(*base) };
        if search.run.is_none() {
            let bounds = Bounds::of(&search.command.dynamics, &params.limits, &Override::NONE);
            let target = match (search.offset, params.velocity_ramps) {
                (None, _) => Target::Velocity(search.obstacle.sign() * bounds.velocity),
                (Some(_), None) => Target::Position { x: feedback.position, v: 0.0 },
                (Some(_), Some(_)) => Target::Velocity(0.0),
            };
            search.run = Some(Run::new(bounds.plan(base, &target)?, 0.0, None, &bounds));
        }
        search.run.as_mut().map_or(Ok(*base), |run| run.advance(params.cycle_time))
    }

    /// Takes the position at the obstacle for the reference once the set-point is there.
    fn take_for_reference(&mut self) {
        let Activity::Search(search) = &self.activity else { return };
        let (Some(offset), true) = (search.offset, search.run.as_ref().is_some_and(Run::is_over)) else { return };
        let id = search.id;
        self.homing_steps = HomingSteps { effort_limit: Some(search.obstacle.effort), has_reference: true };
        self.offset = offset;
        if self.params.velocity_ramps.is_some() {
            self.base = Setpoint::at_rest(self.feedback.position);
        }
        self.activity = Activity::Rest;
        self.ledger.set(id, Progress::Done);
        self.take_next(self.base, 0.0);
    }
}
