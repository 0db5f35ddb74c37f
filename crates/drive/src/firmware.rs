//! The firmware: position, velocity and current loops in a cascade, each at its own rate.
//!
//! Order of events at a tick: position loop → velocity loop → current loop. A slower loop's output reaches the faster
//! one **in the same tick**; in between it is held. Only the current loop's voltage waits one period of that loop (the
//! time its computation takes). It knows the axis by its sensors and its own estimates, nothing else.
//!
//! Position and its reference are in the axis coordinate, velocity and effort in the motor's; `transmission` converts.
use crate::current;
use crate::delay::DelayLine;
use crate::feedforward::{self, MotorReference};
use crate::velocity;
use servobench_base::{AlphaBeta, Divider, Dq, ElectricalAngle, ParamError, Rate, Setpoint, non_negative, positive};

/// Which encoder closes the position loop.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Feedback {
    /// Motor encoder; the loop follows the motor's own reference.
    Motor,
    /// Load encoder; the loop follows the load's.
    Load,
}

/// What turns the effort reference into effort.
#[derive(Debug, Clone, PartialEq)]
pub enum Stage {
    /// Current loop of a synchronous motor.
    Current {
        /// The loop.
        params: current::Params,
        /// Its period in base ticks.
        every: Divider,
    },
    /// An ideal amplifier: output = effort / gain.
    Direct {
        /// Effort per unit of output, as the firmware knows it (N/V, or 1).
        gain: f64,
    },
}

/// Gains, limits, rates and estimates; constant during a run.
#[derive(Debug, Clone, PartialEq)]
pub struct Params {
    /// Base rate of the run.
    pub base_rate: Rate,
    /// Axis coordinate per motor coordinate (m/rad, or 1).
    pub transmission: f64,
    /// Position gain, K_v (1/s).
    pub position_gain: f64,
    /// Which encoder closes the position loop.
    pub feedback: Feedback,
    /// Period of the position loop in base ticks.
    pub position_every: Divider,
    /// Velocity loop.
    pub velocity: velocity::Params,
    /// Its period in base ticks.
    pub velocity_every: Divider,
    /// Time constant of the low-pass on the measured velocity (s); 0 for none.
    pub velocity_filter_time: f64,
    /// Feedforward.
    pub feedforward: feedforward::Params,
    /// How long the reference waits for the feedforward effort (s).
    pub reference_delay: f64,
    /// Current loop or direct output.
    pub stage: Stage,
}

/// What the sensors say at tick k.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Sensors {
    /// Motor position (motor coordinate).
    pub motor_position: f64,
    /// Motor velocity, where the encoder gives one.
    pub motor_velocity: Option<f64>,
    /// Load position (axis coordinate), where there is an encoder.
    pub load_position: Option<f64>,
    /// Stator current (A, peak).
    pub current: AlphaBeta,
}

/// What goes to the power stage from tick k on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Command {
    /// Stator voltage (V, peak).
    Voltage(AlphaBeta),
    /// Output of an ideal amplifier (V, or the effort itself).
    Output(f64),
}

/// What the loops hold and what a recording shows of them.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Telemetry {
    /// Load-side reference, delay-matched (axis coordinate).
    pub reference: Setpoint,
    /// Motor's own reference (axis coordinate).
    pub motor_reference: MotorReference,
    /// Velocity reference of the velocity loop (axis coordinate).
    pub velocity_reference: f64,
    /// Effort fed forward (motor coordinate).
    pub feedforward: f64,
    /// Effort reference (motor coordinate).
    pub effort_reference: f64,
    /// Whether the effort limit binds.
    pub effort_saturated: bool,
    /// Last output of the current loop.
    pub current: current::Output,
    /// q-axis current reference (A, peak).
    pub current_reference: f64,
}

/// All that a snapshot must hold.
#[derive(Debug, Clone, PartialEq)]
pub struct Firmware {
    params: Params,
    delay: DelayLine,
    velocity: velocity::State,
    current: current::State,
    /// Velocity after the filter (motor coordinate).
    filtered_velocity: f64,
    last_position: Option<f64>,
    /// Base ticks until each loop is due.
    position_in: u32,
    velocity_in: u32,
    current_in: u32,
    telemetry: Telemetry,
    command: Command,
}

impl Params {
    /// # Errors
    /// [`ParamError`] names the first parameter out of its bound, as scenario files call it.
    pub fn check(&self) -> Result<(), ParamError> {
        positive("axis.transmission", self.transmission)?;
        non_negative("drive.position.gain", self.position_gain)?;
        non_negative("drive.velocity.filter_time", self.velocity_filter_time)?;
        non_negative("drive.feedforward.delay", self.reference_delay)?;
        if let Stage::Direct { gain } = self.stage {
            positive("motor.gain", gain)?;
        }
        self.velocity.check()?;
        self.feedforward.check()
    }

    /// How long an effort reference takes to act, which is how long the reference should wait (s): half the position
    /// period that the reference is held for, and the lag of what follows (see [`current`]: 1/α for a ramp, from sample
    /// to sample, so only what the position period exceeds the current period by is held).
    #[must_use]
    pub fn effort_path_delay(&self) -> f64 {
        let tick = self.base_rate.period();
        let position = f64::from(self.position_every.ticks()) * tick;
        match &self.stage {
            Stage::Direct { .. } => position / 2.0,
            Stage::Current { params, every } => {
                let current = f64::from(every.ticks()) * tick;
                (position - current).max(0.0) / 2.0 + params.motor.inductance.q / params.k_p.q
            }
        }
    }
}

impl Firmware {
    /// Firmware at rest on the set-point `start`.
    ///
    /// # Errors
    /// [`ParamError`] names the first parameter out of its bound.
    pub fn new(params: Params, start: Setpoint) -> Result<Self, ParamError> {
        params.check()?;
        let period = f64::from(params.position_every.ticks()) * params.base_rate.period();
        let command = match params.stage {
            Stage::Current { .. } => Command::Voltage(AlphaBeta::default()),
            Stage::Direct { .. } => Command::Output(0.0),
        };
        Ok(Self {
            delay: DelayLine::new(params.reference_delay, period, start)?,
            velocity: velocity::State::default(),
            current: current::State::default(),
            filtered_velocity: 0.0,
            last_position: None,
            position_in: 0,
            velocity_in: 0,
            current_in: 0,
            telemetry: Telemetry::default(),
            command,
            params,
        })
    }

    /// What the loops hold since their last turn.
    #[must_use]
    pub fn telemetry(&self) -> &Telemetry {
        &self.telemetry
    }

    /// The references at the present tick: between two turns of the position loop the held set-point goes on along its
    /// own polynomial. This is what following errors are measured against; a reference that stands still while the
    /// axis moves on would add an error of velocity × period.
    #[inline]
    #[must_use]
    pub fn references(&self) -> (Setpoint, MotorReference) {
        let since = self.params.position_every.ticks() - 1 - self.position_in;
        if since == 0 {
            return (self.telemetry.reference, self.telemetry.motor_reference);
        }
        let now = self.telemetry.reference.after(f64::from(since) * self.params.base_rate.period());
        (now, self.params.feedforward.motor_reference(now))
    }

    /// One base tick: runs the loops that are due and returns what goes to the power stage from now on.
    pub fn step(&mut self, setpoint: Setpoint, sensors: &Sensors) -> Command {
        if due(&mut self.position_in, self.params.position_every) {
            self.position_loop(setpoint, sensors);
        }
        if due(&mut self.velocity_in, self.params.velocity_every) {
            self.velocity_loop(sensors);
        }
        match self.params.stage {
            Stage::Current { params, every } => {
                if due(&mut self.current_in, every) {
                    self.current_loop(&params, every, sensors);
                }
            }
            Stage::Direct { gain } => {
                self.command = Command::Output(self.telemetry.effort_reference / gain);
            }
        }
        self.command
    }

    fn position_loop(&mut self, setpoint: Setpoint, sensors: &Sensors) {
        let p = &self.params;
        let reference = self.delay.push(setpoint);
        let motor_reference = p.feedforward.motor_reference(reference);
        let error = match (p.feedback, sensors.load_position) {
            (Feedback::Load, Some(load)) => reference.x - load,
            _ => motor_reference.position - p.transmission * sensors.motor_position,
        };
        let t = &mut self.telemetry;
        t.reference = reference;
        t.motor_reference = motor_reference;
        t.velocity_reference = p.position_gain * error + p.feedforward.velocity * motor_reference.velocity;
        t.feedforward = p.transmission * p.feedforward.effort(setpoint);
    }

    fn velocity_loop(&mut self, sensors: &Sensors) {
        let p = &self.params;
        let h = f64::from(p.velocity_every.ticks()) * p.base_rate.period();
        let last = self.last_position.replace(sensors.motor_position).unwrap_or(sensors.motor_position);
        let measured = sensors.motor_velocity.unwrap_or((sensors.motor_position - last) / h);
        // Backward Euler of the low-pass: stable for every time constant, and no filter at zero.
        self.filtered_velocity += h / (h + p.velocity_filter_time) * (measured - self.filtered_velocity);
        let t = &mut self.telemetry;
        let input = velocity::Input {
            reference: t.velocity_reference / p.transmission,
            velocity: self.filtered_velocity,
            feedforward: t.feedforward,
        };
        let output = velocity::step(&p.velocity, &mut self.velocity, input, h);
        t.effort_reference = output.effort;
        t.effort_saturated = output.saturated;
    }

    fn current_loop(&mut self, params: &current::Params, every: Divider, sensors: &Sensors) {
        let h = f64::from(every.ticks()) * self.params.base_rate.period();
        let t = &mut self.telemetry;
        t.current_reference = t.effort_reference / params.motor.torque_constant();
        let input = current::Input {
            reference: Dq { d: 0.0, q: t.current_reference },
            current: sensors.current,
            rotor: ElectricalAngle::from_mechanical(sensors.motor_position, params.motor.pole_pairs).rotation(),
            omega_e: params.motor.pole_pairs * self.filtered_velocity,
        };
        t.current = current::step(params, &mut self.current, input, h);
        self.command = Command::Voltage(t.current.voltage);
    }
}

/// Counts down to the next turn of a loop; whether it is now.
fn due(ticks_left: &mut u32, every: Divider) -> bool {
    if *ticks_left == 0 {
        *ticks_left = every.ticks() - 1;
        true
    } else {
        *ticks_left -= 1;
        false
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rate(hz: u32) -> Rate {
        Rate::new(hz).unwrap()
    }

    /// The EMPS axis' controller: u = kv·(kp·e − v), 1 kHz, nothing fed forward.
    fn emps() -> Params {
        let base_rate = rate(16_000);
        let every = base_rate.divider(rate(1_000)).unwrap();
        Params {
            base_rate,
            transmission: 1.0,
            position_gain: 160.18,
            feedback: Feedback::Motor,
            position_every: every,
            velocity: velocity::Params { k_p: 35.1507 * 243.45, integral_time: None, max_effort: 351.507 },
            velocity_every: every,
            velocity_filter_time: 0.0,
            feedforward: feedforward::Params { velocity: 0.0, model: feedforward::Model::Off, coulomb: 0.0, bias: 0.0 },
            reference_delay: 0.0,
            stage: Stage::Direct { gain: 35.1507 },
        }
    }

    /// Oracle: the published control law, u = kv·(kp·e − v) in volts, held between its 1 kHz turns.
    #[test]
    fn a_p_p_cascade_is_the_published_control_law() {
        let mut drive = Firmware::new(emps(), Setpoint::default()).unwrap();
        let at = |x: f64| Sensors { motor_position: x, motor_velocity: Some(0.02), ..Sensors::default() };
        let setpoint = Setpoint { x: 8e-4, v: 0.1, ..Setpoint::default() };
        let law = |x: f64| 243.45 * (160.18 * (8e-4 - x) - 0.02);
        for k in 0..32 {
            let x = 5e-4 + 1e-6 * f64::from(k);
            let Command::Output(u) = drive.step(setpoint, &at(x)) else { panic!("an ideal amplifier") };
            let turn = f64::from(k / 16 * 16);
            assert!((u - law(5e-4 + 1e-6 * turn)).abs() < 1e-11, "tick {k}: {u}");
        }
    }

    #[test]
    fn velocity_from_an_encoder_without_one_is_a_difference() {
        let mut drive = Firmware::new(emps(), Setpoint::default()).unwrap();
        let mut last = 0.0;
        for k in 0..=32 {
            let x = 0.02 * f64::from(k) / 16_000.0;
            let sensors = Sensors { motor_position: x, ..Sensors::default() };
            if let Command::Output(u) = drive.step(Setpoint::default(), &sensors) {
                last = u;
            }
        }
        assert!((last - 243.45 * (160.18 * -0.02 * 32.0 / 16_000.0 - 0.02)).abs() < 1e-9, "{last}");
    }

    #[test]
    fn references_go_on_between_two_turns_of_the_position_loop() {
        let mut drive = Firmware::new(emps(), Setpoint::default()).unwrap();
        for k in 0..40 {
            let setpoint = Setpoint { x: 0.1 * f64::from(k) / 16_000.0, v: 0.1, ..Setpoint::default() };
            let _ = drive.step(setpoint, &Sensors::default());
            assert!((drive.references().0.x - setpoint.x).abs() < 1e-18, "tick {k}");
        }
    }

    #[test]
    fn the_delay_of_the_effort_path_is_half_the_hold() {
        assert!((emps().effort_path_delay() - 0.5e-3).abs() < 1e-15);
    }
}
