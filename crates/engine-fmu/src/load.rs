//! An FMU, here or in a process of its own.
use crate::error::{HostError, IsolationError};
use crate::host::{say_at_once, serve};
use crate::isolated::{Bounds, Isolated, Wires};
use crate::keeper::HostCommand;
use crate::order::Order;
use servobench_fmi::{
    Capabilities, Feedthrough, FmuError, Loaded, LogLine, Progress, Setup, Slave, SlaveError, Unpacked, hear_at_once,
};
use thiserror::Error;

/// Where an FMU runs.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Place {
    /// In this process: it is trusted.
    Here,
    /// In a process of its own.
    Process {
        /// The program, which calls [`host`].
        command: HostCommand,
        /// What it may take.
        bounds: Bounds,
    },
}

/// Why an FMU cannot be used.
#[derive(Debug, Error)]
pub enum LoadError {
    /// In this process.
    #[error(transparent)]
    Fmu(#[from] FmuError),
    /// In a process of its own.
    #[error(transparent)]
    Isolation(#[from] IsolationError),
}

/// Loads and initialises an FMU at its place. What it was unpacked to stays as long as it lives.
///
/// # Errors
/// [`LoadError`]
pub fn load(fmu: &Unpacked, setup: &Setup, place: &Place) -> Result<Box<dyn Slave>, LoadError> {
    match place {
        Place::Here => Ok(Box::new(Loaded::new(fmu, setup)?)),
        Place::Process { command, bounds } => {
            // What is wrong with it is better said here, before anything is started.
            setup.check(fmu)?;
            let wires = Wires { inputs: setup.inputs.len(), outputs: setup.outputs.len() };
            let slave = Isolated::start(command, &Order::new(fmu, setup), wires, *bounds)?;
            let feedthrough = Feedthrough::new(fmu.description(), setup);
            Ok(Box::new(Kept { slave, feedthrough, _fmu: fmu.clone() }))
        }
    }
}

/// Makes this process the host of one FMU: what the program of [`Place::Process`] does. See [`serve`].
///
/// # Errors
/// [`HostError`] if nobody has started this process as a host.
pub fn host() -> Result<(), HostError> {
    hear_at_once(say_at_once);
    serve(|order: Order| order.load().map_err(|error| error.to_string()))
}

/// An FMU in a process of its own, and the folder that it was unpacked to, which goes after it.
struct Kept {
    slave: Isolated,
    feedthrough: Feedthrough,
    _fmu: Unpacked,
}

impl Slave for Kept {
    fn capabilities(&self) -> Capabilities {
        self.slave.capabilities()
    }

    fn feeds_through(&self, output: usize, input: usize) -> bool {
        self.feedthrough.between(output, input)
    }

    fn step(&mut self, time: f64, length: f64, inputs: &[[f64; 3]]) -> Result<Progress, SlaveError> {
        self.slave.step(time, length, inputs)
    }

    fn read(&mut self, inputs: Option<&[f64]>, outputs: &mut [f64]) -> Result<(), SlaveError> {
        self.slave.read(inputs, outputs)
    }

    fn save(&mut self) -> Result<(), SlaveError> {
        self.slave.save()
    }

    fn restore(&mut self) -> Result<(), SlaveError> {
        self.slave.restore()
    }

    fn take_log(&mut self) -> Vec<LogLine> {
        self.slave.take_log()
    }
}
