//! The drive as the fieldbus sees it (CiA 402): frames in, demands for the loops out, once per period of the position loop.
//!
//! Order of events in a [`step`]:
//!
//! 1. the frame that came is converted: drive units end here,
//! 2. faults are looked for: from outside, of the power, of the encoders, of motor and power stage, missing frames, following error
//!    (603Fh),
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
//! that position (m or rad), the loops the encoder's. The bus has a counter of user-defined units that wraps: an absolute target of
//! a cyclic mode is the one of all that show the same value which is nearest to the axis, one of a profile lies in the same turn
//! of the counter as the axis.
//!
//! # A lost encoder
//!
//! An encoder of the motor that says that it has failed, a velocity or an effort that is no number leaves nothing to close a loop by.
//! Whatever the fault reaction option code (605Eh) says, the power stage is then switched off at once and the axis coasts; so it is when
//! the encoder fails while another fault is being braked, and where the current does not brake any more
//! ([`Finding::leaves_no_brake`](crate::supervision::Finding::leaves_no_brake)). Without the encoder of the load the axis is braked by its
//! velocity, which is the motor's.
//!
//! # Take-over
//!
//! When the drive function is enabled, the demand begins where the axis is, at its velocity. When a mode follows another or a
//! stop, it begins with the position and the velocity that the loops follow. A mode that the drive does not have is not switched
//! to: the display (6061h) says what runs. While the axis is braked, the mode stays. A halt (bit 8) stops the axis in every mode;
//! pp goes on with its set-point afterwards. Bits 12 and 13 of the statusword keep their meaning during a halt: what a cyclic
//! mode does then is not to follow the master, nor does it while an end of the axis keeps it from that, and a reference is
//! attained in homing once its search is over.
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
    /// Whether the input for the switch of the negative end is closed.
    pub negative_limit: bool,
    /// Whether the input for the switch of the positive end is closed.
    pub positive_limit: bool,
    /// Whether the input for the home switch is closed.
    pub home: bool,
    /// Increments at which the last index pulse came, when one came since the last step.
    pub index: Option<i64>,
    /// Whether an I²t load is reached that is a fault.
    pub is_overloaded: bool,
    /// Whether the encoder of the motor says that it has failed.
    pub motor_encoder_error: bool,
    /// Whether that of the load does.
    pub load_encoder_error: bool,
    /// Finding of the supervision of motor and power stage.
    pub finding: Option<Finding>,
}

/// What a step gives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Outputs {
    /// For the loops, in the encoder's coordinate.
    pub demand: Demand,
    /// What the loops may make of it at most.
    pub effort_limits: EffortLimits,
    /// Transition of the power state machine that was taken.
    pub transition: Option<&'static Transition>,
    /// Fault that sent the drive into its fault reaction at this step.
    pub fault: Option<Fault>,
}

/// State from tick to tick.
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
#[expect(clippy::struct_excessive_bools, reason = "each is a state of its own")]
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
    data_record: DataRecord,
    /// Whether the last point of the master could not be read.
    has_refused_point: bool,
    probe: touch_probe::State,
    /// What the master asks of the probe (60B8h), and of the digital outputs (60FEh).
    probe_function: u16,
    digital_outputs: u32,
    now: Moment,
    /// What the loops were asked at the last step, in the axis' coordinate.
    last: Demand,
    /// Whether the last frame asked for more than the limits.
    is_cut: bool,
    /// Efforts as the settings limit them, and the last frame.
    effort_limits: EffortLimits,
    /// Where the axis has its zero (increments).
    origin: i64,
    /// What homing adds to every position from the next step on.
    shift: Option<f64>,
    fault: Option<Fault>,
    /// Whether what leaves no loop to brake by came before or during the fault that the drive is in.
    cannot_brake: bool,
    /// Whether the encoder of the load failed.
    has_lost_load: bool,
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

    /// True where a limit of the drive is active (bit 11 of the statusword).
    #[must_use]
    pub const fn is_limited(&self) -> bool {
        self.statusword.has(StatusBit::InternalLimitActive)
    }

    /// Mode that is active; `None` before the first one.
    #[must_use]
    pub const fn mode(&self) -> Option<Mode> {
        self.mode
    }

    /// True where the highest velocity (6080h) cut the target of csv.
    #[must_use]
    pub const fn cuts_velocity(&self) -> bool {
        match &self.running {
            Some(Running::Csv(mode)) => mode.is_limited(),
            _ => false,
        }
    }

    /// Where the axis has its zero (increments of the encoder).
    #[must_use]
    pub const fn origin(&self) -> i64 {
        self.origin
    }

    /// The fault that the drive is in, until it is reset.
    #[must_use]
    pub const fn fault(&self) -> Option<Fault> {
        self.fault
    }

    /// Bits of the digital outputs (60FEh:1), which nothing is connected to.
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

    /// The trajectory buffer, for points that come without a frame: through the serial interface, or a data record (60C1h) that is
    /// not mapped.
    pub const fn trajectory_buffer(&mut self) -> &mut Buffer {
        &mut self.buffer
    }
}

/// One period of the position loop.
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
        // Without power nothing can be driven, whatever the state says; when it is back, all begins where the axis is then.
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
    /// Reads the sensors: where the axis is, and where the loops go on from.
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

    /// Looks at what the touch probe is asked for.
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

    /// Adds to every position, as far as whole increments go.
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
            // None yet: the axis is held where it is.
            return self.brake(p, Deceleration::SlowDownRamp, false);
        };
        let (begins, was_stopped) = (self.running.is_none(), self.stop.take().is_some());
        if begins || was_stopped || self.guard.is_active() {
            // The acceleration of others may be beyond the limits of this mode.
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

    /// Brakes and holds. Only a halt leaves the mode what it was doing.
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
        // At an end of the axis no ramp is gentler than the one that keeps it from going on.
        self.guard.step(p, &self.now, &mut demand);
        let [bit_12, bit_13] = self.running.as_mut().map_or([false; 2], |running| running.halted(p, &self.now));
        Answer { demand, target_reached: standstill, bit_12, bit_13 }
    }
}
