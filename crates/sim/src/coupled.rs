//! FMUs beside the axis: the whole loop is one block of a co-simulation, each FMU another.
//!
//! The axis comes last. What it gives at an exchange are the bodies and the set-point of that tick, and what the loops said at
//! the tick before, whose efforts have brought the bodies there. What it takes within a step is an input's mean over each tick
//! for efforts, which are held over it, and its value at the tick for everything else. At the last tick of a run nothing is asked
//! for any more: its row has what acted before.
use crate::channels::{Equipment, Instant, Selection, WriterRates};
use crate::error::BuildError;
use crate::recorded::{Recorded, Saved};
use crate::run::{Failure, Outcome, PROGRESS_EVERY, Reason};
use crate::stepper::{Controller, External};
use servobench_base::{Divider, Dq, Setpoint};
use servobench_coupling::{
    Advance, Block, Connection, CouplingError, Delay, Input, InputPort, Iteration, Master, Member, Method, Network,
    Order, Port, Settings, Step, later, mean, value,
};
use servobench_fmi::{LogLine, Progress, Slave, SlaveError};
use servobench_scenario::{CoSimulation, CouplingMethod, Fmu, LoopSignal, Scenario, Signal};
use servobench_trace::Event;
use std::num::NonZeroU32;

/// What the axis gives before channels of the recording.
const OWN: [&str; 3] = ["time", "shaft.position", "shaft.velocity"];

/// A step of one base tick.
const TICK: Divider = Divider::new(1).unwrap();

/// Opens the FMUs of a scenario.
pub trait Partners: Sync {
    /// An initialised FMU that is wired with the ports of `order` and exchanges them in SI.
    ///
    /// # Errors
    /// Why it cannot be had, in words for the user.
    fn open(&self, order: &PartnerOrder<'_>) -> Result<Box<dyn Slave>, String>;
}

/// What is asked of somebody who opens FMUs.
#[derive(Debug)]
pub struct PartnerOrder<'a> {
    /// The FMU.
    pub fmu: &'a Fmu<LoopSignal>,
    /// Its inputs that are connected.
    pub inputs: Vec<&'a str>,
    /// Its outputs that somebody wants.
    pub outputs: Vec<&'a str>,
    /// When the run ends (s).
    pub end: f64,
}

/// Nobody: for scenarios without FMUs.
#[derive(Debug, Clone, Copy, Default)]
pub struct NoPartners;

impl Partners for NoPartners {
    fn open(&self, order: &PartnerOrder<'_>) -> Result<Box<dyn Slave>, String> {
        Err(format!("this program opens no FMUs, and the scenario has `{}`", order.fmu.name))
    }
}

/// Axis and FMUs.
pub(crate) struct Coupled {
    master: Master<Part>,
    names: Vec<String>,
    delays: Vec<ConnectionDelay>,
    /// Base ticks from exchange to exchange.
    every: u64,
}

/// A connection and how late it is.
#[derive(Debug, Clone, PartialEq)]
pub struct ConnectionDelay {
    /// Where from, as `name.variable` or a channel.
    pub from: String,
    /// Where to.
    pub to: String,
    /// Age of the newest value that goes into a step, at its end and at most (s).
    pub delay: f64,
    /// The same in steps of the coupling.
    pub steps: u64,
    /// Whether what is not known yet is extrapolated.
    pub is_extrapolated: bool,
}

enum Part {
    Axis(Box<Axis>),
    Fmu(Box<dyn Slave>),
}

/// Why a part could not go on.
#[derive(Debug, thiserror::Error)]
enum PartError {
    #[error(transparent)]
    Axis(Failure),
    #[error(transparent)]
    Fmu(SlaveError),
    #[error("the engine cannot copy its mechanics, so steps of the axis cannot be repeated")]
    NoCopy,
}

/// The axis as a block.
struct Axis {
    recorded: Recorded,
    /// Ticks of the run: the last one is recorded at the end.
    ticks: u64,
    takes: Vec<LoopSignal>,
    /// What others are given behind the time.
    gives: Selection,
    now: Instant,
    external: External,
    saved: Option<(Saved, Instant, External)>,
}

impl Coupled {
    /// Couples the axis with the FMUs of `scenario`.
    ///
    /// # Errors
    /// [`BuildError`] names the FMU or the connection.
    pub(crate) fn new(
        scenario: &Scenario,
        recorded: Recorded,
        ticks: u64,
        (equipment, rates): (&Equipment, &WriterRates),
        partners: &dyn Partners,
    ) -> Result<Self, BuildError> {
        let wiring = Wiring::of(scenario);
        let end = recorded.closed_loop.base_rate.time(servobench_base::Tick(ticks));
        let mut members = Vec::new();
        for (index, fmu) in scenario.fmus.iter().enumerate() {
            let outputs = wiring.outputs[index].clone();
            let inputs: Vec<&str> = fmu.inputs.iter().map(|(variable, _)| variable.as_str()).collect();
            let order = PartnerOrder { fmu, inputs, outputs, end };
            let slave = partners.open(&order).map_err(|why| BuildError::Fmu { index, why })?;
            members.push(Member {
                name: fmu.name.clone(),
                inputs: order.inputs.iter().map(|name| InputPort { name: (*name).into(), held: 0.0 }).collect(),
                outputs: order.outputs.iter().map(|name| (*name).into()).collect(),
                every: steps(fmu.every, scenario.coupling.every),
                block: Part::Fmu(slave),
            });
        }
        let gives = Selection::new(&wiring.channels, equipment, rates)?;
        let names = members.iter().map(|member| member.name.clone()).collect();
        let (now, _) = recorded.closed_loop.sample(&External::default());
        let takes: Vec<LoopSignal> = wiring.takes.clone();
        let axis = Axis { recorded, ticks, takes, gives, now, external: External::default(), saved: None };
        members.push(Member {
            name: "axis".into(),
            inputs: axis.takes.iter().map(|signal| InputPort { name: signal.name().into(), held: 0.0 }).collect(),
            outputs: OWN.map(String::from).into_iter().chain(wiring.channels.iter().cloned()).collect(),
            every: NonZeroU32::MIN,
            block: Part::Axis(Box::new(axis)),
        });
        let settings = settings(scenario);
        let network = Network { members, connections: wiring.connections, bonds: Vec::new() };
        let master = Master::new(network, &settings).map_err(|error| BuildError::Coupling(error.to_string()))?;
        let delays = Self::describe(&master, scenario);
        Ok(Self { master, names, delays, every: u64::from(scenario.coupling.every) })
    }

    /// Runs to the end.
    pub(crate) fn run(mut self, ticks: u64, progress: &mut dyn FnMut(f64)) -> Outcome {
        let (last, mut told, mut failure) = (ticks - 1, 0, None);
        while failure.is_none() && self.master.tick().0 < last {
            match self.master.advance() {
                Ok(Advance::Done) => {}
                Ok(Advance::Terminated { block, time }) => {
                    let name = self.names.get(block).map_or("axis", String::as_str);
                    failure =
                        Some(Failure { time, reason: Reason::Coupling(format!("`{name}` ended the simulation")) });
                }
                Err(error) => failure = Some(failed(error, self.master.time())),
            }
            if self.master.tick().0 >= told {
                told = self.master.tick().0 + PROGRESS_EVERY.max(self.every);
                progress(self.master.tick().0 as f64 / ticks as f64);
            }
        }
        progress(1.0);
        self.finish(failure)
    }

    fn finish(self, failure: Option<Failure>) -> Outcome {
        let (mut axis, mut said) = (None, Vec::new());
        for (part, name) in self.master.into_blocks().into_iter().zip(self.names.iter().map(Some).chain([None])) {
            match part {
                Part::Axis(block) => axis = Some(block.recorded_to_the_end(failure.is_none())),
                Part::Fmu(mut slave) => {
                    let name = name.map_or("", String::as_str);
                    said.extend(slave.take_log().into_iter().map(|line| (name.to_owned(), line)));
                }
            }
        }
        let Some(mut recorded) = axis else { unreachable!("the axis is a block of every coupling") };
        let t = recorded.time();
        for (name, LogLine { category, message, .. }) in said {
            let message = if category.is_empty() { message } else { format!("{category}: {message}") };
            recorded.recorder.note_event(Event { start: t, end: t, source: format!("FMU {name}"), message });
        }
        recorded.finish(failure)
    }

    /// The axis without its company.
    pub(crate) fn alone(self) -> Recorded {
        let axis = self.master.into_blocks().into_iter().find_map(|part| match part {
            Part::Axis(axis) => Some(axis.recorded),
            Part::Fmu(_) => None,
        });
        let Some(recorded) = axis else { unreachable!("the axis is a block of every coupling") };
        recorded
    }

    /// Every connection with how late it is.
    pub(crate) fn delays(&self) -> &[ConnectionDelay] {
        &self.delays
    }

    fn describe(master: &Master<Part>, scenario: &Scenario) -> Vec<ConnectionDelay> {
        let wiring = Wiring::of(scenario);
        let tick = scenario.base_rate.period();
        let describe = |delay: &Delay| {
            let Connection { from, to, .. } = wiring.connections[delay.connection];
            ConnectionDelay {
                from: wiring.output_name(scenario, from),
                to: wiring.input_name(scenario, to),
                delay: delay.ticks as f64 * tick,
                steps: delay.steps,
                is_extrapolated: delay.extrapolated.is_some_and(|order| order != Order::Constant),
            }
        };
        master.delays().iter().map(describe).collect()
    }
}

fn failed(error: CouplingError<PartError>, time: f64) -> Failure {
    match error {
        CouplingError::Block { source: PartError::Axis(failure), .. } => failure,
        other => Failure { time, reason: Reason::Coupling(other.to_string()) },
    }
}

/// Whether an FMU stands for the drive.
pub(crate) fn replaces_the_drive(scenario: &Scenario) -> bool {
    scenario.fmus.iter().any(|fmu| fmu.outputs.iter().any(|(_, signal)| is_of_a_controller(*signal)))
}

/// Whether a controller gives it, which samples at exchanges and holds what it gives.
const fn is_of_a_controller(signal: LoopSignal) -> bool {
    matches!(signal, LoopSignal::Effort | LoopSignal::VoltageD | LoopSignal::VoltageQ)
}

/// Steps of the coupling in a step of a member; the scenario has seen to it that this is a whole number.
fn steps(every: u32, of: u32) -> NonZeroU32 {
    NonZeroU32::new(every / of.max(1)).unwrap_or(NonZeroU32::MIN)
}

fn settings(scenario: &Scenario) -> Settings {
    let CoSimulation { every, method, extrapolation, tolerance, iterations } = scenario.coupling;
    let iteration = Iteration { relative: tolerance, most: iterations, ..Iteration::default() };
    let order = match extrapolation {
        0 => Order::Constant,
        1 => Order::Linear,
        _ => Order::Quadratic,
    };
    Settings {
        base_rate: scenario.base_rate,
        step: Divider::new(every).unwrap_or(TICK),
        method: match method {
            CouplingMethod::Jacobi => Method::Jacobi,
            CouplingMethod::GaussSeidel => Method::GaussSeidel((0..=scenario.fmus.len()).collect()),
            CouplingMethod::Iterated => Method::Iterated(iteration),
        },
        order,
        algebraic: Some(iteration),
        watch: true,
    }
}

/// Which ports are connected. The axis comes behind the FMUs.
struct Wiring<'a> {
    /// By FMU: outputs that somebody wants.
    outputs: Vec<Vec<&'a str>>,
    /// Channels that FMUs are given.
    channels: Vec<String>,
    /// What the axis takes.
    takes: Vec<LoopSignal>,
    connections: Vec<Connection>,
}

impl<'a> Wiring<'a> {
    fn of(scenario: &'a Scenario) -> Self {
        let axis = scenario.fmus.len();
        let mut wiring =
            Self { outputs: vec![Vec::new(); axis], channels: Vec::new(), takes: Vec::new(), connections: Vec::new() };
        let mut connect = |from, to, is_discrete| {
            wiring.connections.push(Connection { from, to, gain: 1.0, offset: 0.0, is_discrete });
        };
        for (block, fmu) in scenario.fmus.iter().enumerate() {
            let is_controller = fmu.outputs.iter().any(|(_, signal)| is_of_a_controller(*signal));
            for (port, (_, signal)) in fmu.inputs.iter().enumerate() {
                let from = match signal {
                    Signal::Time => Port { block: axis, port: 0 },
                    Signal::ShaftPosition => Port { block: axis, port: 1 },
                    Signal::ShaftVelocity => Port { block: axis, port: 2 },
                    Signal::Channel(name) => {
                        Port { block: axis, port: OWN.len() + place(&mut wiring.channels, (*name).into()) }
                    }
                    Signal::Fmu { fmu, variable } => {
                        Port { block: *fmu, port: place(&mut wiring.outputs[*fmu], variable.as_str()) }
                    }
                };
                connect(from, Port { block, port }, is_controller);
            }
            for (variable, signal) in &fmu.outputs {
                let from = Port { block, port: place(&mut wiring.outputs[block], variable.as_str()) };
                let to = Port { block: axis, port: place(&mut wiring.takes, *signal) };
                connect(from, to, is_of_a_controller(*signal));
            }
        }
        wiring
    }

    fn output_name(&self, scenario: &Scenario, Port { block, port }: Port) -> String {
        match scenario.fmus.get(block) {
            Some(fmu) => format!("{}.{}", fmu.name, self.outputs[block][port]),
            None => OWN.get(port).map_or_else(|| self.channels[port - OWN.len()].clone(), |name| (*name).into()),
        }
    }

    fn input_name(&self, scenario: &Scenario, Port { block, port }: Port) -> String {
        match scenario.fmus.get(block) {
            Some(fmu) => format!("{}.{}", fmu.name, fmu.inputs[port].0),
            None => self.takes[port].name().into(),
        }
    }
}

/// Where `one` is among `all`, to which it is added if need be.
fn place<T: PartialEq>(all: &mut Vec<T>, one: T) -> usize {
    all.iter().position(|known| *known == one).unwrap_or_else(|| {
        all.push(one);
        all.len() - 1
    })
}

impl Axis {
    /// What acts over a tick that begins `since` a step's start (s).
    fn external(&self, inputs: &[Input], since: f64, tick: f64) -> External {
        let mut external = External::default();
        let mut setpoint = None;
        let mut voltage = None;
        for (signal, input) in self.takes.iter().zip(inputs) {
            let (now, held) = (value(input, since), mean(&later(input, since), tick));
            match signal {
                LoopSignal::MotorEffort => external.motor_effort = held,
                LoopSignal::LoadEffort => external.load_effort = held,
                LoopSignal::SetpointPosition => setpoint.get_or_insert_with(Setpoint::default).x = now,
                LoopSignal::SetpointVelocity => setpoint.get_or_insert_with(Setpoint::default).v = now,
                LoopSignal::SetpointAcceleration => setpoint.get_or_insert_with(Setpoint::default).a = now,
                LoopSignal::Effort => external.controller = Some(Controller::Effort(held)),
                LoopSignal::VoltageD => voltage.get_or_insert_with(Dq::default).d = now,
                LoopSignal::VoltageQ => voltage.get_or_insert_with(Dq::default).q = now,
            }
        }
        external.setpoint = setpoint;
        external.controller = external.controller.or(voltage.map(Controller::Voltage));
        external
    }

    /// The bodies and the set-point of the tick that comes.
    fn look(&mut self) {
        let (bodies, _) = self.recorded.closed_loop.sample(&External::default());
        (self.now.motor, self.now.table, self.now.load) = (bodies.motor, bodies.table, bodies.load);
        if let Some(setpoint) = self.recorded.closed_loop.look_ahead(self.recorded.tick) {
            self.now.setpoint = setpoint;
        }
    }

    /// The loop with its last tick recorded.
    fn recorded_to_the_end(self, is_complete: bool) -> Recorded {
        let Self { mut recorded, external, .. } = self;
        if is_complete {
            recorded.observe(&external);
        }
        recorded
    }
}

impl Block for Part {
    type Error = PartError;

    fn saves_state(&self) -> bool {
        match self {
            Self::Axis(axis) => axis.recorded.closed_loop.copy().is_some(),
            Self::Fmu(slave) => slave.capabilities().saves_state,
        }
    }

    fn feeds_through(&self, output: usize, input: usize) -> bool {
        match self {
            Self::Axis(_) => false,
            Self::Fmu(slave) => slave.feeds_through(output, input),
        }
    }

    fn step(&mut self, time: f64, length: f64, inputs: &[Input]) -> Result<Step, PartError> {
        let axis = match self {
            Self::Axis(axis) => axis,
            Self::Fmu(slave) => {
                return Ok(match slave.step(time, length, inputs).map_err(PartError::Fmu)? {
                    Progress::Done => Step::Done,
                    Progress::Until(time) => Step::Until(time),
                    Progress::Terminated(time) => Step::Terminated(time),
                });
            }
        };
        let rate = axis.recorded.closed_loop.base_rate;
        for tick in 0..rate.tick_at(length).0 {
            if axis.recorded.tick + 1 == axis.ticks {
                break;
            }
            axis.external = axis.external(inputs, rate.time(servobench_base::Tick(tick)), rate.period());
            axis.now = axis.recorded.observe(&axis.external);
            axis.recorded.go_on(&axis.now).map_err(PartError::Axis)?;
        }
        axis.look();
        Ok(Step::Done)
    }

    fn read(&mut self, inputs: Option<&[f64]>, outputs: &mut [f64]) -> Result<(), PartError> {
        match self {
            Self::Axis(axis) => {
                axis.look();
                let (own, channels) = outputs.split_at_mut(OWN.len());
                let shaft = axis.recorded.closed_loop.mechanics.bodies()[0];
                own.copy_from_slice(&[axis.recorded.time(), shaft.position, shaft.velocity]);
                if !channels.is_empty() {
                    channels.copy_from_slice(axis.gives.pick(&axis.now));
                }
                Ok(())
            }
            Self::Fmu(slave) => slave.read(inputs, outputs).map_err(PartError::Fmu),
        }
    }

    fn save(&mut self) -> Result<(), PartError> {
        match self {
            Self::Axis(axis) => {
                let saved = axis.recorded.save().ok_or(PartError::NoCopy)?;
                axis.saved = Some((saved, axis.now, axis.external));
                Ok(())
            }
            Self::Fmu(slave) => slave.save().map_err(PartError::Fmu),
        }
    }

    fn restore(&mut self) -> Result<(), PartError> {
        match self {
            Self::Axis(axis) => {
                let Some((saved, now, external)) = &axis.saved else { return Err(PartError::NoCopy) };
                axis.recorded.restore(saved);
                (axis.now, axis.external) = (*now, *external);
                Ok(())
            }
            Self::Fmu(slave) => slave.restore().map_err(PartError::Fmu),
        }
    }
}
