//! The engine `fmu`, and FMUs beside an axis.
use crate::mechanics::{FmuMechanics, NAME};
use crate::open::open;
use servobench_base::{ParamError, finite, positive};
use servobench_fmi::{FmuEntry, FmuMistake, FmuRequest, Slave};
use servobench_isolation::Program as HostCommand;
use servobench_plant::{Drive, Engine, EngineName, FmuModel, Mechanics, MechanicsError, MechanicsSetup, Model};
use std::io;

/// The engine `fmu`: an FMU as the mechanics.
#[derive(Debug, Clone, Copy)]
pub struct Fmu {
    /// The program that runs isolated FMUs.
    pub host: fn() -> io::Result<HostCommand>,
    /// Permission to run code of FMUs.
    pub code: Code,
}

/// Permission to run code of FMUs. It is set by the caller of the program, never by a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Code {
    /// None: FMUs are only described, and take no step.
    #[default]
    None,
    /// In a separate process.
    Isolated,
    /// As the scenario has it, in this process too.
    Anywhere,
}

impl Fmu {
    /// The mechanics at tick 0.
    ///
    /// # Errors
    /// [`MechanicsError`]; [`MechanicsError::Fmu`] lists every mismatch with the FMU.
    pub fn mechanics(&self, setup: &MechanicsSetup) -> Result<FmuMechanics, MechanicsError> {
        setup.check()?;
        let Model::Fmu(model) = &setup.model else {
            return Err(MechanicsError::not_simulated(NAME, &setup.model));
        };
        if setup.drive == Drive::Prescribed {
            return Err(MechanicsError::Unsupported {
                engine: NAME,
                what: "a prescribed motion".into(),
                help: "drive the FMU by efforts, or describe the axis by its bodies".into(),
            });
        }
        check(model)?;
        let request = FmuRequest {
            file: &model.file,
            name: None,
            inputs: model.inputs().cloned().collect(),
            outputs: model.outputs().cloned().collect(),
            step: f64::from(model.ticks) * setup.step,
            end: None,
            // Nothing acts before the first tick: inputs keep the FMU's start values.
            waits: false,
        };
        let slave = self.open(&request).map_err(|mistakes| refused(model, mistakes))?;
        FmuMechanics::new(slave, model, setup.step)
    }

    /// The FMU, initialised and wired, with its numbers in SI units. If no code may run, all its outputs are zero.
    ///
    /// # Errors
    /// All mismatches with the FMU, or the reason why it cannot be started.
    pub fn open(&self, request: &FmuRequest<'_>) -> Result<Box<dyn Slave>, Vec<FmuMistake>> {
        open(request, self.code, self.host)
    }
}

impl Engine for Fmu {
    fn name(&self) -> EngineName {
        NAME
    }

    fn build(&self, setup: &MechanicsSetup) -> Result<Box<dyn Mechanics>, MechanicsError> {
        Ok(Box::new(self.mechanics(setup)?))
    }
}

/// The mistakes in the data, or the FMU's failure, as an error.
fn refused(model: &FmuModel, mistakes: Vec<FmuMistake>) -> MechanicsError {
    let path = model.file.path.clone();
    match mistakes.iter().find(|mistake| mistake.at == FmuEntry::Conduct) {
        Some(conduct) => MechanicsError::Native { engine: NAME, message: format!("`{}`: {conduct}", path.display()) },
        None => MechanicsError::Fmu { engine: NAME, path, mistakes },
    }
}

fn check(model: &FmuModel) -> Result<(), ParamError> {
    positive("ticks", f64::from(model.ticks))?;
    finite("transmission", model.transmission)?;
    Ok(())
}
