//! Connections between axis and FMUs. The axis comes after the FMUs.
use super::ConnectionDelay;
use super::block::OWN;
use crate::bench::fmu::request;
use crate::error::BuildError;
use servobench_base::Tick;
use servobench_coupling::{Connection, Delay, Order, Port};
use servobench_fmi::FmuRequest;
use servobench_scenario::{InputSource, LoopSignal, Scenario};
use servobench_signals::{Equipment, Rates, Selection};

/// Ports and their connections.
pub(super) struct Wiring<'a> {
    scenario: &'a Scenario,
    /// Used outputs by FMU, each with its signal if it goes to the axis.
    outputs: Vec<Vec<(&'a str, Option<LoopSignal>)>>,
    /// Channels given to FMUs.
    pub(super) gives: Selection,
    /// Signals that the axis takes.
    pub(super) takes: Vec<LoopSignal>,
    pub(super) connections: Vec<Connection>,
}

impl<'a> Wiring<'a> {
    /// # Errors
    /// [`BuildError::NoSuchSignal`]
    pub(super) fn new(scenario: &'a Scenario, equipment: &Equipment, rates: &Rates) -> Result<Self, BuildError> {
        let axis = scenario.fmus.len();
        let all = Selection::all(equipment, rates);
        let (mut outputs, mut given, mut takes) = (vec![Vec::new(); axis], Vec::new(), Vec::new());
        let mut connections = Vec::new();
        let mut connect = |from, to, is_discrete| {
            connections.push(Connection { from, to, gain: 1.0, offset: 0.0, is_discrete });
        };
        for (block, fmu) in scenario.fmus.iter().enumerate() {
            let is_controller = fmu.outputs.iter().any(|(_, signal)| is_of_a_controller(*signal));
            for (port, (variable, signal)) in fmu.inputs.iter().enumerate() {
                let from = match signal {
                    InputSource::Time => Port { block: axis, port: 0 },
                    InputSource::ShaftPosition => Port { block: axis, port: 1 },
                    InputSource::ShaftVelocity => Port { block: axis, port: 2 },
                    InputSource::Signal(signal) if all.has(*signal) => {
                        Port { block: axis, port: OWN.len() + place(&mut given, *signal) }
                    }
                    InputSource::Signal(signal) => {
                        return Err(BuildError::NoSuchSignal {
                            index: block,
                            variable: variable.clone(),
                            signal: *signal,
                            available: all.signals().to_vec(),
                        });
                    }
                    InputSource::Fmu { fmu, variable } => {
                        Port { block: *fmu, port: output(&mut outputs[*fmu], variable, None) }
                    }
                };
                connect(from, Port { block, port }, is_controller);
            }
            for (variable, signal) in &fmu.outputs {
                let from = Port { block, port: output(&mut outputs[block], variable, Some(*signal)) };
                let to = Port { block: axis, port: place(&mut takes, *signal) };
                connect(from, to, is_of_a_controller(*signal));
            }
        }
        Ok(Self { scenario, outputs, gives: all.only(&given), takes, connections })
    }

    /// Request to open FMU number `index` for a run of `ticks`.
    pub(super) fn request(&self, index: usize, equipment: &Equipment, ticks: u64) -> FmuRequest<'a> {
        let (fmu, motion) = (&self.scenario.fmus[index], self.scenario.axis.motor_motion);
        let every = (self.scenario.coupling.step.ticks(), fmu.every);
        let (rate, [before, last]) = (self.scenario.base_rate, last_step(ticks, every));
        let step = rate.time(Tick(last - before));
        // As it is stepped: a sum of times may differ from the time of the tick by rounding.
        let end = rate.time(Tick(last)).max(rate.time(Tick(before)) + step);
        request(fmu, &self.outputs[index], (equipment, motion), (step, end))
    }

    /// Names of the axis outputs.
    pub(super) fn axis_outputs(&self) -> impl Iterator<Item = &str> {
        OWN.into_iter().chain(self.gives.signals().iter().map(|signal| signal.name()))
    }

    /// A connection with its delay.
    pub(super) fn described(&self, delay: &Delay) -> ConnectionDelay {
        let Connection { from, to, .. } = self.connections[delay.connection];
        let of_fmu = |block: usize, variable: &str| format!("{}.{variable}", self.scenario.fmus[block].name);
        ConnectionDelay {
            from: match self.outputs.get(from.block) {
                Some(outputs) => of_fmu(from.block, outputs[from.port].0),
                None => self.axis_outputs().nth(from.port).unwrap_or_default().to_owned(),
            },
            to: match self.scenario.fmus.get(to.block) {
                Some(fmu) => of_fmu(to.block, &fmu.inputs[to.port].0),
                None => self.takes[to.port].signal().name().to_owned(),
            },
            delay: delay.ticks as f64 * self.scenario.base_rate.period(),
            steps: delay.steps,
            is_extrapolated: delay.extrapolated.is_some_and(|order| order != Order::Constant),
        }
    }
}

/// Start and end (ticks) of the last step of an FMU in a run of `ticks`, the last of which is only recorded. Exchanges are whole steps
/// of the `coupling`, and steps of the FMU are `every`, a multiple of them: the last one may end after the run.
fn last_step(ticks: u64, (coupling, every): (u32, u32)) -> [u64; 2] {
    let (coupling, every) = (u64::from(coupling), u64::from(every.max(1)));
    let exchanged = ticks.saturating_sub(1).next_multiple_of(coupling);
    let last = exchanged.next_multiple_of(every).max(every);
    [last - every, last]
}

/// True if an FMU replaces the drive, whose firmware then does not run.
#[must_use]
pub fn replaces_the_drive(scenario: &Scenario) -> bool {
    scenario.fmus.iter().any(|fmu| fmu.outputs.iter().any(|(_, signal)| is_of_a_controller(*signal)))
}

/// True for an output of a controller, which samples at exchanges and holds its outputs.
const fn is_of_a_controller(signal: LoopSignal) -> bool {
    matches!(signal, LoopSignal::Effort | LoopSignal::VoltageD | LoopSignal::VoltageQ)
}

/// Index of the output `variable` among the `wanted` ones, to which it is added if it is missing.
fn output<'a>(wanted: &mut Vec<(&'a str, Option<LoopSignal>)>, variable: &'a str, signal: Option<LoopSignal>) -> usize {
    let known = wanted.iter().position(|(name, _)| *name == variable);
    let at = known.unwrap_or_else(|| {
        wanted.push((variable, None));
        wanted.len() - 1
    });
    wanted[at].1 = wanted[at].1.or(signal);
    at
}

/// Index of `one` in `all`, to which it is added if it is missing.
fn place<T: PartialEq>(all: &mut Vec<T>, one: T) -> usize {
    all.iter().position(|known| *known == one).unwrap_or_else(|| {
        all.push(one);
        all.len() - 1
    })
}
