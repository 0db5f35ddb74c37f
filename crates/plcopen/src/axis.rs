//! The axis: what the blocks of a program act on.
//!
//! The commanded way is a function of time that begins at the set-point of the cycle in which a command is given: a block that
//! is called in cycle k changes what the axis does between cycles k and k + 1. Done is the cycle whose set-point is the target.
//!
//! Motion is counted in the unit of the drive; MC_SetPosition shifts what the program sees of it.
mod activity;
mod blending;
mod block_setpoints;
mod bounds;
mod brake_pre_trajectory;
mod commands;
mod modulo;
mod queue;
mod run;
mod shared_limits;
mod superimposed;
mod supervision;

use crate::blocks::BlockName;
use crate::error::AxisError;
use crate::ledger::{CommandId, Ledger, Progress};
use crate::params::AxisParams;
use crate::state::AxisState;
use activity::Activity;
use queue::Queue;
use servobench_base::{ParamError, Setpoint};
use servobench_fieldbus::{AxisCommand, AxisFeedback, Power, Task};
use servobench_motion::interpolate::Sample;
use superimposed::Superimposed;
use supervision::Reset;

pub(crate) use bounds::Override;
pub use queue::MOST_BUFFERED;
pub(crate) use supervision::PowerRequest;

/// An axis with its parameters, its state and its commands.
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    params: AxisParams,
    state: AxisState,
    feedback: AxisFeedback,
    /// Position that the program sees, less that of the drive.
    offset: f64,
    is_homed: bool,
    power: PowerRequest,
    reset: Reset,
    /// The MC_Stop that holds the axis as long as its Execute is TRUE.
    stop_holder: Option<CommandId>,
    activity: Activity,
    /// Set-point of the activity.
    base: Setpoint,
    superimposed: Option<Superimposed>,
    /// What ended superimposed motions have added to the activity.
    shift: f64,
    /// Set-point of this cycle, both together; until the cycle has begun that of the one before.
    setpoint: Setpoint,
    /// Whether the cycle is being begun.
    is_beginning: bool,
    /// Direction of the last motion, 1 or −1.
    last_direction: f64,
    factors: Override,
    queue: Queue,
    ledger: Ledger,
    error: Option<AxisError>,
}

impl Axis {
    /// An axis that is disabled.
    ///
    /// # Errors
    /// [`ParamError`] names the first parameter outside its bound.
    pub fn new(params: AxisParams) -> Result<Self, ParamError> {
        params.check()?;
        Ok(Self {
            params,
            state: AxisState::Disabled,
            feedback: AxisFeedback::default(),
            offset: 0.0,
            is_homed: false,
            power: PowerRequest::default(),
            reset: Reset::default(),
            stop_holder: None,
            activity: Activity::Rest,
            base: Setpoint::default(),
            superimposed: None,
            shift: 0.0,
            setpoint: Setpoint::default(),
            is_beginning: false,
            last_direction: 1.0,
            factors: Override::NONE,
            queue: Queue::EMPTY,
            ledger: Ledger::new(),
            error: None,
        })
    }

    /// Begins a cycle with what the axis says of itself; the blocks are called after it.
    pub fn begin(&mut self, feedback: &AxisFeedback) {
        self.feedback = *feedback;
        self.supervise();
        self.is_beginning = true;
        self.advance();
        self.advance_superimposed();
        self.is_beginning = false;
        self.add_up();
        self.watch_permission();
    }

    /// Ends a cycle: what the axis is to do until the next one.
    pub fn end(&mut self) -> AxisCommand {
        self.watch_leading();
        let task = match &self.activity {
            Activity::Homing(homing) => Task::Home { position: homing.position },
            Activity::Effort(effort) => Task::Effort(effort.present),
            Activity::Rest | Activity::Moving(_) | Activity::Leaving(_) | Activity::Led(_) => {
                let Setpoint { x, v, a, .. } = self.setpoint;
                Task::Follow(Sample { x, v, a, torque: 0.0 })
            }
        };
        AxisCommand { power: self.power.enable, reset: self.reset.signal(), task }
    }

    /// Parameters.
    #[must_use]
    pub const fn params(&self) -> &AxisParams {
        &self.params
    }

    /// State of the diagram.
    #[must_use]
    pub const fn state(&self) -> AxisState {
        self.state
    }

    /// The set-point of this cycle as the program sees it; the position of a modulo axis counted on.
    #[must_use]
    pub fn commanded(&self) -> Setpoint {
        Setpoint { x: self.setpoint.x + self.offset, ..self.setpoint }
    }

    /// What the axis says of itself, the position as the program sees it.
    #[must_use]
    pub fn actual(&self) -> AxisFeedback {
        let position = self.feedback.position + self.offset;
        let position = self.params.modulo.map_or(position, |period| modulo::within(position, period));
        AxisFeedback { position, ..self.feedback }
    }

    /// Whether MC_Home has found the reference.
    #[must_use]
    pub const fn is_homed(&self) -> bool {
        self.is_homed
    }

    /// The error for which the axis is in ErrorStop.
    #[must_use]
    pub const fn error(&self) -> Option<&AxisError> {
        self.error.as_ref()
    }

    /// The block whose command the axis follows, without one on top of it; `None` while it rests, and MC_Halt where it brakes by
    /// itself.
    #[must_use]
    pub fn commanded_by(&self) -> Option<BlockName> {
        self.activity.command().map(|(_, command)| command.block)
    }

    /// What became of a command.
    #[must_use]
    pub fn progress(&self, id: CommandId) -> Progress {
        self.ledger.progress(id)
    }

    pub(crate) const fn ledger(&self) -> &Ledger {
        &self.ledger
    }

    /// Whether the drive follows.
    fn is_powered(&self) -> bool {
        self.feedback.power == Power::On
    }

    /// The set-point of this cycle from its parts.
    fn add_up(&mut self) {
        self.setpoint = match &self.superimposed {
            None if self.shift == 0.0 => self.base,
            None => Setpoint { x: self.base.x + self.shift, ..self.base },
            Some(superimposed) => superimposed.on(&self.base, self.shift),
        };
        self.last_direction = self.direction().unwrap_or(self.last_direction);
    }
}
