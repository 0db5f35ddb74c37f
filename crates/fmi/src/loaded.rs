//! An FMU loaded into this process: the order of calls that the standard demands.
mod batch;
mod instance;
mod redo;
mod session;
mod three;
mod time_event;
mod two;

use crate::archive::Unpacked;
use crate::description::Version;
use crate::error::FmuError;
use crate::feedthrough::Feedthrough;
use crate::setup::Setup;
use crate::slave::{Capabilities, LogLine, Slave, SlaveError, StepEnd};
pub(crate) use instance::Slot;

use instance::Instance;
use redo::Redo;
use std::fmt;
use three::LoadedThree;
use two::LoadedTwo;

/// An FMU loaded into this process and initialised. Dropping it terminates, frees and unloads it.
pub struct Loaded {
    instance: Box<dyn Instance>,
    is_initialising: bool,
    redo: Redo,
    feedthrough: Feedthrough,
    /// The FMU may read its resources at any time: they are dropped after it.
    _unpacked: Unpacked,
}

impl Loaded {
    /// Loads the library, instantiates the FMU and initialises it, or stops within the initialisation if `setup.waits`.
    ///
    /// # Errors
    /// [`FmuError::Setup`], [`FmuError::Library`], [`FmuError::Initialise`]
    pub fn new(unpacked: &Unpacked, setup: &Setup) -> Result<Self, FmuError> {
        let instance: Box<dyn Instance> = match unpacked.description().version {
            Version::Two => Box::new(LoadedTwo::new(unpacked, setup)?),
            Version::Three => Box::new(LoadedThree::new(unpacked, setup)?),
        };
        let feedthrough = Feedthrough::new(unpacked.description(), setup);
        let redo = Redo::new(instance.as_ref(), setup.inputs.len(), setup.outputs.len());
        Ok(Self { instance, is_initialising: setup.waits, redo, feedthrough, _unpacked: unpacked.clone() })
    }

    /// The instance, once started: before the start only reading is allowed.
    fn started(&mut self) -> Result<&mut dyn Instance, SlaveError> {
        if self.is_initialising {
            self.start(None)?;
        }
        Ok(self.instance.as_mut())
    }
}

impl fmt::Debug for Loaded {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Loaded").field("capabilities", &self.instance.capabilities()).finish_non_exhaustive()
    }
}

impl Slave for Loaded {
    fn capabilities(&self) -> Capabilities {
        self.instance.capabilities()
    }

    fn feeds_through(&self, output: usize, input: usize) -> bool {
        self.feedthrough.between(output, input)
    }

    fn is_discrete(&self, output: usize) -> bool {
        self.feedthrough.is_discrete(output)
    }

    fn is_initialising(&self) -> bool {
        self.is_initialising
    }

    fn follows_at_start(&self, output: usize, input: usize) -> bool {
        self.feedthrough.at_start(output, input)
    }

    fn start(&mut self, inputs: Option<&[f64]>) -> Result<(), SlaveError> {
        self.is_initialising = false;
        self.instance.start(inputs)
    }

    fn end(&mut self) {
        self.instance.end();
    }

    fn step(&mut self, time: f64, length: f64, inputs: &[[f64; 3]]) -> Result<StepEnd, SlaveError> {
        self.started()?;
        self.redo.step(self.instance.as_mut(), time, length, inputs)
    }

    fn read(&mut self, inputs: Option<&[f64]>, outputs: &mut [f64]) -> Result<(), SlaveError> {
        if let Some(inputs) = inputs.filter(|_| !self.is_initialising) {
            self.redo.reads(inputs);
        }
        self.instance.read(inputs, outputs)
    }

    fn save(&mut self) -> Result<(), SlaveError> {
        self.started()?.save(Slot::Caller)?;
        self.redo.is_kept(Slot::Caller);
        Ok(())
    }

    fn restore(&mut self) -> Result<(), SlaveError> {
        self.started()?.restore(Slot::Caller)?;
        self.redo.is_kept(Slot::Caller);
        Ok(())
    }

    fn take_log(&mut self) -> Vec<LogLine> {
        self.instance.take_log()
    }
}
