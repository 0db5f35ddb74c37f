//! Loading an FMU, into this process or an isolated one.
use crate::error::{HostError, IsolationError};
use crate::host::{note_call, say_at_once, serve};
use crate::isolated::{Isolated, Known, Wires};
use crate::order::Order;
use servobench_fmi::{Bounds, Feedthrough, FmuError, Loaded, Setup, Slave, Unpacked, note_calls, send_log_lines_to};
use servobench_isolation::Program as HostCommand;
use thiserror::Error;

/// Place where an FMU runs.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Place {
    /// In this process, if it is trusted.
    Here,
    /// In a separate process.
    Process {
        /// The program, which calls [`host`].
        command: HostCommand,
        /// Its limits.
        bounds: Bounds,
    },
}

impl LoadError {
    /// True if the failure is one of the run, not a refusal: it crashed, hung or the process could not start.
    #[must_use]
    pub const fn is_of_the_run(&self) -> bool {
        match self {
            Self::Fmu(_) | Self::Isolation(IsolationError::Refused(_)) => false,
            Self::Isolation(_) => true,
        }
    }
}

/// Reason why an FMU cannot be used.
#[derive(Debug, Error)]
pub enum LoadError {
    /// In this process.
    #[error(transparent)]
    Fmu(#[from] FmuError),
    /// In a separate process.
    #[error(transparent)]
    Isolation(#[from] IsolationError),
}

/// Loads and initialises an FMU at its place. Its unpacked files stay as long as it lives.
///
/// # Errors
/// [`LoadError`]
pub fn load(fmu: &Unpacked, setup: &Setup, place: &Place) -> Result<Box<dyn Slave>, LoadError> {
    match place {
        Place::Here => Ok(Box::new(Loaded::new(fmu, setup)?)),
        Place::Process { command, bounds } => {
            // Mistakes are reported better from here, before anything is started.
            setup.check(fmu)?;
            let wires = Wires { inputs: setup.inputs.len(), outputs: setup.outputs.len() };
            let feedthrough = Feedthrough::new(fmu.description(), setup);
            let known = Known { feedthrough, waits: setup.waits, _unpacked: fmu.clone() };
            Ok(Box::new(Isolated::start_known(command, &Order::new(fmu, setup), wires, *bounds, Some(known))?))
        }
    }
}

/// Makes this process the host of one FMU, for the program of [`Place::Process`]. See [`serve`].
///
/// # Errors
/// [`HostError`] if this process was not started as a host.
pub fn host() -> Result<(), HostError> {
    send_log_lines_to(say_at_once);
    note_calls(note_call);
    serve(|order: Order| order.load().map_err(|error| error.to_string()))
}
