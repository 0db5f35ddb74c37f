//! The firmware: position, velocity and current loops in a cascade, each at its own rate.
//!
//! Order of events at a tick: position loop → velocity loop → current loop. A slower loop's output reaches the faster one **in the same
//! tick** and is held in between, except for the velocity feedforward: in each cycle of the velocity loop it follows the reference's own
//! polynomial, at the instant to which the measured velocity belongs. Only the current loop's voltage waits one period of that loop (its
//! computation time). The firmware knows the axis only by its sensors and its own estimates.
//!
//! Position and its reference are in the axis coordinate, velocity and effort in the motor's; `transmission` converts.
#![expect(clippy::inline_always, reason = "what is inlined is compiled for the registers of its caller")]
use crate::blocks::{self, Blocks};
use crate::current::operating_point::{self, Envelope};
use crate::feedforward::MotorReference;
use crate::measurement::{self, Edge};
use crate::params::{Params, Stage};
use crate::supervision::{Finding, Motion};
use crate::{Demand, EffortLimits, current, delay, velocity};
use servobench_base::{AlphaBeta, Countdown, Dq, ElectricalAngle, KnownRotation, PowerCommand, Setpoint, Stateful};
use servobench_config::ParameterError;

/// Encoder that closes the position loop.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Feedback {
    /// The motor's encoder; the loop follows the motor's own reference.
    #[default]
    Motor,
    /// The load's encoder, with this reading (axis coordinate); the loop follows the load's reference.
    Load(f64),
}

/// Sensor values at tick k.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Sensors {
    /// Motor position (motor coordinate).
    pub motor_position: f64,
    /// Rotor position for the commutation (motor coordinate), if it differs from the motor position.
    pub rotor_position: Option<f64>,
    /// Motor velocity, if the encoder provides one; otherwise the firmware forms differences.
    pub motor_velocity: Option<f64>,
    /// Last edge of the motor's encoder, if edges are timed.
    pub motor_edge: Option<Edge>,
    /// Feedback of the position loop.
    pub feedback: Feedback,
    /// Stator current (A, peak).
    pub current: AlphaBeta,
    /// DC link (V).
    pub dc_link: f64,
    /// Temperature of the winding (°C).
    pub winding: f64,
    /// A precomputed rotation: used if it belongs to the angle that the firmware reads.
    pub known_rotation: KnownRotation,
}

impl Sensors {
    /// Position of the encoder that closes the position loop, in its own coordinate.
    #[must_use]
    pub const fn closing_position(&self) -> f64 {
        match self.feedback {
            Feedback::Motor => self.motor_position,
            Feedback::Load(position) => position,
        }
    }
}

/// Closed loops.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Stateful)]
enum Closed {
    #[default]
    Position,
    Velocity,
    /// Only the current loop.
    Effort,
    None,
}

/// Outputs of each loop in its last cycle, held for faster loops and recordings until the next.
#[derive(Debug, Clone, Copy, PartialEq, Default, Stateful)]
pub struct Held {
    /// Load-side reference, delay-matched (axis coordinate).
    pub reference: Setpoint,
    /// Motor's own reference (axis coordinate).
    pub motor_reference: MotorReference,
    /// Velocity reference of the velocity loop at its last cycle (axis coordinate).
    pub velocity_reference: f64,
    /// True if the speed limit cut the reference.
    pub speed_is_cut: bool,
    /// Feedforward effort (motor coordinate).
    pub feedforward: f64,
    /// Effort reference (motor coordinate) and its limit in action: the effort limit, or the current limit below it.
    pub effort: velocity::Output,
    /// q-axis current reference (A, peak).
    pub current_reference: f64,
    /// References of both axes (A, peak), unless the d axis has a constant one.
    pub references: Dq,
    /// Output of the current loop.
    pub current: current::Output,
}

/// State from tick to tick.
#[derive(Debug, Clone, PartialEq, Default, Stateful)]
pub struct State {
    delay: delay::State,
    /// Velocity offsets, delayed with their set-points.
    offset_delay: delay::Values,
    blocks: blocks::State,
    velocity: velocity::State,
    current: current::State,
    operation: operating_point::State,
    /// Velocity after the filter (motor coordinate).
    filtered_velocity: f64,
    last_position: Option<f64>,
    closed: Closed,
    position_turn: Countdown,
    velocity_turn: Countdown,
    current_turn: Countdown,
    /// Velocity command of the position loop in its last cycle (axis coordinate).
    velocity_command: f64,
    held: Held,
}

impl State {
    /// State at rest on the set-point `start`.
    ///
    /// # Errors
    /// [`ParameterError`] names the first parameter of `p` that is out of its bound.
    pub fn new(p: &Params, start: Setpoint) -> Result<Self, ParameterError> {
        p.check()?;
        Ok(Self { delay: delay::State::new(start), ..Self::default() })
    }

    /// Velocity as used by the velocity loop (axis coordinate).
    #[must_use]
    pub fn velocity(&self, p: &Params) -> f64 {
        p.transmission * self.filtered_velocity
    }

    /// Present following error of the position loop: its reference less the position (axis coordinate).
    #[must_use]
    pub fn following_error(&self, p: &Params, sensors: &Sensors) -> f64 {
        let (reference, motor_reference) = self.references(p);
        match sensors.feedback {
            Feedback::Load(position) => reference.x - position,
            Feedback::Motor => motor_reference.position - p.transmission * sensors.motor_position,
        }
    }

    /// Thermal loads of the motor and of the drive: 1 is the steady state of the continuous current.
    #[must_use]
    pub fn loads(&self) -> [f64; 2] {
        self.blocks.loads.map(|load| load.load)
    }

    /// True if a thermal load whose limit is a fault is reached.
    #[must_use]
    pub fn is_overloaded(&self, p: &Params) -> bool {
        p.blocks.is_overloaded(&self.blocks)
    }

    /// Finding of the supervision of motor and power stage since power-on.
    #[must_use]
    pub const fn finding(&self) -> Option<Finding> {
        self.blocks.supervision.found
    }

    /// Outputs of the loops in their last cycles.
    #[must_use]
    pub const fn held(&self) -> &Held {
        &self.held
    }

    /// References at the present tick: between two cycles of the position loop the held set-point continues along its own polynomial.
    /// Following errors are measured against these; a constant reference while the axis moves on would add an error of velocity × period.
    #[inline(always)]
    #[must_use]
    pub fn references(&self, p: &Params) -> (Setpoint, MotorReference) {
        let since = self.position_turn.since(p.position_every);
        if since == 0 {
            return (self.held.reference, self.held.motor_reference);
        }
        let now = self.held.reference.after(f64::from(since) * p.base_rate.period());
        (now, p.feedforward.motor_reference(now))
    }
}

/// Executes one base tick: runs the loops that are due and returns the command to the power stage from now on. The demand is sampled in the
/// cycles of the position loop, the limits in those of the velocity loop.
#[inline(always)]
pub fn step(p: &Params, x: &mut State, demand: &Demand, limits: EffortLimits, sensors: &Sensors) -> PowerCommand {
    if x.position_turn.is_due(p.position_every) {
        take(p, x, demand, sensors);
        x.velocity_command = x.held.velocity_reference;
    }
    if x.velocity_turn.is_due(p.velocity_every) {
        velocity_loop(p, x, limits, sensors);
    }
    match &p.stage {
        Stage::Current { params, every } => {
            let is_due = x.current_turn.is_due(*every);
            if x.closed == Closed::None {
                return PowerCommand::Off;
            }
            if is_due {
                current_loop(params, &p.blocks, x, sensors, p.period(*every));
            }
            PowerCommand::Voltage(x.held.current.voltage)
        }
        Stage::Direct { .. } if x.closed == Closed::None => PowerCommand::Off,
        Stage::Direct { gain } => PowerCommand::Output(x.held.effort.effort / gain),
    }
}

#[inline(always)]
fn take(p: &Params, x: &mut State, demand: &Demand, sensors: &Sensors) {
    match *demand {
        Demand::Position { setpoint, velocity_offset, effort_offset } => {
            if x.closed != Closed::Position {
                x.close(Closed::Position);
                x.blocks.close_position_loop();
                x.delay = delay::State::new(setpoint);
                x.offset_delay = delay::Values::new(velocity_offset);
            }
            position_loop(p, x, setpoint, sensors);
            x.held.velocity_reference += delay::step_value(&p.reference_delay, &mut x.offset_delay, velocity_offset);
            x.held.feedforward += effort_offset;
        }
        Demand::Velocity { setpoint, effort_offset } => {
            x.close(Closed::Velocity);
            x.rest_on(p, sensors);
            x.held.velocity_reference = setpoint.v;
            x.held.feedforward = p.transmission * p.feedforward.effort(setpoint) + effort_offset;
        }
        Demand::Effort(effort) => {
            x.close(Closed::Effort);
            x.rest_on(p, sensors);
            x.held.feedforward = effort;
        }
        Demand::Off => {
            x.close(Closed::None);
            x.rest_on(p, sensors);
        }
    }
}

impl State {
    /// Switches to other loops: the states of the lower loops stay, unless the power goes off.
    fn close(&mut self, closed: Closed) {
        if closed == Closed::None && self.closed != Closed::None {
            (self.velocity, self.current) = (velocity::State::default(), current::State::default());
            self.operation = operating_point::State::default();
            self.blocks.power_off();
            let Held { reference, motor_reference, .. } = self.held;
            self.held = Held { reference, motor_reference, ..Held::default() };
        }
        self.closed = closed;
    }

    /// Sign in which the speed limit or the effort limit cut the demand of the loops in their last cycle; 0 if none did.
    #[inline(always)]
    fn cut(&self, p: &Params) -> f64 {
        if self.velocity_command.abs() > p.blocks.max_speed * p.transmission.abs() {
            return self.velocity_command.signum();
        }
        self.held.effort.cut.map_or(0.0, |_| self.held.effort.effort.signum())
    }

    /// Sets the reference to the present position, for operation without a position loop.
    fn rest_on(&mut self, p: &Params, sensors: &Sensors) {
        let position = match sensors.feedback {
            Feedback::Load(position) => position,
            Feedback::Motor => p.transmission * sensors.motor_position,
        };
        let reference = Setpoint { v: p.transmission * self.filtered_velocity, ..Setpoint::at_rest(position) };
        self.held.reference = reference;
        self.held.motor_reference = MotorReference { position: reference.x, velocity: reference.v };
        self.held.velocity_reference = reference.v;
    }
}

#[inline(always)]
fn position_loop(p: &Params, x: &mut State, setpoint: Setpoint, sensors: &Sensors) {
    let reference = delay::step(&p.reference_delay, &mut x.delay, setpoint);
    let motor_reference = p.feedforward.motor_reference(reference);
    let error = match sensors.feedback {
        Feedback::Load(position) => reference.x - position,
        Feedback::Motor => motor_reference.position - p.transmission * sensors.motor_position,
    };
    let cut = x.cut(p);
    let error = p.blocks.position_error(&mut x.blocks, error, cut, p.period(p.position_every));
    x.held.reference = reference;
    x.held.motor_reference = motor_reference;
    let gain = p.blocks.gain_factors(x.filtered_velocity).0 * p.position_gain;
    x.held.velocity_reference = gain * error + p.feedforward.velocity * motor_reference.velocity;
    x.held.feedforward = p.transmission * p.feedforward.effort(setpoint);
}

#[inline(always)]
fn velocity_loop(p: &Params, x: &mut State, limits: EffortLimits, sensors: &Sensors) {
    let h = p.period(p.velocity_every);
    let mut followed = x.held.velocity_reference;
    let mut asked = x.velocity_command;
    if x.closed == Closed::Position && p.feedforward.interpolate {
        let fed_forward = |since: f64| {
            let velocity = p.feedforward.motor_reference(x.held.reference.after(since)).velocity;
            x.velocity_command + p.feedforward.velocity * (velocity - x.held.motor_reference.velocity)
        };
        let since = f64::from(x.position_turn.since(p.position_every)) * p.base_rate.period();
        // The measured velocity is delayed by the difference and the filter: it is compared with a reference of the same age.
        let age = p.velocity_filter_time + p.blocks.velocity_age(sensors.motor_velocity, h);
        followed = fed_forward(since - age);
        x.held.velocity_reference = fed_forward(since);
        asked = x.held.velocity_reference;
    }
    if p.blocks.max_speed.is_finite() {
        let most = p.blocks.max_speed * p.transmission.abs();
        followed = followed.clamp(-most, most);
        x.held.velocity_reference = x.held.velocity_reference.clamp(-most, most);
        x.held.speed_is_cut = matches!(x.closed, Closed::Position | Closed::Velocity) && asked.abs() > most;
    }
    let last = x.last_position.replace(sensors.motor_position).unwrap_or(sensors.motor_position);
    let travelled = sensors.motor_position - last;
    let (position, edge, effort) = (sensors.motor_position, sensors.motor_edge, x.held.effort.effort);
    let input = measurement::Input { position, travelled, edge, effort, of_encoder: sensors.motor_velocity };
    let measured = p.blocks.measured_velocity(&mut x.blocks, input, h);
    // Backward Euler of the low-pass: stable for every time constant, and without effect at zero.
    x.filtered_velocity += h / (h + p.velocity_filter_time) * (measured - x.filtered_velocity);
    let velocity = x.filtered_velocity;
    if x.closed != Closed::None {
        let (dc_link, winding, is_cut) = (sensors.dc_link, sensors.winding, x.held.effort.cut.is_some());
        p.blocks.watch_motion(&mut x.blocks, Motion { velocity, dc_link, winding, is_cut }, h);
    }
    let feedforward = p.blocks.feedforward(&x.blocks, x.held.feedforward, position, velocity);
    let mut chosen = None;
    let available = match &p.stage {
        Stage::Current { params, .. } => {
            let max_current = p.blocks.max_current(&mut x.blocks, x.held.current.current, params.max_current, h);
            if params.operation.is_plain() && max_current >= params.max_current {
                EffortLimits::both(params.max_effort())
            } else {
                let max_voltage = p.blocks.max_voltage(params, sensors.dc_link);
                let params = current::Params { max_current, max_voltage, ..*params };
                operating_point::step(&params, &mut x.operation, x.held.current.computed, h);
                let omega_e = params.motor.electrical_ratio * velocity;
                let envelope = Envelope::new(&params, &x.operation, omega_e);
                chosen = Some((params, envelope));
                envelope.limits()
            }
        }
        Stage::Direct { .. } => EffortLimits::NONE,
    };
    let reference = followed / p.transmission;
    let mut input = velocity::Input { reference, velocity, feedforward, available, limits };
    x.held.effort = match x.closed {
        Closed::Position | Closed::Velocity => {
            let params = velocity::Params { k_p: p.blocks.gain_factors(velocity).1 * p.velocity.k_p, ..p.velocity };
            input.feedforward -= params.k_p * p.blocks.acceleration(&mut x.blocks, velocity, h);
            let shaped = |effort| p.blocks.effort(&mut x.blocks, effort);
            velocity::step_shaped(&params, &mut x.velocity, input, h, p.blocks.reference_weight, shaped)
        }
        Closed::Effort => {
            velocity::limited(&p.velocity, available, limits, p.blocks.effort(&mut x.blocks, feedforward))
        }
        Closed::None => velocity::Output::default(),
    };
    if let Some((params, envelope)) = chosen {
        x.held.references = envelope.currents(&params, x.held.effort.effort);
    }
}

#[inline(always)]
fn current_loop(p: &current::Params, blocks: &Blocks, x: &mut State, sensors: &Sensors, h: f64) {
    let reference = if p.operation.is_plain() {
        // The velocity loop keeps within the current limit; only the rounding of the quotient is cut here.
        let (wanted, most) = (x.held.effort.effort / p.effort_constant(), p.max_q_current());
        Dq { d: p.d_reference, q: wanted.clamp(-most, most) }
    } else {
        x.held.references
    };
    x.held.current_reference = reference.q;
    let input = current::Input {
        reference,
        current: sensors.current,
        rotor: sensors.known_rotation.at(ElectricalAngle::from_mechanical(
            sensors.rotor_position.unwrap_or(sensors.motor_position),
            p.motor.electrical_ratio,
        )),
        omega_e: p.motor.electrical_ratio * x.filtered_velocity,
    };
    x.held.current = if blocks.measures_dc_link {
        let max_voltage = blocks.max_voltage(p, sensors.dc_link);
        current::step(&current::Params { max_voltage, ..*p }, &mut x.current, input, h)
    } else {
        current::step(p, &mut x.current, input, h)
    };
    blocks.watch_currents(&mut x.blocks, p, &input, x.filtered_velocity, x.held.current.current.q, h);
}

#[cfg(test)]
mod tests;
