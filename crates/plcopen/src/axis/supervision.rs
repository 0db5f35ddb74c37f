//! Power, faults and the reset: the arrows that no motion command triggers.
use super::Axis;
use super::activity::{Activity, Leaving, Moving};
use super::bounds::Bounds;
use super::commands::Start;
use super::run::Run;
use crate::arrows::{Cause, arrow};
use crate::blocks::BlockName;
use crate::command::{BufferMode, Command, Dynamics, Goal};
use crate::error::{AxisError, BlockError};
use crate::ledger::{CommandId, Progress};
use crate::state::AxisState;
use servobench_base::{Setpoint, Stateful};
use servobench_motion::online::Target;

/// Part of the velocity limit below which a commanded velocity is rounding, not motion in a direction.
const CREEP: f64 = 1e-6;

/// Inputs of MC_Power.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Stateful)]
pub(crate) struct PowerRequest {
    pub(crate) enable: bool,
    pub(crate) positive: bool,
    pub(crate) negative: bool,
}

impl Default for PowerRequest {
    fn default() -> Self {
        Self { enable: false, positive: true, negative: true }
    }
}

/// Progress of a reset.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Stateful)]
pub(super) enum Reset {
    /// Not requested.
    #[default]
    Idle,
    /// The signal is up.
    Asked,
    /// Requested again: down for a cycle, so that there is an edge.
    Again,
}

impl Reset {
    pub(super) fn signal(&mut self) -> bool {
        match self {
            Self::Idle => false,
            Self::Asked => true,
            Self::Again => {
                *self = Self::Asked;
                false
            }
        }
    }
}

impl Axis {
    /// Follows the arrow of `cause`, if there is one.
    pub(super) fn follow(&mut self, cause: Cause) {
        if let Some(arrow) = arrow(self.state, cause) {
            self.state = arrow.to;
        }
    }

    /// Supervises the power and the faults of the axis.
    pub(super) fn supervise(&mut self) {
        if let Some(fault) = self.feedback.fault
            && self.state != AxisState::ErrorStop
        {
            return self.fail(AxisError::DriveFault { fault });
        }
        let is_powered = self.is_powered();
        match self.state {
            AxisState::Disabled => self.try_enable(is_powered),
            AxisState::ErrorStop => {
                if !is_powered {
                    self.activity = Activity::Rest;
                }
                self.try_reset(is_powered);
            }
            state if !is_powered => self.fail(AxisError::PowerLost { state }),
            _ => {}
        }
    }

    /// Leaves Disabled once the requested power is there.
    fn try_enable(&mut self, is_powered: bool) {
        if self.power.enable && is_powered {
            self.base = Setpoint::at_rest(self.feedback.demanded());
            self.follow(Cause::Powered);
        }
    }

    /// Leaves ErrorStop once a reset was requested, the fault is gone and the axis at rest.
    fn try_reset(&mut self, is_powered: bool) {
        let is_clear = self.feedback.fault.is_none() && matches!(self.activity, Activity::Rest);
        if self.reset == Reset::Idle || !is_clear {
            return;
        }
        match (is_powered, self.power.enable) {
            (true, true) => self.follow(Cause::ResetPowered),
            (false, _) => self.follow(Cause::ResetUnpowered),
            (true, false) => return,
        }
        (self.reset, self.error) = (Reset::Idle, None);
    }

    /// Fails with an error of the axis: it comes to rest if the power allows it, and takes no command until MC_Reset.
    pub(super) fn fail(&mut self, error: AxisError) {
        let start = self.present();
        let was_homing = matches!(self.activity, Activity::Homing(_) | Activity::Leaving(_));
        self.ledger.fail(BlockError::Axis { block: BlockName::Power, error });
        self.end_waiting(Progress::Failed);
        self.end_all(Progress::Failed);
        self.error = Some(error);
        self.follow(Cause::AxisError);
        self.base = start.from;
        if self.is_powered() {
            self.halt_from(start, was_homing);
        }
        self.add_up();
    }

    /// MC_Power.
    pub(crate) fn ask_power(&mut self, request: PowerRequest) {
        self.power = request;
        if !request.enable && arrow(self.state, Cause::Unpowered).is_some() {
            self.end_all(Progress::Aborted);
            self.follow(Cause::Unpowered);
            self.base = Setpoint::at_rest(self.feedback.demanded());
            self.add_up();
        }
        if self.state == AxisState::Disabled {
            self.try_enable(self.is_powered());
        }
    }

    /// Status of MC_Power.
    pub(crate) fn power_status(&self) -> bool {
        self.power.enable && self.is_powered()
    }

    /// MC_Reset.
    pub(crate) fn ask_reset(&mut self) -> Result<(), BlockError> {
        if arrow(self.state, Cause::ResetPowered).is_none() {
            return Err(BlockError::State { block: BlockName::Reset, state: self.state });
        }
        self.reset = if self.reset == Reset::Idle { Reset::Asked } else { Reset::Again };
        Ok(())
    }

    /// True while a reset is pending.
    pub(crate) fn is_resetting(&self) -> bool {
        self.reset != Reset::Idle
    }

    /// Direction of the set-point, 1 or −1, while it moves.
    pub(super) fn direction(&self) -> Option<f64> {
        let moves = self.setpoint.v.abs() > CREEP * self.params.limits.velocity;
        moves.then(|| 1.0_f64.copysign(self.setpoint.v))
    }

    /// Fails when the axis moves in a direction that MC_Power does not permit.
    pub(super) fn watch_permission(&mut self) {
        let is_at_rest = matches!(self.activity, Activity::Rest) && self.superimposed.is_none();
        if self.power.positive && self.power.negative || is_at_rest {
            return;
        }
        let velocity = self.setpoint.v;
        let Some(input) = self.direction().and_then(|direction| self.forbidden(direction)) else { return };
        if !matches!(self.state, AxisState::ErrorStop | AxisState::Stopping) {
            self.fail(AxisError::PermissionLost { velocity, input });
        }
    }

    /// Input of MC_Power that forbids a motion in the direction of `sign`.
    pub(super) fn forbidden(&self, sign: f64) -> Option<&'static str> {
        match sign {
            s if s > 0.0 && !self.power.positive => Some("EnablePositive"),
            s if s < 0.0 && !self.power.negative => Some("EnableNegative"),
            _ => None,
        }
    }

    /// Ends the active command and the superimposed one with `progress` and all others as aborted.
    pub(super) fn end_all(&mut self, progress: Progress) {
        if let Some(id) = self.activity.id() {
            self.ledger.set(id, progress);
        }
        if let Some(superimposed) = self.superimposed.take() {
            self.ledger.set(superimposed.id, progress);
        }
        self.end_waiting(Progress::Aborted);
        self.activity = Activity::Rest;
        self.shift = 0.0;
        self.stop_holder = None;
    }

    /// Removes the waiting commands with `progress`.
    pub(super) fn end_waiting(&mut self, progress: Progress) {
        while let Some((id, _)) = self.queue.pop() {
            self.ledger.set(id, progress);
        }
    }

    /// Brings the axis to rest without a request from a block.
    pub(super) fn halt(&mut self) {
        let start = self.present();
        self.end_all(Progress::Aborted);
        self.base = start.from;
        self.follow(Cause::Block(BlockName::Halt));
        self.halt_from(start, false);
        self.add_up();
    }

    /// Begins the axis's own stop, once the drive has ended its reference run; immediate if it cannot be planned.
    fn halt_from(&mut self, Start { from, lead }: Start, was_homing: bool) {
        let (limits, target) = (&self.params.limits, Target::Velocity(0.0));
        let dynamics = Dynamics::braking(limits.acceleration, None, None);
        let command = Command { block: BlockName::Halt, goal: Goal::Rest, dynamics, buffer_mode: BufferMode::Aborting };
        let id = CommandId::OWN;
        if was_homing {
            self.activity = Activity::Leaving(Leaving { id, command });
            return;
        }
        let bounds = Bounds::of_axis(limits);
        self.activity = bounds.plan(&from, &target).map_or(Activity::Rest, |way| {
            let mut run = Run::new(way, lead, None, &bounds);
            self.base = run.now();
            Activity::Moving(Moving { id, command, target, origin: from.x, is_paused: false, run })
        });
    }
}
