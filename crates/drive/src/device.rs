//! The drive as the fieldbus sees it (CiA 402): frames in, demands for the loops out, once per period of the position loop.
//!
//! Order of events in a [`step`]:
//!
//! 1. the received frame is converted from drive units,
//! 2. faults are detected: external, of the power, of the encoders, of motor and power stage, missing frames, following error (603Fh),
//! 3. the power state machine takes the pending transition,
//! 4. the mode of operation, or a requested stop, determines the demand on the loops,
//! 5. limits cut it: ends of the axis, effort.
//!
//! So a frame, a fault or a switch acts at the step at which it is seen. The process data for the master, [`State::actuals`], are those of
//! the last step.
//!
//! # Positions
//!
//! The encoder gives increments, unwrapped, in its own direction. The axis counts from another zero once it is homed; modes use that
//! position (m or rad), the loops the encoder's. The bus has a wrapping counter of user-defined units: of all positions that show the same
//! value, an absolute target of a cyclic mode is the nearest to the axis, and one of a profile lies in the same turn of the counter as the
//! axis.
//!
//! # A lost encoder
//!
//! A motor encoder that reports a failure, or a NaN velocity or effort, leaves nothing to close a loop with. Whatever the fault reaction
//! option code (605Eh), the power stage is then switched off at once and the axis coasts; the same holds if the encoder fails during the
//! braking of another fault, and if the current no longer brakes
//! ([`Finding::leaves_no_brake`](crate::supervision::Finding::leaves_no_brake)). Without the load encoder the axis is braked by its
//! velocity, which is the motor's.
//!
//! # Take-over
//!
//! When the drive function is enabled, the demand begins at the position and velocity of the axis. When a mode follows another or a stop,
//! it begins with the position and the velocity that the loops follow. The drive does not switch to an unsupported mode: the display
//! (6061h) shows the active one. While the axis is braked, the mode stays. A halt (bit 8) stops the axis in every mode; pp continues with
//! its set-point afterwards. Bits 12 and 13 of the statusword keep their meaning during a halt: a cyclic mode does not follow the master
//! then, nor while an end of the axis prevents it, and homing attains its reference once the search is over.
mod cycle;
mod fault;
mod guard;
mod objects;
mod params;
mod process_data;
mod rotary;
mod running;
mod supervision;
mod touch_probe;
mod units;
mod window;

pub use cycle::{CycleEvent, Params as CycleParams};
pub use fault::Fault;
pub use objects::ObjectsError;
pub use params::{Limits, Params, Profile};
pub use rotary::Rotary;
pub use units::Units;
pub use window::{Dwell, Window};

use crate::modes::interpolated::{Buffer, DataRecord};
use crate::modes::stop::Ramp;
use crate::modes::{Actual, Answer, Moment, Targets};
use crate::supervision::Finding;
use crate::{Demand, EffortLimits};
use running::Running;
use servobench_base::{ParamError, Setpoint, Stateful};
use servobench_cia402::{
    self as cia402, Command, Commands, Deceleration, DriveFunction, Mode, PowerInputs, PowerMemory, PowerState,
    StatusBit, Statusword, Transition,
};

/// Inputs of the drive at a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Inputs<'a> {
    /// The newest frame of the master, if one came since the last step.
    pub frame: Option<&'a Commands>,
    /// Measured values.
    pub measured: Measured,
    /// External fault, while it is present: its code (603Fh).
    pub fault: Option<u16>,
    /// True if the high-level power is applied.
    pub main_voltage: bool,
}

/// Values measured by the drive.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[expect(clippy::struct_excessive_bools, reason = "each is a separate signal")]
pub struct Measured {
    /// Position of the encoder, unwrapped (increments).
    pub increments: i64,
    /// Velocity of the axis (m/s or rad/s) in the encoder's direction.
    pub velocity: f64,
    /// Effort of the motor (N·m or N).
    pub effort: f64,
    /// Following error of the position loop in its last cycle: its own reference, delays included, less the position (m or rad).
    pub following_error: f64,
    /// True if the loops cut the effort in their last cycle.
    pub effort_is_cut: bool,
    /// True if the input for the switch of the negative end is closed.
    pub negative_limit: bool,
    /// True if the input for the switch of the positive end is closed.
    pub positive_limit: bool,
    /// True if the input for the home switch is closed.
    pub home: bool,
    /// Increments at the last index pulse, if one came since the last step.
    pub index: Option<i64>,
    /// True if an I²t load whose limit is a fault is reached.
    pub is_overloaded: bool,
    /// True if the encoder of the motor reports a failure.
    pub motor_encoder_error: bool,
    /// True if the encoder of the load reports a failure.
    pub load_encoder_error: bool,
    /// Finding of the supervision of motor and power stage.
    pub finding: Option<Finding>,
}

/// Outputs of a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Outputs {
    /// Demand on the loops, in the encoder's coordinate.
    pub demand: Demand,
    /// Largest efforts that the loops may demand.
    pub effort_limits: EffortLimits,
    /// Transition of the power state machine that was taken.
    pub transition: Option<&'static Transition>,
    /// Fault that caused the fault reaction at this step.
    pub fault: Option<Fault>,
}

/// State from tick to tick.
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
#[expect(clippy::struct_excessive_bools, reason = "each is a separate state")]
pub struct State {
    power: PowerMemory,
    /// Mode requested by the master, and the active one.
    wanted: Option<Mode>,
    mode: Option<Mode>,
    running: Option<Running>,
    stop: Option<(Deceleration, Ramp)>,
    guard: guard::State,
    cycle: cycle::State,
    buffer: Buffer,
    data_record: DataRecord,
    /// True if the last point of the master could not be read.
    has_refused_point: bool,
    probe: touch_probe::State,
    /// Command of the master to the probe (60B8h), and to the digital outputs (60FEh).
    probe_function: u16,
    digital_outputs: u32,
    now: Moment,
    /// Demand of the last step, in the axis' coordinate.
    last: Demand,
    /// True if the last frame exceeded the limits.
    is_cut: bool,
    /// Effort limits of the settings and the last frame.
    effort_limits: EffortLimits,
    /// Zero of the axis (increments).
    origin: i64,
    /// Shift by homing of every position from the next step on.
    shift: Option<f64>,
    fault: Option<Fault>,
    /// True if a failure that leaves no loop to brake with came before or during the present fault.
    cannot_brake: bool,
    /// True if the encoder of the load failed.
    has_lost_load: bool,
    beyond_following_error: Dwell,
    at_standstill: Dwell,
    statusword: Statusword,
    increments: i64,
    following_error: f64,
}

impl State {
    /// State after power-on, with the zero of the axis at that of the encoder.
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
            data_record: DataRecord::default(),
            has_refused_point: false,
            probe: touch_probe::State::default(),
            probe_function: 0,
            digital_outputs: 0,
            now: Moment {
                targets: Targets::default(),
                actual: Actual::default(),
                demanded: Setpoint::default(),
                period: p.period,
            },
            last: Demand::Off,
            is_cut: false,
            effort_limits: p.limits.effort,
            origin: 0,
            shift: None,
            fault: None,
            cannot_brake: false,
            has_lost_load: false,
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

    /// True if a limit of the drive is active (bit 11 of the statusword).
    #[must_use]
    pub const fn is_limited(&self) -> bool {
        self.statusword.has(StatusBit::InternalLimitActive)
    }

    /// Active mode; `None` before the first one.
    #[must_use]
    pub const fn mode(&self) -> Option<Mode> {
        self.mode
    }

    /// True if the highest velocity (6080h) cut the target of csv.
    #[must_use]
    pub const fn cuts_velocity(&self) -> bool {
        match &self.running {
            Some(Running::Csv(mode)) => mode.is_limited(),
            _ => false,
        }
    }

    /// Zero of the axis (increments of the encoder).
    #[must_use]
    pub const fn origin(&self) -> i64 {
        self.origin
    }

    /// Present fault, until it is reset.
    #[must_use]
    pub const fn fault(&self) -> Option<Fault> {
        self.fault
    }

    /// Bits of the digital outputs (60FEh:1), which are not connected.
    #[must_use]
    pub const fn digital_outputs(&self) -> u32 {
        self.digital_outputs
    }

    /// Free places of the trajectory buffer (2011h).
    #[must_use]
    pub const fn buffer_free(&self) -> usize {
        self.buffer.free()
    }

    /// State of the trajectory buffer (2012h).
    #[must_use]
    pub fn buffer_status(&self) -> u32 {
        self.buffer.status()
    }

    /// Trajectory buffer, for points that come without a frame: through the serial interface, or in an unmapped data record (60C1h).
    pub const fn trajectory_buffer(&mut self) -> &mut Buffer {
        &mut self.buffer
    }
}

/// Executes one period of the position loop.
pub fn step(p: &Params, x: &mut State, u: &Inputs) -> Outputs {
    x.measure(p, &u.measured);
    if let Some(frame) = u.frame {
        x.take(p, frame);
    }
    x.now.targets.is_new = u.frame.is_some();
    x.probe(p, &u.measured);
    let event = cycle::step(&p.cycle, &mut x.cycle, u.frame.is_some());
    let found = x.find_fault(p, u, event);
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
    let reactions = x.reactions(p, &u.measured);
    let power = cia402::step(&reactions, &mut x.power, x.now.targets.controlword, inputs);
    let fault = x.remember(found, power.transition);
    let mut answer = match power.drive {
        DriveFunction::Disabled => x.idle(),
        DriveFunction::Follow => x.follow(p, event),
        DriveFunction::Brake(how) => x.brake(p, how, standstill),
    };
    if !u.main_voltage {
        // Without power nothing can be driven, whatever the state; afterwards everything begins at the position of the axis.
        answer.demand = Demand::Off;
        (x.running, x.stop) = (None, None);
    }
    let is_limited = answer.demand.keep_within(x.effort_limits)
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
        .with(StatusBit::ModeSpecific13, answer.bit_13 || x.tells_following_error());
    answer.demand.move_by(p.units.metres_or_radians(x.origin));
    if let Some(shift) = x.shift.take() {
        x.move_zero(p, shift);
    }
    Outputs { demand: answer.demand, effort_limits: x.effort_limits, transition: power.transition, fault }
}

impl State {
    /// Evaluates the sensors: the actual values, and the set-point from which the loops continue.
    fn measure(&mut self, p: &Params, measured: &Measured) {
        (self.increments, self.following_error) = (measured.increments, measured.following_error);
        let position = |increments: i64| p.units.metres_or_radians(increments.wrapping_sub(self.origin));
        let actual = Actual {
            position: position(measured.increments),
            velocity: if measured.velocity.is_finite() { measured.velocity } else { 0.0 },
            effort: if measured.effort.is_finite() { measured.effort } else { 0.0 },
            negative_limit: measured.negative_limit != p.reverse_switches,
            positive_limit: measured.positive_limit != p.reverse_switches,
            home: measured.home != p.reverse_switches,
            index: measured.index.map(position),
        };
        self.now.demanded = match self.last {
            Demand::Position { setpoint, .. } => setpoint.after(p.period),
            Demand::Velocity { setpoint, .. } => Setpoint { x: actual.position, ..setpoint.after(p.period) },
            Demand::Effort(_) | Demand::Off => Setpoint { v: actual.velocity, ..Setpoint::at_rest(actual.position) },
        };
        self.now.actual = actual;
    }

    /// Updates the touch probe by its command.
    fn probe(&mut self, p: &Params, measured: &Measured) {
        let position = |increments: i64| p.units.position(increments.wrapping_sub(self.origin));
        let input = touch_probe::Input {
            function: self.probe_function,
            is_active: measured.home != p.reverse_switches,
            position: position(measured.increments),
            index: measured.index.map(position),
        };
        self.probe.step(&input);
    }

    /// Shifts every position, by whole increments.
    fn move_zero(&mut self, p: &Params, shift: f64) {
        let increments = p.units.increments(shift);
        self.origin = self.origin.wrapping_sub(increments);
        self.last.move_by(p.units.metres_or_radians(increments));
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

    fn follow(&mut self, p: &Params, event: CycleEvent) -> Answer {
        self.switch_mode();
        let Some(mode) = self.mode else {
            // No mode yet: the axis is held in place.
            return self.brake(p, Deceleration::SlowDownRamp, false);
        };
        let (begins, was_stopped) = (self.running.is_none(), self.stop.take().is_some());
        if begins || was_stopped || self.guard.is_active() {
            // The acceleration of other demands may exceed the limits of this mode.
            let Setpoint { x, v, .. } = self.now.demanded;
            self.now.demanded = Setpoint { v, ..Setpoint::at_rest(x) };
        }
        if begins {
            self.guard = guard::State::default();
        } else if was_stopped && let Some(running) = &mut self.running {
            running.resume(p, &self.now);
        }
        let running = self.running.get_or_insert_with(|| Running::begin(p, mode, &self.now));
        let mut answer = running.step(p, &self.now, event, &mut self.buffer, &mut self.shift);
        if running.looks_for_ends() {
            self.guard = guard::State::default();
        } else {
            self.guard.step(p, &self.now, &mut answer.demand);
        }
        if running.follows_master() {
            // Targets of csp that are cut at a software limit (607Dh) never reach the guard.
            answer.bit_12 = !(self.guard.is_active() || self.is_cut);
        }
        answer
    }

    /// Brakes and holds. Only a halt preserves the state of the mode.
    fn brake(&mut self, p: &Params, how: Deceleration, standstill: bool) -> Answer {
        let is_halt = self.power.state() == PowerState::OperationEnabled
            && self.now.targets.controlword.gives(Command::EnableOperation);
        if !is_halt {
            self.running = None;
        }
        let deceleration = match how {
            Deceleration::SlowDownRamp => Some(self.now.targets.profile_deceleration),
            Deceleration::QuickStopRamp => Some(p.profile.quick_stop_deceleration),
            Deceleration::CurrentLimit | Deceleration::VoltageLimit => None,
        };
        let closes_position = deceleration.is_some()
            && !self.has_lost_load
            && !matches!(self.last, Demand::Velocity { .. } | Demand::Effort(_));
        if self.stop.is_none_or(|(as_before, _)| as_before != how) {
            let ramp = Ramp::begin(&self.now.demanded, self.last.offsets(), deceleration, closes_position);
            self.stop = Some((how, ramp));
        }
        let mut demand = self.stop.as_mut().map_or(Demand::Off, |(_, ramp)| ramp.step(p.period));
        // At an end of the axis the guard's ramp overrides a gentler one.
        self.guard.step(p, &self.now, &mut demand);
        let [bit_12, bit_13] = self.running.as_mut().map_or([false; 2], |running| running.halted(p, &self.now));
        Answer { demand, target_reached: standstill, bit_12, bit_13 }
    }
}
