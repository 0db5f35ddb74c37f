//! The drive as the fieldbus sees it (CiA 402): frames in, demands for the loops out, once per period of the position loop.
//!
//! Order of events in a [`step`]:
//!
//! 1. the frame that came is converted: drive units end here,
//! 2. faults are looked for: from outside, of the power, of the encoder, missing frames, following error (603Fh),
//! 3. the power state machine takes the transition that is due,
//! 4. the mode of operation, or the stop that is asked for, says what the loops are to do,
//! 5. limits cut it: ends of the axis, effort.
//!
//! So a frame, a fault or a switch acts at the step at which it is seen. What the master reads, [`State::actuals`], is of the
//! last step.
//!
//! # Positions
//!
//! The encoder gives increments, unwrapped, in its own direction. The axis counts from another zero once it is homed; modes see
//! that position (m or rad), the loops the encoder's. The bus has 32 bits of user-defined units that wrap: an absolute target of
//! a cyclic mode is the one of all that show the same value which is nearest to the axis, one of a profile lies in the same turn
//! of the counter as the axis.
//!
//! # Take-over
//!
//! When the drive function is enabled, the demand begins where the axis is, at its velocity. When a mode follows another or a
//! stop, it begins with what the loops follow. A mode that the drive does not have is not switched to: the display (6061h) says
//! what runs. While the axis is braked, the mode stays.
mod cycle;
mod fault;
mod guard;
mod objects;
mod params;
mod running;
mod units;
mod window;

pub use cycle::{Beat, Params as CycleParams, State as CycleState};
pub use fault::Fault;
pub use objects::ObjectsError;
pub use params::{Limits, Params, Profile};
pub use units::Units;
pub use window::{Dwell, Window};

use crate::Demand;
use crate::modes::interpolated::{Buffer, SegmentCommand};
use crate::modes::stop::Ramp;
use crate::modes::{Actual, Answer, Moment, Targets};
use running::Running;
use servobench_base::{ParamError, Setpoint};
use servobench_cia402::{
    self as cia402, Actuals, Command, Commands, Deceleration, DriveFunction, Mode, PowerInputs, PowerMemory,
    PowerState, StatusBit, Statusword, Transition,
};

/// What the drive sees at a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Inputs<'a> {
    /// The newest frame of the master, when one came since the last step.
    pub frame: Option<&'a Commands>,
    /// What is measured.
    pub measured: Measured,
    /// Fault from outside, while it is present: its code (603Fh).
    pub fault: Option<u16>,
    /// Whether the high-level power is applied.
    pub main_voltage: bool,
}

/// What the drive measures.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[expect(clippy::struct_excessive_bools, reason = "each is a signal of its own")]
pub struct Measured {
    /// Position of the encoder, unwrapped (increments).
    pub increments: i64,
    /// Velocity of the axis (m/s or rad/s) in the encoder's direction.
    pub velocity: f64,
    /// Effort of the motor (N·m or N).
    pub effort: f64,
    /// What the position loop saw at its last turn: its own reference, delays included, less the position (m or rad).
    pub following_error: f64,
    /// Whether the loops cut the effort at their last turn.
    pub effort_is_cut: bool,
    /// Switch of the negative end, inverted where it is wired so.
    pub negative_limit: bool,
    /// Switch of the positive end.
    pub positive_limit: bool,
    /// Home switch.
    pub home: bool,
    /// Increments at which the last index pulse came, when one came since the last step.
    pub index: Option<i64>,
}

/// What a step gives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Outputs {
    /// For the loops, in the encoder's coordinate.
    pub demand: Demand,
    /// Transition of the power state machine that was taken.
    pub transition: Option<&'static Transition>,
    /// Fault that sent the drive into its fault reaction at this step.
    pub fault: Option<Fault>,
}

/// All that a snapshot must hold.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct State {
    power: PowerMemory,
    /// The mode that the master asks for and the one that is active.
    wanted: Option<Mode>,
    mode: Option<Mode>,
    running: Option<Running>,
    stop: Option<(Deceleration, Ramp)>,
    guard: guard::State,
    cycle: cycle::State,
    buffer: Buffer,
    /// Whether the last point of the master could not be read.
    has_refused_point: bool,
    now: Moment,
    /// What the loops were asked at the last step, in the axis' coordinate.
    last: Demand,
    /// Whether the last frame asked for more than the limits.
    is_cut: bool,
    /// Where the axis has its zero (increments).
    origin: i64,
    /// What homing adds to every position from the next step on.
    shift: Option<f64>,
    fault: Option<Fault>,
    beyond_following_error: Dwell,
    at_standstill: Dwell,
    statusword: Statusword,
    increments: i64,
    following_error: f64,
}

impl State {
    /// After power-on, with the zero of the axis at that of the encoder.
    ///
    /// # Errors
    /// [`ParamError`] names the first setting of `p` that is out of its bound.
    pub fn new(p: &Params) -> Result<Self, ParamError> {
        p.check()?;
        Ok(Self {
            power: PowerMemory::default(),
            wanted: None,
            mode: None,
            running: None,
            stop: None,
            guard: guard::State::default(),
            cycle: cycle::State::default(),
            buffer: Buffer::default(),
            has_refused_point: false,
            now: Moment {
                targets: Targets::default(),
                actual: Actual::default(),
                demanded: Setpoint::default(),
                period: p.period,
            },
            last: Demand::Off,
            is_cut: false,
            origin: 0,
            shift: None,
            fault: None,
            beyond_following_error: Dwell::default(),
            at_standstill: Dwell::default(),
            statusword: Statusword::default(),
            increments: 0,
            following_error: 0.0,
        })
    }

    /// State of the power.
    #[must_use]
    pub const fn power(&self) -> PowerState {
        self.power.state()
    }

    /// Mode that is active; `None` before the first one.
    #[must_use]
    pub const fn mode(&self) -> Option<Mode> {
        self.mode
    }

    /// The fault that the drive is in, until it is reset.
    #[must_use]
    pub const fn fault(&self) -> Option<Fault> {
        self.fault
    }

    /// The frame for the master, as of the last step.
    #[must_use]
    pub fn actuals(&self, p: &Params) -> Actuals {
        let Actual { velocity, effort, negative_limit, positive_limit, home, .. } = self.now.actual;
        let follows_position = matches!(self.last, Demand::Position { .. });
        Actuals {
            statusword: self.statusword,
            mode: self.mode.map_or(0, Mode::code),
            #[expect(clippy::cast_possible_truncation, reason = "the counter of the bus wraps")]
            position: p.units.position(self.increments.wrapping_sub(self.origin)) as i32,
            velocity: p.units.velocity(velocity),
            torque: p.units.effort(effort),
            following_error: if follows_position { p.units.distance(self.following_error) } else { 0 },
            error_code: self.fault.map_or(0, Fault::code),
            digital_inputs: u32::from(negative_limit) | u32::from(positive_limit) << 1 | u32::from(home) << 2,
            buffer_free: u16::try_from(self.buffer.free()).unwrap_or(u16::MAX),
            buffer_status: self.buffer.status(),
        }
    }
}

/// One period of the position loop.
pub fn step(p: &Params, x: &mut State, u: &Inputs) -> Outputs {
    x.measure(p, &u.measured);
    if let Some(frame) = u.frame {
        x.take(p, frame);
    }
    x.now.targets.is_new = u.frame.is_some();
    let beat = cycle::step(&p.cycle, &mut x.cycle, u.frame.is_some());
    let found = x.find_fault(p, u, beat);
    let standstill = x.stands_still(p);
    let inputs = PowerInputs {
        initialised: true,
        fault: found.is_some(),
        standstill,
        remote: true,
        main_voltage: u.main_voltage,
        warning: x.cycle.missed() > 0 || x.has_refused_point,
        ..PowerInputs::default()
    };
    let power = cia402::step(&p.power, &mut x.power, x.now.targets.controlword, inputs);
    let fault = x.remember(found, power.transition);
    let mut answer = match power.drive {
        DriveFunction::Disabled => x.idle(),
        DriveFunction::Follow => x.follow(p, beat),
        DriveFunction::Brake(how) => x.brake(p, how, standstill),
    };
    if !u.main_voltage {
        // Without power nothing can be driven, whatever the state says.
        answer.demand = Demand::Off;
    }
    let is_limited = keep_within(p.limits.effort, &mut answer.demand)
        || x.is_cut
        || x.guard.is_active()
        || u.measured.effort_is_cut
        || x.running.as_ref().is_some_and(Running::is_limited);
    x.last = answer.demand;
    x.statusword = power
        .statusword
        .with(StatusBit::TargetReached, answer.target_reached)
        .with(StatusBit::InternalLimitActive, is_limited)
        .with(StatusBit::ModeSpecific12, answer.bit_12)
        .with(StatusBit::ModeSpecific13, answer.bit_13);
    move_by(p.units.metres_or_radians(x.origin), &mut answer.demand);
    if let Some(shift) = x.shift.take() {
        x.move_zero(p, shift);
    }
    Outputs { demand: answer.demand, transition: power.transition, fault }
}

impl State {
    /// Reads the sensors: where the axis is, and where the loops go on from.
    fn measure(&mut self, p: &Params, measured: &Measured) {
        (self.increments, self.following_error) = (measured.increments, measured.following_error);
        let position = |increments: i64| p.units.metres_or_radians(increments.wrapping_sub(self.origin));
        let actual = Actual {
            position: position(measured.increments),
            velocity: if measured.velocity.is_finite() { measured.velocity } else { 0.0 },
            effort: if measured.effort.is_finite() { measured.effort } else { 0.0 },
            negative_limit: measured.negative_limit,
            positive_limit: measured.positive_limit,
            home: measured.home,
            index: measured.index.map(position),
        };
        self.now.demanded = match self.last {
            Demand::Position { setpoint, .. } => setpoint.after(p.period),
            Demand::Velocity { setpoint, .. } => {
                Setpoint { v: setpoint.after(p.period).v, ..Setpoint::at_rest(actual.position) }
            }
            Demand::Effort(_) | Demand::Off => Setpoint { v: actual.velocity, ..Setpoint::at_rest(actual.position) },
        };
        self.now.actual = actual;
    }

    /// Adds to every position, as far as whole increments go.
    fn move_zero(&mut self, p: &Params, shift: f64) {
        let increments = p.units.increments(shift);
        self.origin -= increments;
        move_by(p.units.metres_or_radians(increments), &mut self.last);
    }

    /// Converts a frame.
    fn take(&mut self, p: &Params, frame: &Commands) {
        self.wanted = Mode::from_code(frame.mode);
        if let Some(bytes) = frame.trajectory_point {
            // What the buffer itself refuses is latched in its status (2012h).
            self.has_refused_point = match SegmentCommand::decode(bytes) {
                Ok(command) => command.apply(&mut self.buffer).is_err(),
                Err(_) => true,
            };
        }
        let here = p.units.position(self.increments.wrapping_sub(self.origin));
        #[expect(clippy::cast_possible_truncation, reason = "the counter of the bus wraps")]
        let shown = here as i32;
        let target = match self.wanted {
            Some(Mode::ProfilePosition) => here - i64::from(shown) + i64::from(frame.target_position),
            _ => here + i64::from(frame.target_position.wrapping_sub(shown)),
        };
        let position = p.units.from_position(target);
        let kept = p.limits.position.map_or(position, |[lowest, highest]| position.clamp(lowest, highest));
        let rate = |units: u32, set: f64| if units == 0 { set } else { p.units.from_rate(units) };
        let profile_velocity = rate(frame.profile_velocity, p.profile.velocity);
        self.is_cut = match self.wanted {
            Some(Mode::CyclicSynchronousPosition) => kept.to_bits() != position.to_bits(),
            Some(Mode::ProfilePosition) => profile_velocity > p.profile_limit(),
            _ => false,
        };
        self.now.targets = Targets {
            controlword: frame.controlword,
            position: if self.wanted == Some(Mode::ProfilePosition) { position } else { kept },
            distance: p.units.from_position(frame.target_position.into()),
            velocity: p.units.from_velocity(frame.target_velocity),
            effort: p.units.from_effort(frame.target_torque),
            velocity_offset: p.units.from_velocity(frame.velocity_offset),
            effort_offset: p.units.from_effort(frame.torque_offset),
            profile_velocity: profile_velocity.min(p.profile_limit()),
            profile_acceleration: rate(frame.profile_acceleration, p.profile.acceleration).min(p.limits.acceleration),
            profile_deceleration: rate(frame.profile_deceleration, p.profile.deceleration).min(p.limits.deceleration),
            home_offset: p.units.from_position(frame.home_offset.into()),
            is_new: true,
        };
    }

    /// The fault that is present, the gravest first.
    fn find_fault(&mut self, p: &Params, u: &Inputs, beat: Beat) -> Option<Fault> {
        let is_enabled = self.power.state().is_drive_function_enabled();
        let follows_position = matches!(self.last, Demand::Position { .. });
        let is_beyond = follows_position && !p.following_error.holds(u.measured.following_error);
        let has_lost_position = self.beyond_following_error.step(is_beyond, p.following_error.time, p.period);
        let lacks_frames = beat == Beat::Missed
            && self.cycle.missed() > p.cycle.bridged
            && self.running.as_ref().is_some_and(Running::needs_frames);
        if let Some(code) = u.fault {
            Some(Fault::External(code))
        } else if is_enabled && !u.main_voltage {
            Some(Fault::MainsMissing)
        } else if !(u.measured.velocity.is_finite() && u.measured.effort.is_finite()) {
            Some(Fault::Encoder)
        } else if lacks_frames {
            Some(Fault::FramesMissing)
        } else {
            has_lost_position.then_some(Fault::FollowingError)
        }
    }

    /// Keeps the first fault until it is reset; returns it at the step at which it acts.
    fn remember(&mut self, found: Option<Fault>, transition: Option<&Transition>) -> Option<Fault> {
        match transition?.to {
            PowerState::FaultReactionActive => {
                self.fault = found;
                found
            }
            PowerState::SwitchOnDisabled => {
                self.fault = None;
                None
            }
            _ => None,
        }
    }

    /// Whether the axis stands, and is asked to stand, for long enough.
    fn stands_still(&mut self, p: &Params) -> bool {
        let stands = p.standstill.holds(self.now.actual.velocity) && p.standstill.holds(self.now.demanded.v);
        self.at_standstill.step(stands, p.standstill.time, p.period)
    }

    fn idle(&mut self) -> Answer {
        self.switch_mode();
        (self.running, self.stop) = (None, None);
        self.guard = guard::State::default();
        Answer { demand: Demand::Off, target_reached: false, bit_12: false, bit_13: false }
    }

    fn switch_mode(&mut self) {
        if self.wanted.is_some() && self.wanted != self.mode {
            (self.mode, self.running) = (self.wanted, None);
        }
    }

    fn follow(&mut self, p: &Params, beat: Beat) -> Answer {
        self.switch_mode();
        let was_stopped = self.stop.take().is_some();
        if self.running.is_none() {
            self.running = self.mode.map(|mode| Running::begin(p, mode, &self.now));
            self.guard = guard::State::default();
        } else if was_stopped && let Some(running) = &mut self.running {
            running.resume(p, &self.now);
        }
        let Some(running) = &mut self.running else {
            // No mode yet: the axis is held where it is.
            return self.brake(p, Deceleration::SlowDownRamp, false);
        };
        let mut answer = running.step(p, &self.now, beat, &mut self.buffer, &mut self.shift);
        if !running.looks_for_ends() {
            self.guard.step(p, &self.now, &mut answer.demand);
        }
        answer.bit_13 |= running.tells_following_error() && !p.following_error.holds(self.following_error);
        answer
    }

    /// Brakes and holds. Only a halt leaves the mode what it was doing.
    fn brake(&mut self, p: &Params, how: Deceleration, standstill: bool) -> Answer {
        let is_halt = self.power.state() == PowerState::OperationEnabled
            && self.now.targets.controlword.gives(Command::EnableOperation);
        if !is_halt {
            self.running = None;
        }
        self.guard = guard::State::default();
        let deceleration = match how {
            Deceleration::SlowDownRamp => Some(self.now.targets.profile_deceleration),
            Deceleration::QuickStopRamp => Some(p.profile.quick_stop_deceleration),
            Deceleration::CurrentLimit | Deceleration::VoltageLimit => None,
        };
        let closes_position =
            deceleration.is_some() && !matches!(self.last, Demand::Velocity { .. } | Demand::Effort(_));
        if self.stop.is_none_or(|(as_before, _)| as_before != how) {
            self.stop = Some((how, Ramp::begin(&self.now.demanded, deceleration, closes_position)));
        }
        let demand = self.stop.as_mut().map_or(Demand::Off, |(_, ramp)| ramp.step(p.period));
        Answer { demand, target_reached: standstill, bit_12: false, bit_13: false }
    }
}

/// Cuts the efforts of a demand to the limits of both directions; whether there was anything to cut.
#[inline]
fn keep_within([forward, backward]: [f64; 2], demand: &mut Demand) -> bool {
    let (Demand::Position { effort_offset: effort, .. }
    | Demand::Velocity { effort_offset: effort, .. }
    | Demand::Effort(effort)) = demand
    else {
        return false;
    };
    let is_beyond = *effort > forward || *effort < -backward;
    *effort = effort.clamp(-backward, forward);
    is_beyond
}

/// The same demand on an axis that counts from elsewhere.
#[inline]
fn move_by(distance: f64, demand: &mut Demand) {
    if let Demand::Position { setpoint, .. } = demand {
        setpoint.x += distance;
    }
}
