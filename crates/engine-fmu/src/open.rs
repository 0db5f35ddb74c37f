//! From the request for an FMU to a running one: all mismatches are found first.
use crate::described::Described;
use crate::engine::Code;
use crate::in_si::InSi;
use crate::load::{Place, load};
use crate::ports::{Ports, mechanical};
use servobench_fmi::{
    DataType, FmuEntry, FmuError, FmuFile, FmuMistake, FmuRequest, Isolation, ModelDescription, Setup, Slave, Unpacked,
    Value, Variable,
};
use servobench_isolation::Program as HostCommand;
use std::io;

/// The FMU, initialised and wired, with its numbers in SI units. `host` is the program that runs isolated FMUs. If `code` lets none of
/// its code run, it is only described.
pub(crate) fn open(
    request: &FmuRequest<'_>,
    code: Code,
    host: fn() -> io::Result<HostCommand>,
) -> Result<Box<dyn Slave>, Vec<FmuMistake>> {
    let of_file = |error: &dyn std::fmt::Display| vec![FmuMistake::of_file(&error)];
    let file = request.file;
    let fmu = Unpacked::new(&file.path).map_err(|error| {
        let at = if error.is_shortage() { FmuEntry::Conduct } else { FmuEntry::File };
        vec![FmuMistake { at, ..FmuMistake::of_file(&error) }]
    })?;
    let it = fmu.description();
    let (ports, mut mistakes) = match Ports::new(&request.inputs, &request.outputs, it) {
        Ok(ports) => (Some(ports), Vec::new()),
        Err(mistakes) => (None, mistakes),
    };
    let mut start_values = Vec::new();
    for (variable, start) in &file.start {
        match value(variable, start, it) {
            Ok(value) => start_values.push((variable.clone(), value)),
            Err(mistake) => mistakes.push(mistake),
        }
    }
    let wires = |ports: Option<&Vec<crate::ports::Wire>>| {
        ports.map_or_else(Vec::new, |wires| wires.iter().map(|wire| wire.port.clone()).collect())
    };
    let mut setup = Setup {
        instance_name: request.name.unwrap_or(&it.model_name).to_owned(),
        start_values,
        inputs: wires(ports.as_ref().map(|ports| &ports.inputs)),
        outputs: wires(ports.as_ref().map(|ports| &ports.outputs)),
        stop_time: request.end,
        waits: request.waits,
        without_event_mode: !file.event_mode,
        ..Setup::default()
    };
    mistakes.extend(misfits(&mut setup, &fmu));
    mistakes.extend(event_mode_mistake(file, it));
    mistakes.extend(isolation_mistake(file, code));
    let Some(ports) = ports.filter(|_| mistakes.is_empty()) else { return Err(mistakes) };
    let doubts = step_doubt(request.step, it).into_iter().collect();
    if code == Code::None {
        fmu.library().map_err(|error| of_file(&error))?;
        let described = Described::new(it, &setup);
        let slave = InSi::new(Box::new(described), ports).with_warnings(fmu.remarks());
        return Ok(Box::new(slave.with_doubts(doubts)));
    }
    let place = place(file.isolation, host).map_err(|error| of_file(&error))?;
    let slave = load(&fmu, &setup, &place).map_err(|error| {
        let at = if error.is_of_the_run() { FmuEntry::Conduct } else { FmuEntry::File };
        vec![FmuMistake { at, ..FmuMistake::of_file(&error) }]
    })?;
    Ok(Box::new(InSi::new(slave, ports).with_warnings(fmu.remarks()).with_doubts(doubts)))
}

/// Relative deviation of a step from a whole number of internal steps that counts as rounding.
const ROUNDING: f64 = 1e-6;

/// FMI 3.0.2, §4.3.1, as a note: steps should be whole numbers of the FMU's internal steps, if these have a fixed length. In between, its
/// time may differ from the requested one.
fn step_doubt(step: f64, it: &ModelDescription) -> Option<FmuMistake> {
    let internal =
        it.co_simulation.fixed_internal_step_size.filter(|internal| internal.is_finite() && *internal > 0.0)?;
    let count = step / internal;
    if count >= 1.0 - ROUNDING && (count - count.round()).abs() <= ROUNDING * count.max(1.0) {
        return None;
    }
    let message = format!(
        "the FMU steps by {internal} s inside (`fixedInternalStepSize`), and {step} s is not a whole number of that: between two of its \
         steps it may stand still"
    );
    let help = format!("give it a `step` that is a multiple of {internal} s");
    Some(FmuMistake { at: FmuEntry::Step, message, help })
}

fn event_mode_mistake(file: &FmuFile, it: &ModelDescription) -> Option<FmuMistake> {
    (!file.event_mode && !it.co_simulation.has_event_mode).then(|| FmuMistake {
        at: FmuEntry::EventMode,
        message: "the FMU has no event mode that could be switched off".into(),
        help: "leave `event_mode` out".into(),
    })
}

/// In this process it can do whatever the program can: a scenario may not decide that.
fn isolation_mistake(file: &FmuFile, code: Code) -> Option<FmuMistake> {
    (file.isolation == Isolation::None && code == Code::Isolated).then(|| FmuMistake {
        at: FmuEntry::Isolation,
        message: "only the command line can let the code of an FMU run without isolation".into(),
        help: "leave `isolation` out, or trust the FMU with `--allow-unisolated-fmus`".into(),
    })
}

/// All mismatches in `setup`; start values that do not fit are removed.
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
        mistakes.push(FmuMistake { at, message: problem, help: String::new() });
        if setup.start_values.len() == before {
            break;
        }
    }
    mistakes
}

fn place(isolation: Isolation, host: fn() -> io::Result<HostCommand>) -> io::Result<Place> {
    Ok(match isolation {
        Isolation::None => Place::Here,
        Isolation::Process { bounds } => Place::Process { command: host()?, bounds },
    })
}

/// A start value in the unit of its variable; a list as its elements, in row-major order.
fn value(name: &str, start: &Value, it: &ModelDescription) -> Result<Value, FmuMistake> {
    let mut elements = Vec::new();
    flatten(start, &mut elements);
    let convert = |value: &Value| match value {
        Value::Text(text) => match unknown_unit(name, text, it) {
            Some(mistake) => Err(mistake),
            None => Ok(Value::Text(text.clone())),
        },
        Value::Quantity { text, si, exponents } => quantity(name, text, *si, *exponents, it),
        other => Ok(other.clone()),
    };
    match &elements[..] {
        [value] => convert(value),
        values => Ok(Value::List(values.iter().map(|value| convert(value)).collect::<Result<_, _>>()?)),
    }
}

fn flatten<'a>(value: &'a Value, elements: &mut Vec<&'a Value>) {
    match value {
        Value::List(values) => values.iter().for_each(|value| flatten(value, elements)),
        scalar => elements.push(scalar),
    }
}

/// A number followed by an unknown unit, for a numeric variable.
fn unknown_unit(name: &str, text: &str, it: &ModelDescription) -> Option<FmuMistake> {
    let variable =
        it.variable(name).filter(|variable| !is_named(variable) && variable.data_type != DataType::Boolean)?;
    let ends = text.char_indices().map(|(at, _)| at).chain([text.len()]);
    let (number, unit) =
        ends.rev().map(|end| text.split_at(end)).find(|(number, _)| number.trim().parse::<f64>().is_ok())?;
    let unit = unit.trim();
    if unit.is_empty() || !number.trim().starts_with(|first: char| first.is_ascii_digit() || "+-.".contains(first)) {
        return None;
    }
    let of_variable = it.unit(variable).map_or_else(String::new, |unit| format!(" in `{}`", unit.name));
    Some(FmuMistake {
        at: FmuEntry::Start(name.to_owned()),
        message: format!("\"{text}\": `{unit}` is an unknown unit"),
        help: format!("give a quantity with a unit of SI, or a plain number{of_variable}"),
    })
}

fn quantity(name: &str, text: &str, si: f64, exponents: [i32; 4], it: &ModelDescription) -> Result<Value, FmuMistake> {
    let Some(variable) = it.variable(name) else { return Ok(Value::Number(si)) };
    if is_named(variable) {
        return Ok(Value::Text(text.to_owned()));
    }
    let Some(unit) = it.unit(variable) else { return Ok(Value::Number(si)) };
    let refuse = |message: String, help: &str| {
        let at = FmuEntry::Start(name.to_owned());
        Err(FmuMistake { at, message, help: help.to_owned() })
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

/// True if its values are texts.
fn is_named(variable: &Variable) -> bool {
    matches!(variable.data_type, DataType::String | DataType::Enumeration)
}
