//! The link itself: once per bus cycle from the last answer of the drive to the next frame for it.
//!
//! In the order of a step: hear the drive, open the mailbox, look for faults, tell the drive what is wanted, put out what the
//! task asks for.
//!
//! | what happens | what the drive is told | what the motion task hears |
//! |---|---|---|
//! | fault of the drive | Disable voltage, until reset | `Fault::Drive` with 603Fh |
//! | external fault, drive time-out, command or position lost | quick stop | its `LinkFault` |
//! | motion into a limit switch | halt (bit 8); powered on | `NegativeLimit`, `PositiveLimit` |
//! | drive leaves Operation enabled | quick stop: it does not come back by itself | `DriveLeftOperation` |
//!
//! Each holds until the rising edge of `reset`, and as long as its cause. After a limit switch the axis may move out of it only.
//! Without power, and in each of these, what is put out is the actual position, so that nothing jumps when the drive follows
//! again.
mod buffer;
mod course;
mod effort;
mod homing;
mod mailbox;
mod params;
mod position;
mod sequencer;
mod stream;
mod units;

pub use mailbox::Mailbox;
pub use params::{Control, Params, Settings};
pub use sequencer::Sequencing;
pub use units::Units;

use crate::{AxisCommand, AxisFeedback, Fault, Interpolation, LinkFault, Power, Switches, Task};
use effort::Ramp;
use homing::Procedure;
use mailbox::Letter;
use position::Position;
use sequencer::{Sequencer, Wanted};
use servobench_base::{Setpoint, Tick};
use servobench_cia402::{Actuals, Commands, ControlBit, Mode};
use servobench_motion::interpolate::{self, Sample};
use stream::{Arrival, Post, Stream};

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

/// All that a snapshot of a link must hold.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct State {
    command: AxisCommand,
    /// Number of the last command that was read.
    read: u64,
    actuals: Actuals,
    /// When the drive was heard last (base ticks).
    heard: u64,
    position: Option<Position>,
    sequencer: Sequencer,
    /// Whether the drive was enabled and to stay so at the last step.
    was_on: bool,
    fault: Option<LinkFault>,
    stream: Stream,
    ramp: Ramp,
    homing: Procedure,
    commands: Commands,
    /// Since when the mode that is asked for has been (base ticks).
    mode_since: u64,
    limited: bool,
}

impl Default for State {
    fn default() -> Self {
        Self {
            command: AxisCommand { power: false, reset: false, task: Task::Follow(Sample::default()) },
            read: 0,
            actuals: Actuals::default(),
            heard: 0,
            position: None,
            sequencer: Sequencer::START,
            was_on: false,
            fault: None,
            stream: Stream::OFF,
            ramp: Ramp::OFF,
            homing: Procedure::Idle,
            commands: Commands::default(),
            mode_since: 0,
            limited: false,
        }
    }
}

/// Tells the drive what comes next.
pub fn step(params: &Params, state: &mut State, input: Input<'_>) -> Commands {
    let now = input.tick.0;
    state.hear(params, input.actuals, now);
    let post = state.open(params, input.mailbox);
    state.supervise(params, input.external_fault, now);
    let wanted = state.wanted();
    let timeout = params.settings.drive_timeout;
    if !state.sequencer.step(params.settings.sequencing, wanted, timeout, now) && wanted != Wanted::QuickStop {
        state.fault = state.fault.or(Some(LinkFault::DriveTimeout));
    }
    let wanted = state.wanted();
    state.was_on = wanted == Wanted::On && state.sequencer.is_enabled(params.settings.sequencing);
    state.ask_for_the_mode(params, now);
    state.put_out(params, post, now);
    state.commands.controlword = state
        .sequencer
        .word()
        .with(ControlBit::Halt, state.halts())
        .with(ControlBit::ModeSpecific4, matches!(state.command.task, Task::Home { .. }) && state.homing.is_started());
    state.commands
}

impl State {
    /// What the motion task hears.
    #[must_use]
    pub fn feedback(&self, params: &Params) -> AxisFeedback {
        let Params { scale, settings, .. } = params;
        let velocity = match &self.position {
            Some(position) if settings.velocity_from_differences => {
                scale.velocity_of(position.counts_per_tick() / params.stream.timing.tick)
            }
            _ => scale.velocity(self.actuals.velocity),
        };
        AxisFeedback {
            position: self.position(params),
            velocity,
            effort: scale.effort(self.actuals.torque),
            power: self.power(params),
            fault: self.fault(),
            interpolation: self.interpolation(),
            homing: self.homing.feedback(matches!(self.command.task, Task::Home { .. })),
            switches: self.switches(params),
        }
    }

    /// The set-point that is put out at `tick`, from the last step to the next: what the drive would follow if it knew more than
    /// a position per cycle. Not limited to whole counts.
    #[must_use]
    pub fn setpoint(&self, params: &Params, tick: Tick) -> Setpoint {
        self.stream.at(&params.stream, tick.0).setpoint
    }

    /// How the set-points of the motion task arrive.
    #[must_use]
    pub const fn interpolation(&self) -> Interpolation {
        match self.command.task {
            Task::Effort(_) => self.ramp.state(),
            Task::Follow(_) | Task::Home { .. } => self.stream.state(),
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
        if self.follows(params) {
            Power::On
        } else if self.sequencer.is_powered(sequencing) || (self.command.power && self.fault().is_none()) {
            Power::Switching
        } else {
            Power::Off
        }
    }

    fn switches(&self, params: &Params) -> Switches {
        let closed = |bit: u32| (self.actuals.digital_inputs >> bit & 1 == 1) != params.settings.reverse_switches;
        Switches { negative_limit: closed(0), positive_limit: closed(1), home: closed(2) }
    }

    fn position(&self, params: &Params) -> f64 {
        self.position.as_ref().map_or(0.0, |position| params.scale.position(position.counts()))
    }

    fn hear(&mut self, p: &Params, actuals: Option<Actuals>, now: u64) {
        let Some(actuals) = actuals else { return };
        (self.actuals, self.heard) = (actuals, now);
        self.sequencer.hear(actuals.statusword, now);
        let followed = match &mut self.position {
            Some(position) => position.follow(&p.scale, actuals.position, now),
            none => Position::start(&p.scale, actuals.position, now).map(|position| *none = Some(position)),
        };
        if followed.is_err() {
            self.fault = self.fault.or(Some(LinkFault::PositionLost));
        }
    }

    /// Reads the command, and the sample in it where there is a new one.
    fn open(&mut self, p: &Params, mailbox: &Mailbox) -> Post {
        let Some(Letter { number, tick, command }) = mailbox.read() else { return Post::Torn };
        if number == self.read {
            return Post::Nothing;
        }
        let missed = number.wrapping_sub(self.read).saturating_sub(1);
        let missed = if self.read == 0 { 0 } else { missed };
        self.read = number;
        if command.reset && !self.command.reset {
            self.reset(p);
        }
        if core::mem::discriminant(&command.task) != core::mem::discriminant(&self.command.task) {
            self.homing = Procedure::Idle;
        }
        let (before, sample) = (self.command, command.task);
        self.command = command;
        match sample {
            Task::Follow(sample) if is_followable(p, &sample) => Post::Sample(Arrival { sample, due: tick, missed }),
            Task::Effort(effort) if p.scale.thousandths(effort).is_some() => {
                let sample = Sample { torque: effort, ..Sample::default() };
                Post::Sample(Arrival { sample, due: tick, missed })
            }
            Task::Home { .. } => Post::Nothing,
            Task::Follow(_) | Task::Effort(_) => {
                self.command.task = before.task;
                self.fault = self.fault.or(Some(LinkFault::Command));
                Post::Nothing
            }
        }
    }

    fn reset(&mut self, p: &Params) {
        self.sequencer.reset();
        if self.fault == Some(LinkFault::PositionLost) {
            self.position = Position::start(&p.scale, self.actuals.position, self.heard).ok();
        }
        self.fault = None;
    }

    /// Looks for what the axis must be stopped for.
    fn supervise(&mut self, p: &Params, external_fault: bool, now: u64) {
        let enabled = self.sequencer.is_enabled(p.settings.sequencing);
        let silent = self.command.power && now.saturating_sub(self.heard) > p.settings.drive_timeout;
        let found = if external_fault {
            Some(LinkFault::External)
        } else if silent {
            Some(LinkFault::DriveTimeout)
        } else if self.was_on && !enabled && !self.sequencer.is_faulty() {
            Some(LinkFault::DriveLeftOperation)
        } else {
            self.runs_into(p)
        };
        // A halt does not hide what needs a quick stop.
        if self.fault.is_none() || (self.halts() && found.is_some_and(|fault| !is_halt(fault))) {
            self.fault = found;
        }
    }

    /// The limit switch that the axis is commanded into.
    fn runs_into(&self, p: &Params) -> Option<LinkFault> {
        let direction = match self.command.task {
            Task::Follow(_) if self.stream.state() != Interpolation::Off => self.stream.output().setpoint.v / p.creep,
            Task::Effort(effort) if self.ramp.state() != Interpolation::Off => effort / p.scale.effort(1).abs(),
            Task::Follow(_) | Task::Effort(_) | Task::Home { .. } => 0.0,
        };
        let switches = self.switches(p);
        if switches.negative_limit && direction < -1.0 {
            Some(LinkFault::NegativeLimit)
        } else if switches.positive_limit && direction > 1.0 {
            Some(LinkFault::PositiveLimit)
        } else {
            None
        }
    }

    const fn wanted(&self) -> Wanted {
        match self.fault {
            _ if !self.command.power => Wanted::Off,
            Some(fault) if !is_halt(fault) => Wanted::QuickStop,
            _ => Wanted::On,
        }
    }

    const fn halts(&self) -> bool {
        matches!(self.fault, Some(fault) if is_halt(fault))
    }

    /// Asks for the mode that the task needs, and for how long.
    fn ask_for_the_mode(&mut self, p: &Params, now: u64) {
        let mode = match (&self.command.task, &p.settings.control) {
            (Task::Follow(_), Control::Position { .. }) => Mode::CyclicSynchronousPosition,
            (Task::Follow(_), Control::Velocity { .. }) => Mode::CyclicSynchronousVelocity,
            (Task::Effort(_), _) => Mode::CyclicSynchronousTorque,
            (Task::Home { .. }, _) => Mode::Homing,
        };
        if self.commands.mode != mode.code() || !self.was_on {
            (self.commands.mode, self.mode_since) = (mode.code(), now);
        }
        let missing = self.was_on && !self.is_in_mode(p);
        if missing && now.saturating_sub(self.mode_since) > p.settings.drive_timeout {
            self.fault = self.fault.or(Some(LinkFault::DriveTimeout));
        }
    }

    /// Whether the drive shows the mode that it is asked for; the simplified sequence does not ask.
    fn is_in_mode(&self, p: &Params) -> bool {
        p.settings.sequencing == Sequencing::Simplified || self.actuals.mode == self.commands.mode
    }

    /// Whether the drive does what the task asks for.
    fn follows(&self, p: &Params) -> bool {
        self.was_on && self.fault.is_none() && self.is_in_mode(p)
    }

    fn put_out(&mut self, p: &Params, post: Post, now: u64) {
        let follows = self.follows(p);
        let actual = self.position(p);
        if !(follows && matches!(self.command.task, Task::Follow(_))) {
            self.stream.switch_off(actual, now);
        }
        if !(follows && matches!(self.command.task, Task::Effort(_))) {
            self.ramp = Ramp::OFF;
        }
        self.limited = false;
        match self.command.task {
            Task::Follow(_) if follows => self.follow(p, post, actual, now),
            Task::Effort(_) if follows => self.push(p, post, now),
            Task::Follow(_) | Task::Effort(_) => self.rest(p),
            Task::Home { position } => {
                self.rest(p);
                self.home(p, position, follows, now);
            }
        }
    }

    fn follow(&mut self, p: &Params, post: Post, actual: f64, now: u64) {
        if self.stream.step(&p.stream, post, now).is_err() {
            self.fault = self.fault.or(Some(LinkFault::Command));
        }
        self.limited = self.stream.is_limited();
        let interpolate::Command { setpoint, torque } = *self.stream.output();
        let offset = |wanted: bool, value: f64| if wanted { value } else { 0.0 };
        let target = p.scale.counts(setpoint.x).map(|counts| p.scale.target(counts));
        let mut sent = Sent { commands: &mut self.commands, complete: true };
        sent.set(target, |commands| &mut commands.target_position);
        match p.settings.control {
            Control::Position { velocity_offset, torque_offset } => {
                let (v, torque) = (offset(velocity_offset, setpoint.v), offset(torque_offset, torque));
                sent.set(p.scale.drive_velocity(v), |commands| &mut commands.velocity_offset);
                sent.set(p.scale.thousandths(torque), |commands| &mut commands.torque_offset);
            }
            Control::Velocity { gain, feedforward, limit, torque_offset } => {
                let v = gain * (setpoint.x - actual) + feedforward * setpoint.v;
                self.limited |= v.abs() > limit;
                sent.set(p.scale.drive_velocity(v.clamp(-limit, limit)), |commands| &mut commands.target_velocity);
                sent.set(p.scale.thousandths(offset(torque_offset, torque)), |commands| &mut commands.torque_offset);
            }
        }
        if !sent.complete {
            self.fault = self.fault.or(Some(LinkFault::Command));
        }
    }

    /// Asks for what the axis does anyway: for its position and for neither velocity nor effort.
    fn rest(&mut self, p: &Params) {
        let commands = &mut self.commands;
        if let Some(position) = &self.position {
            commands.target_position = p.scale.target(position.counts());
        }
        (commands.target_velocity, commands.target_torque) = (0, 0);
        (commands.velocity_offset, commands.torque_offset) = (0, 0);
    }

    fn push(&mut self, p: &Params, post: Post, now: u64) {
        let effort = match post {
            Post::Sample(arrival) => Some(arrival.sample.torque),
            Post::Nothing | Post::Torn => None,
        };
        let effort = self.ramp.step(&p.stream.timing, effort, now);
        self.rest(p);
        // Between efforts that fit.
        self.commands.target_torque = p.scale.thousandths(effort).unwrap_or(0);
    }

    fn home(&mut self, p: &Params, position: f64, follows: bool, now: u64) {
        let reference = p.scale.counts(position).and_then(|counts| i32::try_from(counts).ok());
        let Some(reference) = reference else {
            self.fault = self.fault.or(Some(LinkFault::Command));
            return;
        };
        self.commands.home_offset = reference;
        if !follows {
            return self.homing.fail();
        }
        let round_trip = u64::from(p.settings.round_trip) * p.stream.bus_cycle;
        // What was heard now answers what was told a round trip ago.
        if self.homing.step(self.actuals.statusword, self.heard.saturating_sub(round_trip), now) {
            match Position::near(&p.scale, reference.into(), self.actuals.position, self.heard) {
                Ok(position) => self.position = Some(position),
                Err(_) => self.fault = self.fault.or(Some(LinkFault::PositionLost)),
            }
        }
    }
}

/// A frame that is filled.
struct Sent<'a> {
    commands: &'a mut Commands,
    /// Whether the drive's units could express everything; what they could not is as it was.
    complete: bool,
}

impl Sent<'_> {
    fn set<T>(&mut self, value: Option<T>, object: impl FnOnce(&mut Commands) -> &mut T) {
        match value {
            Some(value) => *object(self.commands) = value,
            None => self.complete = false,
        }
    }
}

const fn is_halt(fault: LinkFault) -> bool {
    matches!(fault, LinkFault::NegativeLimit | LinkFault::PositiveLimit)
}

/// Whether a sample is one that the axis can be led along: its numbers fit the drive's units, and its velocity, and what its
/// acceleration makes of it within a cycle, are not beyond twice the velocity limit.
fn is_followable(p: &Params, sample: &Sample) -> bool {
    let Sample { x, v, a, torque } = *sample;
    let highest = 2.0 * p.settings.velocity_limit;
    let within = |v: f64| v.abs() <= highest;
    p.scale.counts(x).is_some() && within(v) && within(a * p.cycle) && p.scale.thousandths(torque).is_some()
}
