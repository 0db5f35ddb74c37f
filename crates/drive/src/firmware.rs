//! The firmware: position, velocity and current loops in a cascade, each at its own rate.
//!
//! Order of events at a tick: position loop → velocity loop → current loop. A slower loop's output reaches the faster
//! one **in the same tick**; in between it is held, but for the velocity that is fed forward: at each cycle of the velocity
//! loop it is that of the reference's own polynomial, at the instant of which the measured velocity is. Only the current loop's voltage waits one period of that loop (the
//! time its computation takes). It knows the axis by its sensors and its own estimates, nothing else.
//!
//! Position and its reference are in the axis coordinate, velocity and effort in the motor's; `transmission` converts.
#![expect(clippy::inline_always, reason = "what is inlined is compiled for the registers of its caller")]
use crate::feedforward::MotorReference;
use crate::params::{Params, Stage};
use crate::{Demand, EffortLimits};
use crate::{current, delay, velocity};
use servobench_base::{AlphaBeta, Countdown, Dq, ElectricalAngle, KnownRotation, PowerCommand, Setpoint};
use servobench_config::ParameterError;

/// Which encoder closes the position loop.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Feedback {
    /// The motor's; the loop follows the motor's own reference.
    #[default]
    Motor,
    /// The load's, which reads this position (axis coordinate); the loop follows the load's reference.
    Load(f64),
}

/// What the sensors say at tick k.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Sensors {
    /// Motor position (motor coordinate).
    pub motor_position: f64,
    /// Motor velocity, where the encoder gives one; otherwise the firmware forms differences.
    pub motor_velocity: Option<f64>,
    /// What closes the position loop.
    pub feedback: Feedback,
    /// Stator current (A, peak).
    pub current: AlphaBeta,
    /// A rotation that somebody has worked out: where it is that of the angle that the firmware reads, it is taken from here.
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

/// Which of the loops are closed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
enum Closed {
    #[default]
    Position,
    Velocity,
    /// Only the current loop.
    Effort,
    None,
}

/// What each loop said at its last turn, which is what a faster one and a recording see until the next.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Held {
    /// Load-side reference, delay-matched (axis coordinate).
    pub reference: Setpoint,
    /// Motor's own reference (axis coordinate).
    pub motor_reference: MotorReference,
    /// Velocity reference of the velocity loop at its last cycle (axis coordinate).
    pub velocity_reference: f64,
    /// Effort fed forward (motor coordinate).
    pub feedforward: f64,
    /// Effort reference (motor coordinate) and what cut it: the effort limit, or the current limit below it.
    pub effort: velocity::Output,
    /// q-axis current reference (A, peak).
    pub current_reference: f64,
    /// Output of the current loop.
    pub current: current::Output,
}

/// All that a snapshot must hold.
#[derive(Debug, Clone, PartialEq)]
pub struct State {
    delay: delay::State,
    /// Velocity offsets wait with the set-points that they belong to.
    offset_delay: delay::Values,
    velocity: velocity::State,
    current: current::State,
    /// Velocity after the filter (motor coordinate).
    filtered_velocity: f64,
    last_position: Option<f64>,
    closed: Closed,
    position_turn: Countdown,
    velocity_turn: Countdown,
    current_turn: Countdown,
    /// What the position loop asked for at its last cycle (axis coordinate).
    velocity_command: f64,
    held: Held,
}

impl State {
    /// At rest on the set-point `start`.
    ///
    /// # Errors
    /// [`ParameterError`] names the first parameter of `p` that is out of its bound.
    pub fn new(p: &Params, start: Setpoint) -> Result<Self, ParameterError> {
        p.check()?;
        Ok(Self {
            delay: delay::State::new(start),
            offset_delay: delay::Values::new(0.0),
            velocity: velocity::State::default(),
            current: current::State::default(),
            filtered_velocity: 0.0,
            last_position: None,
            closed: Closed::Position,
            position_turn: Countdown::default(),
            velocity_turn: Countdown::default(),
            current_turn: Countdown::default(),
            velocity_command: 0.0,
            held: Held::default(),
        })
    }

    /// Velocity as the velocity loop sees it (axis coordinate).
    #[must_use]
    pub fn velocity(&self, p: &Params) -> f64 {
        p.transmission * self.filtered_velocity
    }

    /// What the position loop would correct now: its reference less the position (axis coordinate).
    #[must_use]
    pub fn following_error(&self, p: &Params, sensors: &Sensors) -> f64 {
        let (reference, motor_reference) = self.references(p);
        match sensors.feedback {
            Feedback::Load(position) => reference.x - position,
            Feedback::Motor => motor_reference.position - p.transmission * sensors.motor_position,
        }
    }

    /// What the loops said at their last turn.
    #[must_use]
    pub const fn held(&self) -> &Held {
        &self.held
    }

    /// The references at the present tick: between two cycles of the position loop the held set-point goes on along its
    /// own polynomial. This is what following errors are measured against; a reference that stands still while the
    /// axis moves on would add an error of velocity × period.
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

/// One base tick: runs the loops that are due and returns what goes to the power stage from now on. The demand is taken
/// at the cycles of the position loop, the limits at those of the velocity loop.
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
                current_loop(params, x, sensors, p.period(*every));
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
    /// Goes over to other loops: what the loops below had gathered stays, unless the power goes off.
    fn close(&mut self, closed: Closed) {
        if closed == Closed::None && self.closed != Closed::None {
            (self.velocity, self.current) = (velocity::State::default(), current::State::default());
            let Held { reference, motor_reference, .. } = self.held;
            self.held = Held { reference, motor_reference, ..Held::default() };
        }
        self.closed = closed;
    }

    /// Without a position loop the reference is where the axis is.
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
    x.held.reference = reference;
    x.held.motor_reference = motor_reference;
    x.held.velocity_reference = p.position_gain * error + p.feedforward.velocity * motor_reference.velocity;
    x.held.feedforward = p.transmission * p.feedforward.effort(setpoint);
}

#[inline(always)]
fn velocity_loop(p: &Params, x: &mut State, limits: EffortLimits, sensors: &Sensors) {
    let h = p.period(p.velocity_every);
    let mut followed = x.held.velocity_reference;
    if x.closed == Closed::Position && p.feedforward.interpolate {
        let fed_forward = |since: f64| {
            let velocity = p.feedforward.motor_reference(x.held.reference.after(since)).velocity;
            x.velocity_command + p.feedforward.velocity * (velocity - x.held.motor_reference.velocity)
        };
        let since = f64::from(x.position_turn.since(p.position_every)) * p.base_rate.period();
        // What is measured is as old as a difference and the filter make it: it is compared with what is as old.
        let age = p.velocity_filter_time + if sensors.motor_velocity.is_some() { 0.0 } else { h / 2.0 };
        followed = fed_forward(since - age);
        x.held.velocity_reference = fed_forward(since);
    }
    let last = x.last_position.replace(sensors.motor_position).unwrap_or(sensors.motor_position);
    let measured = sensors.motor_velocity.unwrap_or((sensors.motor_position - last) / h);
    // Backward Euler of the low-pass: stable for every time constant, and no filter at zero.
    x.filtered_velocity += h / (h + p.velocity_filter_time) * (measured - x.filtered_velocity);
    let input = velocity::Input {
        reference: followed / p.transmission,
        velocity: x.filtered_velocity,
        feedforward: x.held.feedforward,
        available: match &p.stage {
            Stage::Current { params, .. } => params.max_effort(),
            Stage::Direct { .. } => f64::INFINITY,
        },
        limits,
    };
    x.held.effort = match x.closed {
        Closed::Position | Closed::Velocity => velocity::step(&p.velocity, &mut x.velocity, input, h),
        Closed::Effort => velocity::limited(&p.velocity, input.available, limits, input.feedforward),
        Closed::None => velocity::Output::default(),
    };
}

#[inline(always)]
fn current_loop(p: &current::Params, x: &mut State, sensors: &Sensors, h: f64) {
    // The velocity loop keeps to what the current limit leaves; what is cut here is the rounding of the quotient.
    let (wanted, most) = (x.held.effort.effort / p.effort_constant(), p.max_q_current());
    x.held.current_reference = wanted.clamp(-most, most);
    let input = current::Input {
        reference: Dq { d: p.d_reference, q: x.held.current_reference },
        current: sensors.current,
        rotor: sensors
            .known_rotation
            .at(ElectricalAngle::from_mechanical(sensors.motor_position, p.motor.electrical_ratio)),
        omega_e: p.motor.electrical_ratio * x.filtered_velocity,
    };
    x.held.current = current::step(p, &mut x.current, input, h);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::params::tests::{emps, every, synchronous};
    use crate::velocity::Cut;

    const REST: Demand = Demand::position(Setpoint::at_rest(0.0));

    fn at_rest(p: &Params) -> State {
        State::new(p, Setpoint::default()).unwrap()
    }

    /// Oracle: the published control law, u = kv·(kp·e − v) in volts, held between its 1 kHz turns.
    #[test]
    fn a_p_p_cascade_is_the_published_control_law() {
        let (p, mut x) = (emps(), at_rest(&emps()));
        let at = |x: f64| Sensors { motor_position: x, motor_velocity: Some(0.02), ..Sensors::default() };
        let setpoint = Setpoint { x: 8e-4, v: 0.1, ..Setpoint::default() };
        let law = |x: f64| 243.45 * (160.18 * (8e-4 - x) - 0.02);
        for k in 0..32 {
            let position = |k: i32| 5e-4 + 1e-6 * f64::from(k);
            let PowerCommand::Output(u) =
                step(&p, &mut x, &Demand::position(setpoint), EffortLimits::NONE, &at(position(k)))
            else {
                panic!("an ideal amplifier")
            };
            assert!((u - law(position(k / 16 * 16))).abs() < 1e-11, "tick {k}: {u}");
        }
    }

    #[test]
    fn velocity_from_an_encoder_without_one_is_a_difference() {
        let (p, mut x) = (emps(), at_rest(&emps()));
        let mut last = 0.0;
        for k in 0..=32 {
            let position = 0.02 * f64::from(k) / 16_000.0;
            let sensors = Sensors { motor_position: position, ..Sensors::default() };
            if let PowerCommand::Output(u) = step(&p, &mut x, &REST, EffortLimits::NONE, &sensors) {
                last = u;
            }
        }
        assert!((last - 243.45 * (160.18 * -0.02 * 32.0 / 16_000.0 - 0.02)).abs() < 1e-9, "{last}");
    }

    #[test]
    fn references_go_on_between_two_turns_of_the_position_loop() {
        let (p, mut x) = (emps(), at_rest(&emps()));
        for k in 0..40 {
            let setpoint = Setpoint { x: 0.1 * f64::from(k) / 16_000.0, v: 0.1, ..Setpoint::default() };
            step(&p, &mut x, &Demand::position(setpoint), EffortLimits::NONE, &Sensors::default());
            assert!((x.references(&p).0.x - setpoint.x).abs() < 1e-18, "tick {k}");
        }
    }

    /// Oracle: the set-point itself, under a position loop of 1 kHz and a velocity loop of 8 kHz: the velocity of
    /// constant jerk is a parabola. It is as old as what is measured: half a period of the velocity loop of a difference, and
    /// the time of the filter. Switched off it is the staircase of the position loop.
    #[test]
    fn the_velocity_that_is_fed_forward_goes_on_between_cycles_of_the_position_loop() {
        let start = Setpoint { x: 0.0, v: 0.1, a: 3.0, j: -400.0, s: 0.0 };
        let share = 0.75;
        for (interpolate, motor_velocity, filter) in [
            (true, None, 0.0),
            (true, Some(0.0), 0.0),
            (true, Some(0.0), 2e-4),
            (true, None, 3e-4),
            (false, None, 3e-4),
        ] {
            let feedforward = crate::feedforward::Params { velocity: share, interpolate, ..emps().feedforward };
            let velocity_every = every(8_000);
            let p = Params { position_gain: 0.0, velocity_every, velocity_filter_time: filter, feedforward, ..emps() };
            let velocity = velocity::Params { max_effort: f64::INFINITY, ..p.velocity };
            let p = Params { velocity, ..p };
            let age =
                if interpolate { filter + if motor_velocity.is_none() { 1.0 / 16_000.0 } else { 0.0 } } else { 0.0 };
            let mut x = at_rest(&p);
            for k in 0..64_u32 {
                let setpoint = |k: u32| start.after(f64::from(k) / 16_000.0);
                step(
                    &p,
                    &mut x,
                    &Demand::position(setpoint(k)),
                    EffortLimits::NONE,
                    &Sensors { motor_velocity, ..Sensors::default() },
                );
                let cycle = if interpolate { k / 2 * 2 } else { k / 16 * 16 };
                let at = |age: f64| share * start.after(f64::from(cycle) / 16_000.0 - age).v;
                let held = x.held();
                let followed = (held.effort.effort - held.feedforward) / p.velocity.k_p * p.transmission;
                // The effort is some thousand times as large.
                assert!((followed - at(age)).abs() < 1e-12, "{interpolate} tick {k}: {held:?}");
                let expected = at(0.0);
                assert!(
                    (x.held().velocity_reference - expected).abs() < 1e-15,
                    "{interpolate} tick {k}: {:?}",
                    x.held()
                );
            }
        }
    }

    /// Oracle: by hand. On the motor the loop sees r·(motor position) against the motor's reference, on the load the
    /// load's own position against the load's.
    #[test]
    fn the_encoder_that_closes_the_loop_is_the_one_that_is_compared() {
        let p = Params { transmission: 0.5, ..emps() };
        let setpoint = Setpoint::at_rest(3e-3);
        for (feedback, error) in [(Feedback::Motor, 3e-3 - 0.5 * 2e-3), (Feedback::Load(2.5e-3), 3e-3 - 2.5e-3)] {
            let mut x = at_rest(&p);
            step(
                &p,
                &mut x,
                &Demand::position(setpoint),
                EffortLimits::NONE,
                &Sensors { motor_position: 2e-3, feedback, ..Sensors::default() },
            );
            assert!((x.held().velocity_reference - 160.18 * error).abs() < 1e-15, "{feedback:?}: {:?}", x.held());
        }
    }

    /// Oracle: by hand: 9 A, and 1.5·p·ψ·9 A of the motor as the firmware knows it.
    #[test]
    fn a_demand_beyond_the_current_limit_is_cut_and_said() {
        let p = synchronous();
        let held_at = |velocity: f64| {
            let mut x = at_rest(&p);
            let sensors = Sensors { motor_velocity: Some(velocity), ..Sensors::default() };
            step(&p, &mut x, &REST, EffortLimits::NONE, &sensors);
            *x.held()
        };
        for sign in [1.0, -1.0] {
            let held = held_at(-100.0 * sign);
            assert!((held.current_reference - 9.0 * sign).abs() < 1e-14, "{held:?}");
            assert!(held.current_reference.abs() <= 9.0, "not by one rounding more");
            assert!((held.effort.effort - sign * 1.5 * 3.0 * 0.545 * 9.0).abs() < 1e-14, "{held:?}");
            assert_eq!(held.effort.cut, Some(Cut::Available));
        }
        assert_eq!(held_at(-1.0).effort, velocity::Output { effort: 3.0, cut: None });
    }

    /// Oracle: by hand. Without a position loop the velocity demand goes to the velocity loop as it is; an effort goes past
    /// both, within the limit; without power nothing goes out. The reference is where the axis is.
    #[test]
    fn a_demand_closes_the_loops_that_it_names() {
        let p = Params { transmission: 0.5, ..emps() };
        let sensors = Sensors { motor_position: 2e-3, motor_velocity: Some(0.02), ..Sensors::default() };
        let answer = |demand: Demand| {
            let mut x = at_rest(&p);
            let command = step(&p, &mut x, &demand, EffortLimits::NONE, &sensors);
            assert!((x.references(&p).0.x - 1e-3).abs() < 1e-18, "{demand:?}: {:?}", x.held);
            (command, x.held.velocity_reference, x.held.effort)
        };
        let velocity = Demand::Velocity { setpoint: Setpoint { v: 0.03, ..Setpoint::default() }, effort_offset: 7.0 };
        let (_, reference, effort) = answer(velocity);
        assert!((reference - 0.03).abs() < 1e-18);
        assert!((effort.effort - (35.1507 * 243.45 * (0.03 / 0.5 - 0.02) + 7.0)).abs() < 1e-10, "{effort:?}");
        assert_eq!(answer(Demand::Effort(-12.0)).2, velocity::Output { effort: -12.0, cut: None });
        assert_eq!(answer(Demand::Effort(1e3)).2, velocity::Output { effort: 351.507, cut: Some(Cut::Effort) });
        assert_eq!(answer(Demand::Off).0, PowerCommand::Off);
    }

    /// Oracle: a drive that was never off. What the loops had gathered before is gone, and so is the old reference.
    #[test]
    fn a_drive_that_was_off_begins_anew() {
        let p = synchronous();
        let demand = Demand::position(Setpoint::at_rest(1e-3));
        let sensors = |position| Sensors { motor_position: position, motor_velocity: Some(0.0), ..Sensors::default() };
        let (mut x, mut fresh) = (at_rest(&p), at_rest(&p));
        for (demand, position) in [(&demand, 0.0), (&Demand::Off, 9e-4)] {
            for _ in 0..40 {
                step(&p, &mut x, demand, EffortLimits::NONE, &sensors(position));
            }
        }
        assert_eq!((x.velocity, x.held.effort), (velocity::State::default(), velocity::Output::default()));
        step(&p, &mut x, &demand, EffortLimits::NONE, &sensors(9e-4));
        step(&p, &mut fresh, &demand, EffortLimits::NONE, &sensors(9e-4));
        assert_eq!(x.held.effort, fresh.held.effort);
    }
}
