//! The engine `fmu`, and FMUs beside an axis.
use crate::mechanics::{FmuMechanics, NAME};
use crate::open::open;
use servobench_base::{ParamError, finite, positive};
use servobench_fmi::{FmuEntry, FmuMistake, FmuRequest, Slave};
use servobench_isolation::Program as HostCommand;
use servobench_plant::{Drive, Engine, EngineName, FmuModel, Mechanics, MechanicsError, MechanicsSetup, Model};
use std::io;

/// The engine `fmu`: the mechanics are an FMU.
#[derive(Debug, Clone, Copy)]
pub struct Fmu {
    /// The program that an FMU runs in if it is isolated.
    pub host: fn() -> io::Result<HostCommand>,
    /// Which code of FMUs runs.
    pub code: Code,
}

/// Which code of FMUs runs. It is whoever starts the program that says so, and nothing in a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Code {
    /// None: an FMU is what its description says, and takes no step.
    #[default]
    None,
    /// In a process of its own.
    Isolated,
    /// Where the scenario says, in this process too.
    Anywhere,
}

impl Fmu {
    /// The mechanics at tick 0.
    ///
    /// # Errors
    /// [`MechanicsError`]; [`MechanicsError::Fmu`] has everything that does not fit the file.
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
            // Nothing acts before the first tick: its inputs begin as the FMU has them.
            waits: false,
        };
        let slave = self.open(&request).map_err(|mistakes| refused(model, mistakes))?;
        FmuMechanics::new(slave, model, setup.step)
    }

    /// The FMU, initialised and wired; its numbers are SI numbers. Where no code runs, all its outputs are zero.
    ///
    /// # Errors
    /// Everything that does not fit the file, or why it cannot be started.
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

/// What is wrong with the data, or with what the FMU does.
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
