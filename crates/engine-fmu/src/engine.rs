//! The engine `fmu`.
use crate::isolated::Bounds;
use crate::keeper::HostCommand;
use crate::load::{Place, load};
use crate::mechanics::{FmuMechanics, NAME};
use crate::ports::{MechanicsPorts, PortError};
use servobench_base::{ParamError, finite, positive};
use servobench_fmi::{DataType, Exponents, ModelDescription, Port, Setup, Unpacked, Value, Variable};
use servobench_plant::{
    Drive, Engine, FmuModel, FmuStart, FmuValue, Isolation, Mechanics, MechanicsError, MechanicsSetup, Model,
};
use std::fmt::Display;
use std::io;

/// The engine `fmu`: the mechanics are an FMU.
#[derive(Debug, Clone, Copy)]
pub struct Fmu {
    /// The program that an FMU runs in if it is isolated.
    pub host: fn() -> io::Result<HostCommand>,
}

impl Fmu {
    /// The mechanics at tick 0.
    ///
    /// # Errors
    /// [`MechanicsError`]
    pub fn mechanics(&self, setup: &MechanicsSetup) -> Result<FmuMechanics, MechanicsError> {
        setup.check()?;
        let Model::Fmu(model) = &setup.model else {
            return Err(MechanicsError::Unsupported {
                engine: NAME,
                what: "mechanics that are described by bodies or MJCF".into(),
                way_out: "choose another engine, or give an FMU".into(),
            });
        };
        if setup.drive == Drive::Prescribed {
            return Err(MechanicsError::Unsupported {
                engine: NAME,
                what: "a prescribed motion".into(),
                way_out: "drive the FMU by efforts, or describe the axis by its bodies".into(),
            });
        }
        check(model)?;
        let fmu = Unpacked::new(&model.path).map_err(refused)?;
        let ports = MechanicsPorts::new(model, fmu.description()).map_err(|errors| in_one_line(model, &errors))?;
        let slave_setup = slave_setup(model, &ports, fmu.description())?;
        let slave = load(&fmu, &slave_setup, &fmu_place(model.isolation, self.host)?).map_err(refused)?;
        FmuMechanics::new(slave, ports, model, setup.step)
    }
}

impl Engine for Fmu {
    fn name(&self) -> &'static str {
        NAME
    }

    fn build(&self, setup: &MechanicsSetup) -> Result<Box<dyn Mechanics>, MechanicsError> {
        Ok(Box::new(self.mechanics(setup)?))
    }
}

fn check(model: &FmuModel) -> Result<(), ParamError> {
    positive("ticks", f64::from(model.ticks))?;
    finite("transmission", model.transmission)?;
    Ok(())
}

/// How the FMU is started and wired.
fn slave_setup(model: &FmuModel, ports: &MechanicsPorts, it: &ModelDescription) -> Result<Setup, MechanicsError> {
    Ok(Setup {
        instance_name: it.model_name.clone(),
        start_values: start_values(&model.start, it)?,
        inputs: ports.inputs().cloned().collect::<Vec<Port>>(),
        outputs: ports.outputs().cloned().collect::<Vec<Port>>(),
        ..Setup::default()
    })
}

/// Where an FMU runs; `host` is the program that does so in a process of its own.
pub(crate) fn fmu_place(isolation: Isolation, host: fn() -> io::Result<HostCommand>) -> Result<Place, MechanicsError> {
    Ok(match isolation {
        Isolation::None => Place::Here,
        Isolation::Process { patience, memory } => {
            Place::Process { command: host().map_err(refused)?, bounds: Bounds { patience, memory } }
        }
    })
}

/// Start values in the units of their variables.
pub(crate) fn start_values(start: &[FmuStart], it: &ModelDescription) -> Result<Vec<(String, Value)>, MechanicsError> {
    start.iter().map(|start| Ok((start.variable.clone(), value(start, it)?))).collect()
}

/// A start value in the unit of its variable.
fn value(start: &FmuStart, it: &ModelDescription) -> Result<Value, MechanicsError> {
    let variable = it.variable(&start.variable);
    let unit = variable.and_then(|variable| it.unit(variable));
    let convert = |value: &FmuValue| {
        Ok(match (value, unit) {
            (FmuValue::Number(number), _) | (FmuValue::Si(number), None) => Value::Number(*number),
            (FmuValue::Si(number), Some(unit)) => {
                let is_relative = variable.is_some_and(|variable| variable.is_relative);
                let Some(base) = unit.base else {
                    return Err(refused(format!(
                        "start value of `{}`: the FMU does not say what its unit `{}` is; give it as a plain number",
                        start.variable, unit.name
                    )));
                };
                Value::Number(base.from_si(*number, is_relative))
            }
            (FmuValue::Quantity { text, .. }, _) if variable.is_some_and(is_named) => Value::Text(text.clone()),
            (FmuValue::Quantity { si, .. }, None) => Value::Number(*si),
            (FmuValue::Quantity { text, si, exponents }, Some(unit)) => {
                let is_relative = variable.is_some_and(|variable| variable.is_relative);
                let name = &start.variable;
                match unit.base {
                    Some(base) if of(base.exponents) == *exponents => Value::Number(base.from_si(*si, is_relative)),
                    Some(_) => {
                        let message = format!("`{name}` is in `{}`, which \"{text}\" cannot be turned into", unit.name);
                        return Err(refused(message));
                    }
                    None => {
                        let message = format!(
                            "the FMU does not say what the unit `{}` of `{name}` is; give a plain number of it, not \"{text}\"",
                            unit.name
                        );
                        return Err(refused(message));
                    }
                }
            }
            (FmuValue::Boolean(is), _) => Value::Boolean(*is),
            (FmuValue::Text(text), _) => Value::Text(text.clone()),
        })
    };
    match &start.values[..] {
        [value] => convert(value),
        values => Ok(Value::List(values.iter().map(convert).collect::<Result<_, _>>()?)),
    }
}

/// Whether a value of it is a text.
fn is_named(variable: &Variable) -> bool {
    matches!(variable.data_type, DataType::String | DataType::Enumeration)
}

/// Exponents of kilogram, metre, second and ampere. Radians are counted by some and not by others.
fn of(exponents: Exponents) -> [i32; 4] {
    [exponents.kg, exponents.m, exponents.s, exponents.a]
}

pub(crate) fn refused(error: impl Display) -> MechanicsError {
    MechanicsError::Model { engine: NAME, message: error.to_string() }
}

fn in_one_line(model: &FmuModel, errors: &[PortError]) -> MechanicsError {
    let errors: Vec<String> = errors.iter().map(ToString::to_string).collect();
    refused(format!("{}: {}", model.path.display(), errors.join("; ")))
}
