//! The closed loop, in execution order.
#![expect(clippy::inline_always, reason = "what is inlined is compiled for the registers of its caller")]
mod control;

use crate::disturbance::Disturbances;
use crate::external::{Controller, External};
use crate::loose_sensors::LooseSensors;
use crate::master_at_rest::MasterAtRest;
use crate::network::{Network, Prompt};
use crate::program::Program;
use crate::run::Reason;
pub(crate) use control::{Control, EncoderInput, Mounting};
use servobench_base::state::{Reader, Writer};
use servobench_base::{PowerCommand, Rate, RequestKind, Setpoint, Stateful, Tick};
use servobench_drive::{Demand, EffortLimits};
use servobench_plant::{Actuation, BodyState, EndStops, Input, Mechanics, MechanicsError, PowerStage, Switches};
use servobench_scenario::DisturbedBody;
use servobench_signals::{Instant, PerLimit};
use servobench_trace::Recorder;

/// Parameters and state of a tick.
pub(crate) struct ClosedLoop {
    pub(crate) base_rate: Rate,
    /// True if the motor follows the set-point exactly.
    pub(crate) prescribed: bool,
    pub(crate) mounting: Mounting,
    pub(crate) disturbances: Disturbances,
    /// End stops of the load.
    pub(crate) end_stops: Option<EndStops>,
    /// Limit and home switches, index pulse.
    pub(crate) switches: Switches,
    pub(crate) state: State,
    pub(crate) mechanics: Box<dyn Mechanics>,
}

/// State that changes from tick to tick, without the mechanics.
#[derive(Stateful)]
pub(crate) struct State {
    pub(crate) source: Source,
    /// The tick at which the program began.
    pub(crate) begun: Option<u64>,
    /// The program's set-point of the next tick, if it was looked up already.
    pub(crate) upcoming: Option<Setpoint>,
    #[state(fixed)]
    pub(crate) control: Option<Control>,
    /// The sensors, if an FMU replaces the drive.
    #[state(fixed)]
    pub(crate) sensors: Option<LooseSensors>,
    pub(crate) power: PowerStage,
    /// Position of the motor at the last tick.
    pub(crate) motor_before: f64,
    /// Action of the motor on the mechanics in the current tick.
    pub(crate) shaft: Shaft,
}

/// The effort on the motor over a tick, and the motor's position at its start (its own coordinate).
#[derive(Clone, Copy, Stateful)]
pub(crate) struct Shaft {
    pub(crate) effort: f64,
    pub(crate) position: f64,
}

/// Source of the loops' demand.
#[derive(Stateful)]
#[state(fixed)]
pub(crate) enum Source {
    /// A program, with a set-point at every tick.
    Program(Box<Program>),
    /// A motion task sends it over a fieldbus; the loops follow after this delay (s).
    Network(Box<Network>, #[state(constant)] f64),
    /// A master closes the position loop over a bus, and nothing moves: for linearisation.
    Master(Box<MasterAtRest>),
}

/// Position and its derivatives.
#[inline(always)]
const fn numbers(&Setpoint { x, v, a, j, s }: &Setpoint) -> [f64; 5] {
    [x, v, a, j, s]
}

impl ClosedLoop {
    /// Tick `k` without the mechanics' step to the next one:
    ///
    /// ```text
    /// sample → set-point → control → power stage → disturbances, end stops
    /// ```
    ///
    /// Within control a slower loop's output reaches the faster loop in the same tick; the voltage of the current loop is
    /// applied one period of that loop later. The power stage takes the motor's position and velocity at k, and its mean torque
    /// over the tick drives the mechanics; disturbances and the push of an end stop are held over the tick.
    ///
    /// `now` is that of the previous tick; values that this loop does not write stay as they were.
    #[inline(always)]
    pub(crate) fn tick(&mut self, k: u64, external: &External, recorder: &mut Recorder, now: &mut Instant) {
        if external.start && self.state.begun.is_none() {
            self.state.begun = Some(k);
        }
        now.binds = PerLimit::default();
        let shaft = self.sample(external, now);
        self.account(shaft.position, now);
        let motor = self.mounting.seen(shaft);
        let mut command = self.control(k, external, motor, now, recorder);
        self.ask(k, external, now);
        if let Some(Controller::Voltage(voltage)) = external.controller {
            now.voltage_reference = voltage;
            command = PowerCommand::Voltage(self.state.power.in_the_stator(voltage, motor));
        }
        // The mean effort over the coming tick belongs to the row of this one; the current is the one at k.
        now.current = self.state.power.current();
        now.output = self.state.power.output(command);
        now.effort = match external.controller {
            Some(Controller::Effort(effort)) => effort,
            Some(Controller::Voltage(_)) | None => self.state.power.advance(command, motor, self.base_rate.period()),
        };
        self.state.shaft = Shaft { effort: self.mounting.direction * now.effort, position: shaft.position };
        now.voltage = self.state.power.voltage();
        now.binds.voltage |= self.state.power.shortens_voltage();
        now.motor_disturbance = self.disturbances.effort_at(DisturbedBody::Motor, k) + external.motor_effort;
        now.load_disturbance = self.disturbances.effort_at(DisturbedBody::Load, k) + external.load_effort;
        now.end_stop = self.end_stops.map_or(0.0, |stops| stops.effort(now.load, self.base_rate.period()));
        now.following_error = [now.motor_reference - now.motor.position, now.reference - now.load.position];
    }

    /// sample(k): writes the bodies in the axis coordinate to `now`; returns the motor in its own.
    #[inline(always)]
    pub(crate) fn sample(&self, external: &External, now: &mut Instant) -> BodyState {
        let measured = external.measured.as_ref().map(<[BodyState; 2]>::as_slice);
        let bodies = measured.unwrap_or_else(|| self.mechanics.bodies());
        let own = bodies[0];
        let r = self.mounting.transmission;
        now.motor = BodyState { position: r * own.position, velocity: r * own.velocity };
        now.load = if bodies.len() == 1 { now.motor } else { bodies[bodies.len() - 1] };
        now.table = if bodies.len() == 3 { bodies[1] } else { BodyState::default() };
        own
    }

    /// Writes the powers of the tick that has ended to `now`, with the motor at `position`. At tick 0 they are zero.
    #[inline(always)]
    fn account(&self, position: f64, now: &mut Instant) {
        let Shaft { effort, position: before } = self.state.shaft;
        now.power = self.state.power.power();
        now.temperatures = self.state.power.temperatures();
        now.inverter_loss = self.state.power.inverter_loss();
        now.ripple = self.state.power.ripple();
        (now.dc_link, now.link_power) = self.state.power.link();
        now.alarms.collapsed_link = self.state.power.link_has_collapsed();
        now.shaft_power = effort * (position - before) * f64::from(self.base_rate.hertz());
    }

    /// set-point(k) and control(k): the firmware gets its sensors and its demand. `motor` is in the motor's own
    /// coordinate, as it is mounted.
    #[inline(always)]
    fn control(
        &mut self,
        k: u64,
        external: &External,
        motor: BodyState,
        now: &mut Instant,
        recorder: &mut Recorder,
    ) -> PowerCommand {
        // Until the program begins, it stays at its start.
        let since = self.base_rate.time(Tick(k - self.state.begun.unwrap_or(k)));
        let upcoming = self.state.upcoming.take();
        let bodies = [motor, self.mounting.seen(now.load)];
        let Some(control) = &mut self.state.control else {
            if let Some(sensors) = &mut self.state.sensors {
                sensors.read(bodies, self.mounting, &mut self.state.power, now);
            }
            if let Source::Program(program) = &mut self.state.source {
                now.setpoint = external.setpoint.or(upcoming).unwrap_or_else(|| program.at(since));
            }
            (now.reference, now.motor_reference) = (now.setpoint.x, now.setpoint.x);
            return PowerCommand::Off;
        };
        let sensors = control.measure(bodies, self.mounting, &mut self.state.power, now);
        match &mut self.state.source {
            Source::Program(program) => {
                // As numbers, which stay in registers: a copy would have to wait until they are stored.
                let [x, v, a, j, s] = match (&external.setpoint, &upcoming) {
                    (None, None) => numbers(&program.at(since)),
                    (Some(setpoint), _) | (None, Some(setpoint)) => numbers(setpoint),
                };
                let demand = Demand::position(Setpoint { x, v, a, j, s });
                let command = control.step(&demand, EffortLimits::NONE, &sensors);
                let setpoint = &mut now.setpoint;
                (setpoint.x, setpoint.v, setpoint.a, setpoint.j, setpoint.s) = (x, v, a, j, s);
                let (reference, motor_reference) = control.state.references(&control.params);
                (now.reference, now.motor_reference) = (reference.x, motor_reference.position);
                control.show(self.mounting.direction, [false; 2], now);
                command
            }
            Source::Network(network, _) => {
                let before = std::mem::replace(&mut self.state.motor_before, motor.position);
                let switches =
                    self.switches.read(now.load.position, before, motor.position).in_direction(self.mounting.direction);
                let t = self.base_rate.time(Tick(k));
                let prompt = Prompt { t, program: self.state.begun.map(|_| since), setpoint: external.setpoint };
                let measure = || control.measurement(&sensors, now, switches);
                let (demand, limits) = network.step(k, &prompt, switches.index, measure, recorder);
                let command = control.step(demand, limits, &sensors);
                network.show(t, now);
                control.show(self.mounting.direction, network.cuts_velocity(), now);
                command
            }
            Source::Master(master) => {
                let demand = master.step(control.closing_position(&sensors));
                control.step(&demand, EffortLimits::NONE, &sensors)
            }
        }
    }

    /// request(k): writes the request of the task at tick `k` to `now`.
    #[inline(always)]
    fn ask(&mut self, k: u64, external: &External, now: &mut Instant) {
        let begun = self.state.begun.unwrap_or(k);
        match &mut self.state.source {
            Source::Program(program) => {
                (now.request, now.request_kind) = match external.setpoint {
                    Some(setpoint) => (setpoint, RequestKind::Follow),
                    None => program.request_at(self.base_rate.time(Tick(k - begun)), now.setpoint),
                };
            }
            Source::Network(network, _) => now.ask(network.request(self.base_rate.time(Tick(k)))),
            Source::Master(_) => {}
        }
    }

    /// Reads the sensors for an FMU in place of the drive, with the bodies that `now` has of the next tick.
    pub(crate) fn look_at_sensors(&mut self, now: &mut Instant) {
        let [motor, load] = [self.mounting.seen(self.mechanics.bodies()[0]), self.mounting.seen(now.load)];
        let State { sensors, power, .. } = &mut self.state;
        if let Some(sensors) = sensors {
            sensors.look_ahead([motor, load], self.mounting, power, now);
        }
    }

    /// The program's set-point of the next tick `k`; `None` over a fieldbus.
    pub(crate) fn look_ahead(&mut self, k: u64) -> Option<Setpoint> {
        if let (None, Source::Program(program)) = (self.state.upcoming, &mut self.state.source) {
            self.state.upcoming = Some(program.at(self.base_rate.time(Tick(k - self.state.begun.unwrap_or(k)))));
        }
        self.state.upcoming
    }

    /// Integrates the mechanics to the next tick; does nothing if motor and load are measured outside.
    ///
    /// # Errors
    /// [`Reason`] why the loop cannot continue.
    #[inline(always)]
    pub(crate) fn integrate(&mut self, external: &External, now: &Instant) -> Result<(), Reason> {
        self.check()?;
        if external.measured.is_some() {
            return Ok(());
        }
        let actuation = if self.prescribed {
            Actuation::Motion(now.setpoint)
        } else {
            Actuation::Effort(self.mounting.direction * now.effort)
        };
        self.mechanics.advance(&Input {
            actuation,
            motor_disturbance: now.motor_disturbance,
            load_disturbance: now.load_disturbance + now.end_stop,
        })?;
        Ok(())
    }

    /// Checks that the motion task is running.
    ///
    /// # Errors
    /// [`Reason::Program`] why it gave up.
    #[inline(always)]
    fn check(&mut self) -> Result<(), Reason> {
        match &mut self.state.source {
            Source::Network(network, _) => network.failure().map_or(Ok(()), |reason| Err(Reason::Program(reason))),
            Source::Program(_) | Source::Master(_) => Ok(()),
        }
    }

    /// Writes the state of the loop at the current tick, including its mechanics.
    ///
    /// # Errors
    /// [`MechanicsError`] if the engine cannot save its state.
    pub(crate) fn save(&mut self, to: &mut dyn Writer) -> Result<(), MechanicsError> {
        self.state.save(to);
        self.mechanics.save(to)
    }

    /// Restores the state that [`save`](Self::save) wrote for a loop of the same scenario.
    ///
    /// # Errors
    /// [`MechanicsError`] if the engine cannot restore it, or the numbers are not a state of this loop.
    pub(crate) fn restore(&mut self, from: &mut Reader<'_>) -> Result<(), MechanicsError> {
        self.state.restore(from)?;
        self.mechanics.restore(from)
    }
}
