//! From what is said of an FMU to one that runs: everything that does not fit is found first.
use crate::in_si::InSi;
use crate::isolated::Bounds;
use crate::keeper::HostCommand;
use crate::load::{Place, load};
use crate::ports::{Ports, mechanical};
use servobench_fmi::{DataType, FmuError, ModelDescription, Setup, Slave, Unpacked, Value, Variable};
use servobench_plant::{FmuEntry, FmuFile, FmuMistake, FmuPort, FmuStart, FmuValue, Isolation};
use std::io;

/// Who it is, and what is exchanged with it.
pub(crate) struct Wanted<'a> {
    /// Name of the instance; that of the model unless given.
    pub(crate) name: Option<&'a str>,
    pub(crate) inputs: Vec<&'a FmuPort>,
    pub(crate) outputs: Vec<&'a FmuPort>,
    /// When the simulation ends (s), if that is known.
    pub(crate) end: Option<f64>,
}

/// The FMU, initialised and wired; its numbers are SI numbers. `host` is the program that runs one in a process of its own.
pub(crate) fn open(
    file: &FmuFile,
    wanted: &Wanted<'_>,
    host: fn() -> io::Result<HostCommand>,
) -> Result<Box<dyn Slave>, Vec<FmuMistake>> {
    let of_file = |error: &dyn std::fmt::Display| vec![FmuMistake::of_file(&error)];
    let fmu = Unpacked::new(&file.path).map_err(|error| of_file(&error))?;
    let it = fmu.description();
    let (ports, mut mistakes) = match Ports::new(wanted.inputs.clone(), wanted.outputs.clone(), it) {
        Ok(ports) => (Some(ports), Vec::new()),
        Err(mistakes) => (None, mistakes),
    };
    let mut start_values = Vec::new();
    for start in &file.start {
        match value(start, it) {
            Ok(value) => start_values.push((start.variable.clone(), value)),
            Err(mistake) => mistakes.push(mistake),
        }
    }
    let wires = |ports: Option<&Vec<crate::ports::Wire>>| {
        ports.map_or_else(Vec::new, |wires| wires.iter().map(|wire| wire.port.clone()).collect())
    };
    let mut setup = Setup {
        instance_name: wanted.name.unwrap_or(&it.model_name).to_owned(),
        start_values,
        inputs: wires(ports.as_ref().map(|ports| &ports.inputs)),
        outputs: wires(ports.as_ref().map(|ports| &ports.outputs)),
        stop_time: wanted.end,
        ..Setup::default()
    };
    mistakes.extend(misfits(&mut setup, &fmu));
    let Some(ports) = ports.filter(|_| mistakes.is_empty()) else { return Err(mistakes) };
    let place = place(file.isolation, host).map_err(|error| of_file(&error))?;
    let slave = load(&fmu, &setup, &place).map_err(|error| of_file(&error))?;
    Ok(Box::new(InSi::new(slave, ports)))
}

/// Everything of `setup` that does not fit; start values that do not are taken out.
fn misfits(setup: &mut Setup, fmu: &Unpacked) -> Vec<FmuMistake> {
    let mut mistakes = Vec::new();
    while let Err(error) = setup.check(fmu) {
        let FmuError::Setup { what, name, problem, .. } = error else {
            mistakes.push(FmuMistake::of_file(&error));
            break;
        };
        let before = setup.start_values.len();
        let at = match what {
            "input" => FmuEntry::Input(name),
            "output" => FmuEntry::Output(name),
            _ => {
                setup.start_values.retain(|(variable, _)| *variable != name);
                FmuEntry::Start(name)
            }
        };
        mistakes.push(FmuMistake { at, message: problem, way_out: String::new() });
        if setup.start_values.len() == before {
            break;
        }
    }
    mistakes
}

fn place(isolation: Isolation, host: fn() -> io::Result<HostCommand>) -> io::Result<Place> {
    Ok(match isolation {
        Isolation::None => Place::Here,
        Isolation::Process { patience, memory } => {
            Place::Process { command: host()?, bounds: Bounds { patience, memory } }
        }
    })
}

/// A start value in the unit of its variable.
fn value(start: &FmuStart, it: &ModelDescription) -> Result<Value, FmuMistake> {
    let convert = |value: &FmuValue| match value {
        FmuValue::Number(number) => Ok(Value::Number(*number)),
        FmuValue::Boolean(is) => Ok(Value::Boolean(*is)),
        FmuValue::Text(text) => Ok(Value::Text(text.clone())),
        FmuValue::Quantity { text, si, exponents } => quantity(&start.variable, text, *si, *exponents, it),
    };
    match &start.values[..] {
        [value] => convert(value),
        values => Ok(Value::List(values.iter().map(convert).collect::<Result<_, _>>()?)),
    }
}

fn quantity(name: &str, text: &str, si: f64, exponents: [i32; 4], it: &ModelDescription) -> Result<Value, FmuMistake> {
    let Some(variable) = it.variable(name) else { return Ok(Value::Number(si)) };
    if is_named(variable) {
        return Ok(Value::Text(text.to_owned()));
    }
    let Some(unit) = it.unit(variable) else { return Ok(Value::Number(si)) };
    let refuse = |message: String, way_out: &str| {
        let at = FmuEntry::Start(name.to_owned());
        Err(FmuMistake { at, message, way_out: way_out.to_owned() })
    };
    match unit.base {
        Some(base) if mechanical(base.exponents) == Some(exponents) => {
            Ok(Value::Number(base.from_si(si, variable.is_relative)))
        }
        Some(_) => refuse(
            format!("`{name}` of the FMU is in `{}`, which \"{text}\" cannot be turned into", unit.name),
            "give a quantity of the same kind, or a plain number of that unit",
        ),
        None => refuse(
            format!("the FMU does not say what the unit `{}` of `{name}` is", unit.name),
            &format!("give a plain number of it instead of \"{text}\""),
        ),
    }
}

/// Whether a value of it is a text.
fn is_named(variable: &Variable) -> bool {
    matches!(variable.data_type, DataType::String | DataType::Enumeration)
}
