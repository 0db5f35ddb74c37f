//! Axis and FMUs as blocks of a coupling.
use crate::axis::Saved;
use crate::external::{Controller, External};
use crate::machine::Machine;
use crate::run::Failure;
use servobench_base::{Dq, Setpoint, Tick};
use servobench_coupling::{Block, Input, StepEnd, later, mean, value};
use servobench_fmi::{Slave, SlaveError};
use servobench_plant::MechanicsError;
use servobench_scenario::LoopSignal;
use servobench_signals::Selection;

/// Outputs of the axis before the channels of the recording.
pub(super) const OWN: [&str; 3] = ["time", "shaft.position", "shaft.velocity"];

/// Fraction of a step that counts as rounding of its times.
const ROUNDING: f64 = 1e-9;

/// A part of the coupling.
pub(super) enum Part {
    Axis(Box<AxisBlock>),
    Fmu(AttachedFmu),
}

/// An FMU beside the axis.
pub(super) struct AttachedFmu {
    pub(super) slave: Box<dyn Slave>,
    /// End of the run (s): an FMU that wants to end then or later does not stop it.
    pub(super) end: f64,
}

/// Errors of a part that cannot continue.
#[derive(Debug, thiserror::Error)]
pub(super) enum PartError {
    #[error(transparent)]
    Axis(Failure),
    #[error(transparent)]
    Fmu(SlaveError),
    #[error(transparent)]
    Mechanics(#[from] MechanicsError),
}

/// The axis as a block.
pub(super) struct AxisBlock {
    pub(super) machine: Machine,
    /// Ticks of the run; the last one is observed at the end.
    ticks: u64,
    takes: Vec<LoopSignal>,
    /// Channels given to others after [`OWN`].
    gives: Selection,
    /// True if its state can be saved and restored.
    saves: bool,
    saved: Option<(Tick, Saved)>,
}

impl AxisBlock {
    pub(super) fn new(mut machine: Machine, ticks: u64, takes: Vec<LoopSignal>, gives: Selection) -> Self {
        let saves = machine.axis.closed_loop.mechanics.saves();
        Self { machine, ticks, takes, gives, saves, saved: None }
    }

    /// External influences over a tick that begins `since` (s) after the start of a step.
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

    /// The ticks of the machine within `length` (s), with `inputs` acting over them.
    fn step(&mut self, length: f64, inputs: &[Input]) -> Result<(), Failure> {
        let rate = self.machine.base_rate();
        for tick in 0..rate.tick_at(length).0 {
            if self.machine.next().0 + 1 == self.ticks {
                break;
            }
            self.machine.axis.external = self.external(inputs, rate.time(Tick(tick)), rate.period());
            self.machine.tick()?;
        }
        self.look_ahead();
        Ok(())
    }

    /// Updates the outputs to the next tick: the bodies, the readings of sensors without firmware, and the set-point.
    fn look_ahead(&mut self) {
        let next = self.machine.next();
        let axis = &mut self.machine.axis;
        axis.sample();
        axis.closed_loop.look_at_sensors(&mut axis.now);
        if let Some(setpoint) = axis.closed_loop.look_ahead(next.0) {
            axis.now.setpoint = setpoint;
        }
    }

    fn read(&mut self, outputs: &mut [f64]) {
        self.look_ahead();
        let time = self.machine.time();
        let axis = &self.machine.axis;
        let (own, channels) = outputs.split_at_mut(OWN.len());
        let shaft = axis.closed_loop.mechanics.bodies()[0];
        own.copy_from_slice(&[time, shaft.position, shaft.velocity]);
        if !channels.is_empty() {
            channels.copy_from_slice(self.gives.values(&axis.now));
        }
    }

    fn save(&mut self) -> Result<(), MechanicsError> {
        let (next, time) = (self.machine.next(), self.machine.time());
        self.saved = Some((next, self.machine.axis.save_recorded(time)?));
        Ok(())
    }

    fn restore(&mut self) -> Result<(), MechanicsError> {
        let Some((tick, saved)) = &self.saved else { return Err(MechanicsError::NotSaved) };
        self.machine.axis.restore_recorded(saved)?;
        self.machine.go_back(*tick);
        Ok(())
    }
}

impl Block for Part {
    type Error = PartError;

    fn saves_state(&self) -> bool {
        match self {
            Self::Axis(axis) => axis.saves,
            Self::Fmu(fmu) => fmu.slave.capabilities().saves_state,
        }
    }

    fn feeds_through(&self, output: usize, input: usize) -> bool {
        match self {
            Self::Axis(_) => false,
            Self::Fmu(fmu) => fmu.slave.feeds_through(output, input),
        }
    }

    fn is_discrete(&self, output: usize) -> bool {
        match self {
            Self::Axis(_) => false,
            Self::Fmu(fmu) => fmu.slave.is_discrete(output),
        }
    }

    fn is_single_precision(&self) -> bool {
        match self {
            Self::Axis(_) => false,
            Self::Fmu(fmu) => fmu.slave.is_single_precision(),
        }
    }

    fn has_initial_equations(&self) -> bool {
        match self {
            Self::Axis(_) => false,
            Self::Fmu(fmu) => fmu.slave.is_initialising(),
        }
    }

    fn follows_at_start(&self, output: usize, input: usize) -> bool {
        match self {
            Self::Axis(_) => false,
            Self::Fmu(fmu) => fmu.slave.follows_at_start(output, input),
        }
    }

    fn start(&mut self, inputs: &[f64]) -> Result<(), PartError> {
        match self {
            Self::Axis(_) => Ok(()),
            Self::Fmu(fmu) => fmu.slave.start(Some(inputs)).map_err(PartError::Fmu),
        }
    }

    fn step(&mut self, time: f64, length: f64, inputs: &[Input]) -> Result<StepEnd, PartError> {
        match self {
            Self::Axis(axis) => axis.step(length, inputs).map(|()| StepEnd::Done).map_err(PartError::Axis),
            Self::Fmu(AttachedFmu { slave, end }) => {
                Ok(match slave.step(time, length, inputs).map_err(PartError::Fmu)? {
                    StepEnd::Terminated(time) if time >= *end - ROUNDING * length => StepEnd::Done,
                    other => other,
                })
            }
        }
    }

    fn read(&mut self, inputs: Option<&[f64]>, outputs: &mut [f64]) -> Result<(), PartError> {
        match self {
            Self::Axis(axis) => {
                axis.read(outputs);
                Ok(())
            }
            Self::Fmu(fmu) => fmu.slave.read(inputs, outputs).map_err(PartError::Fmu),
        }
    }

    fn save(&mut self) -> Result<(), PartError> {
        match self {
            Self::Axis(axis) => Ok(axis.save()?),
            Self::Fmu(fmu) => fmu.slave.save().map_err(PartError::Fmu),
        }
    }

    fn restore(&mut self) -> Result<(), PartError> {
        match self {
            Self::Axis(axis) => Ok(axis.restore()?),
            Self::Fmu(fmu) => fmu.slave.restore().map_err(PartError::Fmu),
        }
    }
}
