//! The link: once per bus cycle it converts the last answer of the drive to the next frame for it, while the motion task leaves a command
//! once per its own, slower cycle.
//!
//! Order of a step: receive the drive, open the mailbox, detect faults, advance the power sequence, output the set-point of the task.
//!
//! # From samples to set-points
//!
//! Sample k is due at `tick(k) = tick(0) + k·cycle`. The interval between two samples is read `margin` after the due time of the last
//! sample that its mode needs, whenever the samples came: the output at t is the motion of the samples at `t − delay`, with the constant
//! [`Params::delay`] = (points/2 − ahead)·cycle + margin. Following errors are to be measured against that. [`Settings::run_ahead`]
//! predicts samples from the start to make it shorter.
//!
//! A late sample is predicted, for two cycles at most; [`Interpolation`] reports the state and [`Interpolation::meaning`] explains it.
//!
//! When the motion that is read changes under the output – at the start, by a correction, after a stop – the output continues from its
//! present state, and the difference is led to zero within [`Settings::recovery`], in addition to the motion. It never moves faster than
//! [`Settings::velocity_limit`]; [`State::is_limited`] reports if that limits it.
//!
//! # The position loop in the master
//!
//! With [`Control::Velocity`] (csv) the link closes the position loop. The position received at t is older by the round trip of the bus and
//! the [age of the answer](Settings::answer_age), together D, and is compared with the set-point output at t − D. That compensates the
//! delay at every velocity, and leaves the stability of the loop unchanged: it begins to oscillate at the gain `2/T·tan(π·T/(4D))`, a
//! little more than π/(2·D). With the velocity of the set-point fed forward and K·D ≤ 1/e, the error is at most (a·τ + j·T²/12)/K for an
//! axis whose velocity lags by τ, plus the units of the bus.
//!
//! # Faults
//!
//! The link answers a fault of the drive with Disable voltage until it is reset, and a [`LinkFault`] by its
//! [`response`](LinkFault::response): limit switches by halt, the others by quick stop. A drive that left Operation enabled does not come
//! back by itself.
//!
//! Each holds until the rising edge of `reset`, and as long as its cause. After a limit switch the axis may only move out of it. Without
//! power, during each fault, and while the drive is in another mode, the output is the axis' own motion, so that nothing jumps when the
//! drive follows again: the position that the drive follows (6062h), or the actual one without a position loop, extrapolated by D to the
//! time when it will be reached; its velocity; the actual effort. The frame holds the values that its mode carries: the velocity as target
//! (csv) or offset (csp), the effort as target (cst). The effort is sent as an offset only if it was demanded as such: the drive's loops
//! reproduce their own share themselves. An axis that moves when the drive begins to follow is brought to rest, and then to the motion that
//! is read, within [`Settings::recovery`].
mod actuals;
mod buffer;
mod course;
mod drive_profile;
mod effort;
mod frame;
mod homing;
mod mailbox;
mod params;
mod position;
mod position_loop;
mod sequencer;
mod stream;
mod supervision;
mod touch_probe;
mod units;

pub use mailbox::Mailbox;
pub use params::{Control, Params, Settings};
pub use position_loop::{Derivative, Law, PositionGains, PositionLoop};
pub use sequencer::Sequencing;
pub use units::Units;

use crate::{AxisCommand, AxisFeedback, Fault, Interpolation, LinkFault, Power, Switches, Task};
use drive_profile::DriveProfile;
use effort::{Limit, Ramp};
use homing::Procedure;
use position::Position;
use sequencer::{Sequencer, Wanted};
use servobench_base::{Setpoint, Stateful, Tick};
use servobench_cia402::{Actuals, Commands, ControlBit, Mode, StatusBit};
use servobench_motion::interpolate::{Command, Sample};
use stream::Stream;
use touch_probe::Probe;

/// Input of a link at a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Input<'a> {
    /// Present tick.
    pub tick: Tick,
    /// Mailbox with the command of the motion task.
    pub mailbox: &'a Mailbox,
    /// Answer of the drive since the last step; `None` if none came.
    pub actuals: Option<Actuals>,
    /// The external fault signal.
    pub external_fault: bool,
}

/// State of a link from cycle to cycle.
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub struct State {
    command: AxisCommand,
    /// Number of the last command read.
    read: u64,
    actuals: Actuals,
    has_begun: bool,
    /// Time at which the drive was last received, or of the first step (base ticks).
    received_at: u64,
    position: Option<Position>,
    position_loop: PositionLoop,
    sequencer: Sequencer,
    /// True if the drive was enabled, and to stay so, at the last step.
    was_on: bool,
    fault: Option<LinkFault>,
    stream: Stream,
    ramp: Ramp,
    effort_limit: Limit,
    homing: Procedure,
    drive_profile: DriveProfile,
    probe: Probe,
    /// Own effort of the axis, as far as it is demanded as such.
    own_effort: f64,
    commands: Commands,
    /// Time at which the present mode was first requested (base ticks).
    mode_since: u64,
    /// Time at which the drive was last seen in that mode or without power (base ticks).
    in_mode_or_off: u64,
    limited: bool,
    /// Rounding remainder of the last torque sent, in thousandths of the rated one.
    torque_rest: f64,
}

impl Default for State {
    fn default() -> Self {
        Self {
            command: AxisCommand { power: false, ..AxisCommand::of(Task::Follow(Sample::default())) },
            read: 0,
            actuals: Actuals::default(),
            has_begun: false,
            received_at: 0,
            position: None,
            position_loop: PositionLoop::OPEN,
            sequencer: Sequencer::start(0),
            was_on: false,
            fault: None,
            stream: Stream::OFF,
            ramp: Ramp::off(0.0),
            effort_limit: Limit::default(),
            homing: Procedure::Idle,
            drive_profile: DriveProfile::default(),
            probe: Probe::default(),
            own_effort: 0.0,
            commands: Commands::default(),
            mode_since: 0,
            in_mode_or_off: 0,
            limited: false,
            torque_rest: 0.0,
        }
    }
}

/// Computes the next frame for the drive.
pub fn step(params: &Params, state: &mut State, input: Input<'_>) -> Commands {
    let now = input.tick.0;
    if !core::mem::replace(&mut state.has_begun, true) {
        state.received_at = now;
        state.sequencer = Sequencer::start(now);
    }
    state.receive(params, input.actuals, now);
    let post = state.open(params, input.mailbox, now);
    state.supervise(params, input.external_fault, now);
    let wanted = state.wanted();
    let timeout = params.settings.drive_timeout;
    if !state.sequencer.step(params.settings.sequencing, wanted, timeout, now) && wanted != Wanted::QuickStop {
        state.fault = state.fault.or(Some(LinkFault::DriveTimeout));
    }
    let wanted = state.wanted();
    state.was_on = wanted == Wanted::On && state.is_enabled(params);
    state.ask_for_the_mode(params, now);
    state.put_out(params, post, now);
    state.commands.digital_outputs = state.command.digital_outputs;
    // The drive reaches a target one or two cycles after it came; a position loop here compares an older output.
    let delay = params.delay() + params.reference_delay + 2 * params.stream.bus_cycle;
    let effort_limit = state.effort_limit.step(state.command.effort_limit, delay, now);
    state.commands.max_torque = effort_limit.map(|limit| params.scale.max_torque(limit));
    let received = (&state.actuals, state.position.as_ref());
    state.commands.touch_probe_function =
        state.probe.step(params, state.command.touch_probe, received, (state.received_at, now));
    state.commands.controlword = state
        .sequencer
        .word()
        .with(ControlBit::Halt, state.halts())
        .with(ControlBit::ModeSpecific4, state.asks_to_start());
    state.commands
}

impl State {
    /// Bit 4 of the controlword, which starts the drive's own procedures.
    const fn asks_to_start(&self) -> bool {
        match self.command.task {
            Task::Home { .. } => self.homing.is_started(),
            Task::Drive(_) => self.drive_profile.asks_to_start(),
            Task::Follow(_) | Task::Effort(_) => false,
        }
    }

    /// Own motion of the axis, extrapolated to the time when the present output is reached: the position that the drive follows or else the
    /// actual one, and its velocity, 0 below a count per cycle of the motion task.
    fn own_motion(&self, params: &Params) -> Setpoint {
        let Params { scale, stream, .. } = params;
        let tick = stream.timing.tick;
        let followed = self.position.as_ref().and_then(Position::followed_per_tick);
        let v = match followed {
            Some(counts_per_tick) => scale.velocity_of(counts_per_tick / tick),
            None => self.velocity(params),
        };
        let v = if v.abs() > stream.creep { v } else { 0.0 };
        let x = self.position(params) + scale.position(self.following_error(params));
        Setpoint { v, ..Setpoint::at_rest(x + v * (params.reference_delay as f64 * tick)) }
    }

    /// Actual effort if it was demanded as such, held until the next demand is followed. The drive's loops reproduce their own effort
    /// themselves: if it were sent as an offset, it would count twice.
    fn own_effort(&self, params: &Params, follows: bool) -> f64 {
        match Mode::from_code(self.actuals.mode) {
            Some(Mode::CyclicSynchronousTorque | Mode::ProfileTorque) => params.scale.effort(self.actuals.torque),
            Some(Mode::CyclicSynchronousPosition | Mode::CyclicSynchronousVelocity)
                if self.was_on && self.fault().is_none() && !follows =>
            {
                self.own_effort
            }
            _ => 0.0,
        }
    }

    /// Actual velocity.
    fn velocity(&self, params: &Params) -> f64 {
        let Params { scale, settings, .. } = params;
        match &self.position {
            Some(position) if settings.velocity_from_differences => {
                scale.velocity_of(position.counts_per_tick() / params.stream.timing.tick)
            }
            _ => scale.velocity(self.actuals.velocity),
        }
    }

    /// Feedback for the motion task.
    #[must_use]
    pub fn feedback(&self, params: &Params) -> AxisFeedback {
        let scale = &params.scale;
        AxisFeedback {
            position: self.position(params),
            following_error: scale.position(self.following_error(params)),
            velocity: self.velocity(params),
            effort: scale.effort(self.actuals.torque),
            power: self.power(params),
            has_warning: self.actuals.statusword.has(StatusBit::Warning),
            fault: self.fault(),
            interpolation: self.interpolation(),
            homing: self.homing.feedback(matches!(self.command.task, Task::Home { .. })),
            profile: self.drive_profile.feedback(&self.actuals),
            switches: self.switches(params),
            digital_inputs: self.actuals.digital_inputs,
            touch_probe: self.probe.feedback(params),
        }
    }

    /// Set-point at `tick`, from the last step to the next: the continuous motion behind one position per cycle. Not limited to whole
    /// counts.
    #[must_use]
    pub fn setpoint(&self, params: &Params, tick: Tick) -> Setpoint {
        self.stream.at(&params.stream, tick.0).setpoint
    }

    /// Output of the last step, in units of the axis: position, velocity and acceleration, with the effort as an offset, 0 if none is sent,
    /// or in their place; the axis' own motion if it follows nothing. The frame holds the values that the mode carries, rounded to the
    /// drive's units.
    #[must_use]
    pub fn output(&self, params: &Params) -> Command {
        let torque = match (self.ramp.state(), self.stream.state()) {
            (Interpolation::Off, Interpolation::Off) => params.scale.effort(self.actuals.torque),
            (Interpolation::Off, _) if params.sends_torque() => self.stream.output().torque,
            (Interpolation::Off, _) => 0.0,
            _ => self.ramp.at(&params.stream.timing, self.stream.put_out_at()),
        };
        Command { torque, ..*self.stream.output() }
    }

    /// Arrival of the motion task's set-points.
    #[must_use]
    pub const fn interpolation(&self) -> Interpolation {
        match self.command.task {
            Task::Effort(_) => self.ramp.state(),
            Task::Follow(_) | Task::Home { .. } | Task::Drive(_) => self.stream.state(),
        }
    }

    /// Present fault, the drive's before the link's.
    #[must_use]
    pub fn fault(&self) -> Option<Fault> {
        if self.sequencer.is_faulty() {
            return Some(Fault::Drive(self.actuals.error_code));
        }
        self.fault.map(Fault::Link)
    }

    /// True if the velocity limit held back the last command.
    #[must_use]
    pub const fn is_limited(&self) -> bool {
        self.limited
    }

    fn power(&self, params: &Params) -> Power {
        let sequencing = params.settings.sequencing;
        if self.was_on {
            Power::On
        } else if self.sequencer.is_powered(sequencing) || (self.command.power && self.fault().is_none()) {
            Power::Switching
        } else {
            Power::Off
        }
    }

    /// True if the drive function is enabled, as far as the drive has received its commands.
    fn is_enabled(&self, params: &Params) -> bool {
        self.sequencer.is_enabled(params.settings.sequencing, self.received_at.saturating_sub(params.round_trip))
    }

    fn switches(&self, params: &Params) -> Switches {
        let closed = |bit: u32| (self.actuals.digital_inputs >> bit & 1 == 1) != params.settings.reverse_switches;
        let (negative, positive) = if params.scale.is_reversed() { (1, 0) } else { (0, 1) };
        Switches { negative_limit: closed(negative), positive_limit: closed(positive), home: closed(2) }
    }

    /// Lead of the position that the drive's loops follow over the actual one (counts).
    fn following_error(&self, params: &Params) -> i128 {
        self.position.as_ref().map_or(0, |_| params.scale.ahead(&self.actuals))
    }

    fn position(&self, params: &Params) -> f64 {
        self.position.as_ref().map_or(0.0, |position| params.scale.position(position.counts()))
    }
}
