//! The closed loop, in execution order.
use crate::bench::{Bench, Control, Source};
use crate::channels::Instant;
use crate::limit_watch::PerLimit;
use crate::network::Seen;
use servobench_base::Tick;
use servobench_drive::velocity::Cut;
use servobench_drive::{self as drive, Command, Demand, Feedback, Sensors};
use servobench_plant::{Actuation, BodyState, Input, MechanicsError};
use servobench_scenario::DisturbedBody;
use servobench_trace::Recording;

/// What a run leaves behind.
#[derive(Debug, Clone, PartialEq)]
pub struct Outcome {
    /// Everything up to the end, or up to the failure: every tick, whatever `record.rate` says ([`thinned`](crate::thinned)),
    /// unless that would not fit in memory.
    pub recording: Recording,
    /// Why the run ended early.
    pub failure: Option<Failure>,
}

/// Why a run ended early.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("at {time} s: {reason}")]
pub struct Failure {
    /// When (s).
    pub time: f64,
    /// Why.
    pub reason: Reason,
}

/// What ended a run early.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Reason {
    /// What the engine says.
    #[error(transparent)]
    Mechanics(#[from] MechanicsError),
    /// What the program waited for in vain.
    #[error("{0}")]
    Program(String),
}

/// How often a run reports its progress, in ticks.
const PROGRESS_EVERY: u64 = 1 << 14;

impl Bench {
    /// Runs to the end; `progress` hears the share that is done, from 0 to 1.
    ///
    /// ```text
    /// tick k:  sample → set-point → control → power stage → record → integrate to k+1
    /// ```
    ///
    /// What is recorded together belongs to the same instant. Within control a slower loop's output reaches the faster
    /// loop in the same tick; the voltage of the current loop goes out one period of that loop later. The power stage
    /// takes the motor's position and velocity at k, and its mean torque over the tick drives the mechanics; a disturbance
    /// is held over the tick.
    #[must_use]
    pub fn run(mut self, progress: &mut dyn FnMut(f64)) -> Outcome {
        let (mut t, mut failure) = (0.0, None);
        for k in 0..self.ticks {
            t = self.base_rate.time(Tick(k));

            let (mut now, motor) = self.sample();
            let command = self.control(k, t, motor, &mut now);
            // The mean effort over the coming tick belongs into the row of this one; the current is the one at k.
            now.current = self.power.current();
            now.output = self.power.output(command);
            now.effort = self.power.advance(command, motor, self.base_rate.period());
            now.binds.voltage |= self.power.shortens_voltage();
            self.watch.tick(t, now.binds, &mut self.recorder);
            now.motor_disturbance = self.disturbances.effort_at(DisturbedBody::Motor, k);
            now.load_disturbance = self.disturbances.effort_at(DisturbedBody::Load, k);
            self.record(&mut now);
            if k % PROGRESS_EVERY == 0 {
                progress(k as f64 / self.ticks as f64);
            }
            if k + 1 == self.ticks {
                break;
            }
            if let Source::Network(network, _) = &mut self.source
                && let Some(reason) = network.failure()
            {
                failure = Some(Failure { time: t, reason: Reason::Program(reason) });
                break;
            }
            if let Err(error) = self.integrate(&now) {
                failure = Some(Failure { time: t, reason: Reason::Mechanics(error) });
                break;
            }
        }
        self.watch.finish(t, &mut self.recorder);
        if let Source::Network(network, delay) = &mut self.source {
            let unit = self.recorder.about().axis_unit.clone();
            network.finish(t, &unit, *delay, &mut self.recorder);
        }
        progress(1.0);
        Outcome { recording: self.recorder.finish(), failure }
    }

    /// sample(k): the bodies in the axis coordinate, and the motor in its own.
    fn sample(&self) -> (Instant, BodyState) {
        let bodies = self.mechanics.bodies();
        let own = bodies[0];
        let motor =
            BodyState { position: self.transmission * own.position, velocity: self.transmission * own.velocity };
        let load = if bodies.len() == 1 { motor } else { bodies[bodies.len() - 1] };
        let table = if bodies.len() == 3 { bodies[1] } else { BodyState::default() };
        (Instant { motor, table, load, ..Instant::default() }, own)
    }

    /// set-point(k) and control(k): the firmware sees its sensors and what it is to do. `motor` is in the motor's own
    /// coordinate.
    fn control(&mut self, k: u64, t: f64, motor: BodyState, now: &mut Instant) -> Command {
        let Some(control) = &mut self.control else {
            if let Source::Program(program) = &mut self.source {
                now.setpoint = program.at(t);
            }
            now.reference = now.setpoint.x;
            now.motor_reference = now.setpoint.x;
            return Command::Output(0.0);
        };
        let reading = control.motor_encoder.read(motor.position, motor.velocity);
        let sensors = Sensors {
            motor_position: reading.position,
            motor_velocity: reading.velocity,
            feedback: match control.load_encoder {
                None => Feedback::Motor,
                Some(encoder) => Feedback::Load(encoder.read(now.load.position, now.load.velocity).position),
            },
            current: self.power.measured_current(motor),
        };
        let Control { params, state, .. } = control;
        let command = match &mut self.source {
            Source::Program(program) => {
                now.setpoint = program.at(t);
                let command = drive::step(params, state, &Demand::position(now.setpoint), &sensors);
                let (reference, motor_reference) = state.references(params);
                (now.reference, now.motor_reference) = (reference.x, motor_reference.position);
                command
            }
            Source::Network(network, _) => {
                let switches = self.switches.read(now.load.position, self.motor_before, motor.position);
                self.motor_before = motor.position;
                let see = || Seen {
                    position: sensors.closing_position(),
                    velocity: state.velocity(params),
                    effort: state.held().effort.effort,
                    effort_is_cut: state.held().effort.cut.is_some(),
                    following_error: state.following_error(params, &sensors),
                    switches,
                };
                let demand = network.step(k, t, switches.index, see, &mut self.recorder);
                let command = drive::step(params, state, demand, &sensors);
                now.setpoint = network.setpoint(now.motor.position);
                (now.task, now.bus_position) = network.told();
                (now.reference, now.motor_reference) = match network.reference(t) {
                    Some((reference, motor)) => (reference.x, motor.position),
                    None => (now.load.position, now.motor.position),
                };
                command
            }
        };
        let held = state.held();
        now.velocity_reference = held.velocity_reference;
        now.effort_reference = held.effort.effort;
        now.current_reference = held.current_reference;
        now.voltage = held.current.computed;
        now.binds = PerLimit {
            voltage: held.current.saturated,
            current: held.effort.cut == Some(Cut::Available),
            effort: held.effort.cut == Some(Cut::Effort),
        };
        command
    }

    /// record(k), when a row is due.
    fn record(&mut self, now: &mut Instant) {
        if self.ticks_to_row == 0 {
            self.ticks_to_row = self.record_every;
            now.saturation = self.watch.shares();
            self.recorder.push(self.selection.pick(now));
        }
        self.ticks_to_row -= 1;
    }

    /// Integrates the mechanics to k+1.
    fn integrate(&mut self, now: &Instant) -> Result<(), MechanicsError> {
        let actuation = if self.prescribed { Actuation::Motion(now.setpoint) } else { Actuation::Effort(now.effort) };
        self.mechanics.advance(&Input {
            actuation,
            motor_disturbance: now.motor_disturbance,
            load_disturbance: now.load_disturbance,
        })
    }
}
