//! The link: once per bus cycle from the last answer of the drive to the next frame for it, while the motion task leaves a
//! command once per its own, slower cycle.
//!
//! In the order of a step: receive the drive, open the mailbox, look for faults, tell the drive what is wanted, put out what the
//! task asks for.
//!
//! # From samples to set-points
//!
//! Sample k is due at `tick(k) = tick(0) + k·cycle`. The interval between two samples is read as soon as all samples that its
//! mode needs must be there, and `margin` later, whenever they came: what is put out at t is the motion of the samples at
//! `t − delay`, with the constant [`Params::delay`] = (points/2 − ahead)·cycle + margin. Following errors are to be measured against
//! that. [`Settings::run_ahead`] predicts samples from the start to make it shorter.
//!
//! A sample that is late is predicted, for two cycles at most; [`Interpolation`] says how that fares and
//! [`Interpolation::meaning`] what is done.
//!
//! Where what is read changes under the output – at the start, by a correction, after a stop – the output goes on from where
//! it is, and the difference is led to zero within [`Settings::recovery`], beside the motion. It never moves faster than
//! [`Settings::velocity_limit`]; where that binds, [`State::is_limited`] says so.
//!
//! # The position loop in the master
//!
//! With [`Control::Velocity`] (csv) the link closes the position loop. The position that it receives at t is on its way for as long as
//! the round trip of the bus and the [age of the answer](Settings::answer_age), together D, and is compared with the set-point
//! that was put out at t − D. That makes up for the way at any velocity, and leaves the loop as stable as it was:
//! it begins to oscillate at the gain `2/T·tan(π·T/(4D))`, a little more than π/(2·D). With the velocity of the set-point fed forward the error is, as long as
//! K·D ≤ 1/e, at most (a·τ + j·T²/12)/K of an axis whose velocity lags by τ, and the units of the bus.
//!
//! # What goes wrong
//!
//! A fault of the drive is answered with Disable voltage until it is reset, a [`LinkFault`] as its
//! [`response`](LinkFault::response) says: limit switches by halt, the others by quick stop. A drive that left Operation enabled
//! does not come back by itself.
//!
//! Each holds until the rising edge of `reset`, and as long as its cause. After a limit switch the axis may move out of it only.
//! Without power, in each of these, and while the drive is in another mode, what is put out is what the axis does by itself, so that
//! nothing jumps when the drive follows again: the position that the drive follows (6062h), without a position loop the actual one,
//! at the time when it will be reached, D later; its velocity; the actual effort. The frame holds what its mode carries: the velocity
//! as target (csv) or offset (csp), the effort as target (cst). As an offset the effort is sent only where it was demanded as such:
//! what the drive's loops make of a position they go on with themselves. An axis that moves when the drive begins to follow is
//! brought to rest, and then to what is read, within [`Settings::recovery`].
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

/// What a link sees at a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Input<'a> {
    /// Now.
    pub tick: Tick,
    /// Where the motion task leaves its command.
    pub mailbox: &'a Mailbox,
    /// What the drive has sent since the last step; `None` when nothing came.
    pub actuals: Option<Actuals>,
    /// The external fault signal.
    pub external_fault: bool,
}

/// State of a link from cycle to cycle.
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub struct State {
    command: AxisCommand,
    /// Number of the last command that was read.
    read: u64,
    actuals: Actuals,
    has_begun: bool,
    /// When the drive was received last, or the first step (base ticks).
    received_at: u64,
    position: Option<Position>,
    position_loop: PositionLoop,
    sequencer: Sequencer,
    /// Whether the drive was enabled and to stay so at the last step.
    was_on: bool,
    fault: Option<LinkFault>,
    stream: Stream,
    ramp: Ramp,
    effort_limit: Limit,
    homing: Procedure,
    drive_profile: DriveProfile,
    probe: Probe,
    /// The effort that the axis has by itself, as far as it is demanded as such.
    own_effort: f64,
    commands: Commands,
    /// Since when the mode that is asked for has been (base ticks).
    mode_since: u64,
    /// When the drive was last seen in that mode or without power (base ticks).
    in_mode_or_off: u64,
    limited: bool,
    /// What is left of the last torque that went out, in thousandths of the rated one.
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

/// Tells the drive what comes next.
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
    // The drive is at a target a cycle after it came, or two; a position loop here compares what was put out some time ago.
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
    /// Bit 4 of the controlword, which starts what the drive does by itself.
    const fn asks_to_start(&self) -> bool {
        match self.command.task {
            Task::Home { .. } => self.homing.is_started(),
            Task::Drive(_) => self.drive_profile.asks_to_start(),
            Task::Follow(_) | Task::Effort(_) => false,
        }
    }

    /// What the axis does by itself, for the time when what is put out now is reached: the position that the drive follows or else
    /// the actual one, and its velocity, 0 below a count per cycle of the motion task.
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

    /// The actual effort, where it is one that was demanded as such, and until what is demanded next is followed. What the loops of
    /// the drive make of a position or a velocity they go on with: sent beside it, it would count twice.
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

    /// What the motion task receives.
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

    /// The set-point that is put out at `tick`, from the last step to the next: what the drive would follow if it knew more than
    /// a position per cycle. Not limited to whole counts.
    #[must_use]
    pub fn setpoint(&self, params: &Params, tick: Tick) -> Setpoint {
        self.stream.at(&params.stream, tick.0).setpoint
    }

    /// What was put out at the last step, in units of the axis: position, velocity and acceleration, the effort beside them, 0 where none
    /// is sent, or instead of them; what the axis does where nothing is followed. The frame holds of it what the mode carries, rounded to the
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

    /// How the set-points of the motion task arrive.
    #[must_use]
    pub const fn interpolation(&self) -> Interpolation {
        match self.command.task {
            Task::Effort(_) => self.ramp.state(),
            Task::Follow(_) | Task::Home { .. } | Task::Drive(_) => self.stream.state(),
        }
    }

    /// What is wrong, the drive's fault before the link's.
    #[must_use]
    pub fn fault(&self) -> Option<Fault> {
        if self.sequencer.is_faulty() {
            return Some(Fault::Drive(self.actuals.error_code));
        }
        self.fault.map(Fault::Link)
    }

    /// Whether the last command was held back by the velocity limit.
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

    /// Whether the drive function is enabled, as far as the drive knows what it is told.
    fn is_enabled(&self, params: &Params) -> bool {
        self.sequencer.is_enabled(params.settings.sequencing, self.received_at.saturating_sub(params.round_trip))
    }

    fn switches(&self, params: &Params) -> Switches {
        let closed = |bit: u32| (self.actuals.digital_inputs >> bit & 1 == 1) != params.settings.reverse_switches;
        let (negative, positive) = if params.scale.is_reversed() { (1, 0) } else { (0, 1) };
        Switches { negative_limit: closed(negative), positive_limit: closed(positive), home: closed(2) }
    }

    /// By how much what the drive's loops follow is ahead of the actual position (counts).
    fn following_error(&self, params: &Params) -> i128 {
        self.position.as_ref().map_or(0, |_| params.scale.ahead(&self.actuals))
    }

    fn position(&self, params: &Params) -> f64 {
        self.position.as_ref().map_or(0.0, |position| params.scale.position(position.counts()))
    }
}
