//! The axis that the blocks of a program act on.
//!
//! The commanded trajectory is a function of time that begins at the set-point of the cycle in which a command is given: a block
//! called in cycle k changes the motion between cycles k and k + 1. Done is the cycle whose set-point is the target.
//!
//! Motion is counted in the unit of the drive; MC_SetPosition shifts the position that the program sees.
mod activity;
mod blending;
mod block_setpoints;
mod bounds;
mod brake_pre_trajectory;
mod commands;
mod inputs_outputs;
mod modulo;
mod obstacle;
mod parameters;
mod queue;
mod request;
mod run;
mod shared_limits;
mod superimposed;
mod supervision;
mod velocity_commands;

use crate::blocks::BlockName;
use crate::command::Reference;
use crate::error::AxisError;
use crate::ledger::{CommandId, Ledger, Progress};
use crate::params::AxisParams;
use crate::state::AxisState;
use activity::{Activity, HomingWait};
use obstacle::HomingSteps;
use parameters::Supervision;
use queue::Queue;
use servobench_base::{ParamError, Request, Setpoint, Stateful};
use servobench_fieldbus::{AxisCommand, AxisFeedback, Power, Task, TouchProbe};
use servobench_motion::Limits;
use servobench_motion::interpolate::Sample;
use superimposed::Superimposed;
use supervision::Reset;
use velocity_commands::VelocityCommands;

pub(crate) use bounds::Override;
pub(crate) use inputs_outputs::Probed;
pub use queue::MOST_BUFFERED;
pub(crate) use supervision::PowerRequest;

/// An axis with its parameters, its state and its commands.
#[derive(Debug, Clone, PartialEq, Stateful)]
pub struct Axis {
    /// Limits as the program has set them.
    params: AxisParams,
    /// Limits with which the axis was built.
    system_limits: Limits,
    supervision: Supervision,
    state: AxisState,
    feedback: AxisFeedback,
    /// Position seen by the program minus that of the drive.
    offset: f64,
    is_homed: bool,
    homing_steps: HomingSteps,
    power: PowerRequest,
    reset: Reset,
    /// The MC_Stop that holds the axis as long as its Execute is TRUE.
    stop_holder: Option<CommandId>,
    activity: Activity,
    /// Set-point of the activity.
    base: Setpoint,
    superimposed: Option<Superimposed>,
    /// Distance that finished superimposed motions have added to the activity.
    shift: f64,
    /// Sum of base and superimposed set-point in this cycle; before the cycle has begun, that of the one before.
    setpoint: Setpoint,
    /// True while the cycle begins.
    is_beginning: bool,
    /// Direction of the last motion, 1 or −1.
    last_direction: f64,
    factors: Override,
    velocity_commands: VelocityCommands,
    queue: Queue,
    ledger: Ledger,
    error: Option<AxisError>,
    /// Request of the program in this cycle; until it has ended, that of the one before.
    request: Request,
    /// Bits of the drive's digital outputs.
    digital_outputs: u32,
    /// Current request to the drive's touch probe, and the number of requests so far.
    probe: Option<TouchProbe>,
    probes: u32,
}

impl Axis {
    /// A disabled axis.
    ///
    /// # Errors
    /// [`ParamError`] names the first parameter outside its bound.
    pub fn new(params: AxisParams) -> Result<Self, ParamError> {
        params.check()?;
        Ok(Self {
            system_limits: params.limits,
            params,
            supervision: Supervision::NONE,
            state: AxisState::Disabled,
            feedback: AxisFeedback::default(),
            offset: 0.0,
            is_homed: false,
            homing_steps: HomingSteps::default(),
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
            velocity_commands: VelocityCommands::default(),
            queue: Queue::EMPTY,
            ledger: Ledger::new(),
            error: None,
            request: Request::Nothing,
            digital_outputs: 0,
            probe: None,
            probes: 0,
        })
    }

    /// Begins a cycle with the axis's feedback; the blocks are called after it.
    pub fn begin(&mut self, feedback: &AxisFeedback) {
        self.feedback = *feedback;
        self.supervise();
        self.is_beginning = true;
        self.advance();
        self.advance_superimposed();
        self.is_beginning = false;
        self.add_up();
        self.watch_permission();
        self.watch_software_limits();
        self.watch_lag();
    }

    /// Ends a cycle: returns the command to the axis until the next one.
    pub fn end(&mut self) -> AxisCommand {
        self.watch_leading();
        let task = match &self.activity {
            Activity::Homing(HomingWait { reference: Reference::Search(position), .. }) => {
                Task::Home { position: *position }
            }
            Activity::Effort(effort) => Task::Effort(effort.present),
            Activity::Rest
            | Activity::Moving(_)
            | Activity::Homing(_)
            | Activity::Search(_)
            | Activity::Leaving(_)
            | Activity::Led(_) => {
                if let Some(start) = self.params.velocity_ramps {
                    Task::Drive(self.velocity_command(start))
                } else {
                    let Setpoint { x, v, a, .. } = self.setpoint;
                    Task::Follow(Sample { x, v, a, torque: 0.0 })
                }
            }
        };
        self.end_velocity_command();
        self.request = self.requested();
        AxisCommand {
            power: self.power.enable,
            reset: self.reset.signal(),
            task,
            digital_outputs: self.digital_outputs,
            touch_probe: self.probe,
            effort_limit: self.effort_limit(),
        }
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

    /// Set-point of this cycle as the program sees it; the position of a modulo axis is not wrapped.
    #[must_use]
    pub fn commanded(&self) -> Setpoint {
        Setpoint { x: self.setpoint.x + self.offset, ..self.setpoint }
    }

    /// Set-point of this cycle in the coordinate of the drive, as sent.
    #[must_use]
    pub const fn sent(&self) -> Setpoint {
        self.setpoint
    }

    /// Feedback of the axis, with the position as the program sees it.
    #[must_use]
    pub fn actual(&self) -> AxisFeedback {
        AxisFeedback { position: self.actual_position(self.feedback.position), ..self.feedback }
    }

    /// A position of the drive as the program sees it.
    fn actual_position(&self, position: f64) -> f64 {
        let position = position + self.offset;
        self.params.modulo.map_or(position, |period| modulo::within(position, period))
    }

    /// Position seen by the program minus that of the drive.
    pub(crate) const fn offset(&self) -> f64 {
        self.offset
    }

    /// True if the position counts from a reference.
    #[must_use]
    pub const fn is_homed(&self) -> bool {
        self.is_homed
    }

    /// The error for which the axis is in ErrorStop.
    #[must_use]
    pub const fn error(&self) -> Option<&AxisError> {
        self.error.as_ref()
    }

    /// Block whose command the axis follows, without one superimposed on it; `None` while the axis rests, and MC_Halt while it brakes by
    /// itself.
    #[must_use]
    pub fn commanded_by(&self) -> Option<BlockName> {
        self.activity.command().map(|(_, command)| command.block)
    }

    /// True if the drive follows set-points of the axis, rather than an effort or its own search.
    #[must_use]
    pub(crate) const fn follows_set_points(&self) -> bool {
        !matches!(
            self.activity,
            Activity::Effort(_)
                | Activity::Homing(HomingWait { reference: Reference::Search(_), .. })
                | Activity::Leaving(_)
        )
    }

    /// Progress of a command.
    #[must_use]
    pub fn progress(&self, id: CommandId) -> Progress {
        self.ledger.progress(id)
    }

    pub(crate) const fn ledger(&self) -> &Ledger {
        &self.ledger
    }

    /// True if the drive follows.
    fn is_powered(&self) -> bool {
        self.feedback.power == Power::On
    }

    /// Adds up the set-point of this cycle.
    fn add_up(&mut self) {
        self.setpoint = match &self.superimposed {
            None if self.shift == 0.0 => self.base,
            None => Setpoint { x: self.base.x + self.shift, ..self.base },
            Some(superimposed) => superimposed.on(&self.base, self.shift),
        };
        self.last_direction = self.direction().unwrap_or(self.last_direction);
    }
}
