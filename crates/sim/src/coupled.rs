//! FMUs beside the axis: the whole loop is one block of a co-simulation, each FMU another.
//!
//! The axis comes last. At an exchange it gives the bodies and the set-point of that tick, and the outputs of the loops at
//! the previous tick, whose efforts have moved the bodies there. Within a step it takes the mean of an input over each tick
//! for efforts, which are held over it, and its value at the tick for everything else. At the last tick of a run no inputs
//! are taken: its row has those that acted before.
mod block;
mod fit;
mod wiring;

pub use wiring::replaces_the_drive;

use crate::error::{BuildError, UnusableFmu};
use crate::machine::{LOG_EVERY, Machine};
use crate::run::{Failure, Outcome, Reason};
use block::{AttachedFmu, AxisBlock, Part, PartError};
use fit::Misfits;
use servobench_base::Tick;
use servobench_coupling::{Advance, CouplingError, EstimatedError, InputPort, Master, Member, Network};
use servobench_fmi::{FmuEntry, FmuMistake, FmuRequest, Severity, Slave};
use servobench_scenario::Scenario;
use servobench_signals::{Equipment, Rates};
use servobench_trace::CouplingEstimate;
use std::num::NonZeroU32;
use std::ops::ControlFlow;
use wiring::Wiring;

/// Opens the FMUs of a scenario.
pub trait FmuOpener: Sync {
    /// Opens the requested FMU.
    ///
    /// # Errors
    /// All mismatches with its file, or the reason why it cannot be started.
    fn open(&self, request: &FmuRequest<'_>) -> Result<Box<dyn Slave>, Vec<FmuMistake>>;
}

/// An opener for scenarios without FMUs.
#[derive(Debug, Clone, Copy, Default)]
pub struct NoFmus;

impl FmuOpener for NoFmus {
    fn open(&self, _: &FmuRequest<'_>) -> Result<Box<dyn Slave>, Vec<FmuMistake>> {
        Err(vec![FmuMistake::of_file(&"this program opens no FMUs")])
    }
}

/// Axis and FMUs.
pub(crate) struct Coupled {
    /// The axis is the last block.
    master: Master<Part>,
    /// Names of the FMUs.
    names: Vec<String>,
    delays: Vec<ConnectionDelay>,
    doubts: Vec<FmuDoubt>,
}

/// A doubt about an FMU beside the axis.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FmuDoubt {
    /// Index among the scenario's FMUs.
    pub index: usize,
    /// The doubt, and its place.
    pub doubt: FmuMistake,
}

/// A connection and its delay.
#[derive(Debug, Clone, PartialEq)]
pub struct ConnectionDelay {
    /// Source, as `name.variable` or a channel.
    pub from: String,
    /// Destination.
    pub to: String,
    /// Age of the newest value that enters a step, at its end and at most (s).
    pub delay: f64,
    /// The delay in steps of the coupling.
    pub steps: u64,
    /// True if unknown values are extrapolated.
    pub is_extrapolated: bool,
}

impl Coupled {
    /// Couples the axis with the FMUs of `scenario`.
    ///
    /// # Errors
    /// [`BuildError`] names the FMU or the connection.
    pub(crate) fn new(
        scenario: &Scenario,
        mut machine: Machine,
        ticks: u64,
        (equipment, rates): (&Equipment, &Rates),
        fmu_opener: &dyn FmuOpener,
    ) -> Result<Self, BuildError> {
        let wiring = Wiring::new(scenario, equipment, rates)?;
        let end = scenario.base_rate.time(Tick(ticks.saturating_sub(1)));
        let (mut members, mut unusable) = (Vec::new(), Vec::new());
        for (index, fmu) in scenario.fmus.iter().enumerate() {
            let request = wiring.request(index, equipment, ticks);
            let name = fmu.name.clone();
            let slave = match fmu_opener.open(&request) {
                Ok(slave) => slave,
                Err(mistakes) => {
                    unusable.push(UnusableFmu { index, name, mistakes });
                    continue;
                }
            };
            members.push(Member {
                name,
                inputs: request.inputs.into_iter().map(|port| InputPort { name: port.variable, held: 0.0 }).collect(),
                outputs: request.outputs.into_iter().map(|port| port.variable).collect(),
                every: steps(fmu.every, scenario.coupling.step.ticks()),
                block: Part::Fmu(AttachedFmu { slave, end }),
            });
        }
        if !unusable.is_empty() {
            return Err(refused(unusable));
        }
        let Misfits { mistakes, doubts: between } = Misfits::of(scenario, &members, &wiring.connections);
        if !mistakes.is_empty() {
            let name = |index: usize| scenario.fmus[index].name.clone();
            let misfit = |(index, mistake)| UnusableFmu { index, name: name(index), mistakes: vec![mistake] };
            return Err(BuildError::Fmus(mistakes.into_iter().map(misfit).collect()));
        }
        let names: Vec<String> = members.iter().map(|member| member.name.clone()).collect();
        for (index, doubt) in &between {
            machine.axis.note_log_line(
                0.0,
                &format!("FMU {}", names[*index]),
                (Severity::Warning, 0.0),
                &doubt.to_string(),
            );
        }
        let own = members.iter().enumerate().flat_map(|(index, member)| {
            let doubts: &[FmuMistake] = if let Part::Fmu(fmu) = &member.block { fmu.slave.doubts() } else { &[] };
            doubts.iter().map(move |doubt| (index, doubt.clone()))
        });
        let doubts = own.chain(between).map(|(index, doubt)| FmuDoubt { index, doubt }).collect();
        let axis = AxisBlock::new(machine, ticks, wiring.takes.clone(), wiring.gives.clone());
        members.push(Member {
            name: "axis".into(),
            inputs: wiring
                .takes
                .iter()
                .map(|signal| InputPort { name: signal.signal().name().into(), held: 0.0 })
                .collect(),
            outputs: wiring.axis_outputs().map(String::from).collect(),
            every: NonZeroU32::MIN,
            block: Part::Axis(Box::new(axis)),
        });
        let network = Network { members, connections: wiring.connections.clone() };
        let master = Master::new(network, &scenario.coupling).map_err(not_begun)?;
        let delays = master.delays().iter().map(|delay| wiring.described(delay)).collect();
        Ok(Self { master, names, delays, doubts })
    }

    /// Runs to the end.
    pub(crate) fn run(mut self, ticks: u64, progress: &mut dyn FnMut(f64) -> ControlFlow<()>) -> Outcome {
        self.note_logs();
        let (last, mut failure) = (ticks - 1, None);
        let mut exchanges = 0_u64;
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
            exchanges += 1;
            if exchanges.is_multiple_of(LOG_EVERY) {
                self.note_logs();
                failure = failure.or_else(|| self.lost());
            }
            // An exchange may take any time: that is up to the FMUs.
            if failure.is_none() && progress(self.master.tick().0 as f64 / ticks as f64).is_break() {
                failure = Some(Failure { time: self.master.time(), reason: Reason::Stopped });
            }
        }
        // The run is over and cannot be stopped any more.
        let _: ControlFlow<()> = progress(1.0);
        self.finish(failure)
    }

    /// The failure to keep the recording of the axis, if any.
    fn lost(&mut self) -> Option<Failure> {
        let Part::Axis(block) = self.master.block_mut(self.names.len()) else { return None };
        block.machine.check_recording().err()
    }

    /// Records the new log lines of the FMUs. Those of a repeated step are logged again.
    fn note_logs(&mut self) {
        for (index, name) in self.names.iter().enumerate() {
            let Part::Fmu(AttachedFmu { slave, .. }) = self.master.block_mut(index) else { continue };
            let lines = slave.take_log();
            if lines.is_empty() {
                continue;
            }
            let Part::Axis(block) = self.master.block_mut(self.names.len()) else { continue };
            let (source, now) = (format!("FMU {name}"), block.machine.time());
            for line in lines {
                block.machine.axis.note_log_line(now, &source, (line.severity, line.time), &line.words());
            }
        }
    }

    fn finish(mut self, failure: Option<Failure>) -> Outcome {
        for index in 0..self.names.len() {
            if let Part::Fmu(AttachedFmu { slave, .. }) = self.master.block_mut(index) {
                slave.end();
            }
        }
        self.note_logs();
        let coupling = self.estimate();
        let mut machine = self.alone();
        if failure.is_none() {
            machine.observe();
        }
        let mut outcome = machine.finish(failure);
        outcome.recording.coupling = coupling;
        outcome
    }

    /// Error of the exchange so far, and the connection with the largest error.
    fn estimate(&self) -> Option<CouplingEstimate> {
        let EstimatedError { connection, error } = self.master.estimated_error()?;
        let ConnectionDelay { from, to, .. } = &self.delays[connection];
        Some(CouplingEstimate { error, connection: format!("{from} -> {to}") })
    }

    /// The axis without its FMUs.
    pub(crate) fn alone(self) -> Machine {
        let machine = self.master.into_blocks().into_iter().find_map(|part| match part {
            Part::Axis(block) => Some(block.machine),
            Part::Fmu(_) => None,
        });
        let Some(machine) = machine else { unreachable!("the axis is a block of every coupling") };
        machine
    }

    /// Doubts about the FMUs.
    pub(crate) fn doubts(&self) -> &[FmuDoubt] {
        &self.doubts
    }

    /// All connections with their delays.
    pub(crate) fn delays(&self) -> &[ConnectionDelay] {
        &self.delays
    }
}

/// Mistakes in the data take precedence over FMUs that failed before they could report any.
fn refused(mut unusable: Vec<UnusableFmu>) -> BuildError {
    let is_conduct = |mistake: &FmuMistake| mistake.at == FmuEntry::Conduct;
    let wrong = |fmu: &UnusableFmu| !fmu.mistakes.iter().all(is_conduct);
    if !unusable.iter().any(wrong) {
        return BuildError::Broken(unusable);
    }
    unusable.retain(wrong);
    BuildError::Fmus(unusable)
}

/// Error of a failed first exchange: the conduct of an FMU in it is not a mistake in the data.
fn not_begun(error: CouplingError<PartError>) -> BuildError {
    match error {
        CouplingError::Block { source: PartError::Axis(failure), .. } => BuildError::NotBegun(failure.to_string()),
        CouplingError::Block { block, source: PartError::Fmu(error), .. } => {
            BuildError::NotBegun(format!("`{block}`: {error}"))
        }
        CouplingError::Block { source: PartError::Mechanics(error), .. } => error.into(),
        other => BuildError::Coupling(other.to_string()),
    }
}

fn failed(error: CouplingError<PartError>, time: f64) -> Failure {
    match error {
        CouplingError::Block { source: PartError::Axis(failure), .. } => failure,
        // The message states its own time.
        CouplingError::Block { block, source: PartError::Fmu(error), .. } => {
            Failure { time, reason: Reason::Coupling(format!("`{block}`: {error}")) }
        }
        other => Failure { time, reason: Reason::Coupling(other.to_string()) },
    }
}

/// Steps of the coupling in a step of a member; the scenario ensures a whole number.
fn steps(every: u32, of: u32) -> NonZeroU32 {
    NonZeroU32::new(every / of).unwrap_or(NonZeroU32::MIN)
}
