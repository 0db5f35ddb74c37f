//! An FMU beside an axis: a load, a controller, a source of signals.
use crate::engine::{Fmu, fmu_place, refused, start_values};
use crate::load::load;
use servobench_fmi::{
    Capabilities, LogLine, ModelDescription, Port, Progress, Setup, Slave, SlaveError, Unpacked, Variable,
};
use servobench_plant::{FmuStart, Isolation, MechanicsError};
use std::path::PathBuf;

/// An FMU beside an axis, as plain data. Units are those of its model description; a variable that has none counts in SI units.
#[derive(Debug, Clone, PartialEq)]
pub struct PartnerModel {
    /// The file.
    pub path: PathBuf,
    /// Name of the instance.
    pub name: String,
    /// What is set before it starts.
    pub start: Vec<FmuStart>,
    /// Inputs that are exchanged: names of variables, or `name[2]`, `name[2,1]` of elements of an array, counted from 1.
    pub inputs: Vec<String>,
    /// Outputs that are exchanged.
    pub outputs: Vec<String>,
    /// When the simulation ends (s).
    pub end: f64,
    /// Where it runs.
    pub isolation: Isolation,
}

/// A slave whose numbers are SI numbers.
struct InSi {
    slave: Box<dyn Slave>,
    inputs: Vec<Scale>,
    outputs: Vec<Scale>,
    own: Vec<[f64; 3]>,
    present: Vec<f64>,
}

/// From the unit of a variable to SI: `si = factor·value + offset`.
#[derive(Debug, Clone, Copy)]
struct Scale {
    factor: f64,
    offset: f64,
}

impl Fmu {
    /// The FMU, initialised and wired; its numbers are SI numbers.
    ///
    /// # Errors
    /// [`MechanicsError::Model`] says what is wrong with the file or with the ports.
    pub fn partner(&self, model: &PartnerModel) -> Result<Box<dyn Slave>, MechanicsError> {
        let fmu = Unpacked::new(&model.path).map_err(refused)?;
        let it = fmu.description();
        let ports = |names: &[String]| names.iter().map(|name| port(it, name)).collect::<Result<Vec<_>, _>>();
        let (inputs, outputs) = (ports(&model.inputs)?, ports(&model.outputs)?);
        let scales = |ports: &[Port]| ports.iter().map(|port| scale(it, &port.variable)).collect::<Result<Vec<_>, _>>();
        let (input_scales, output_scales) = (scales(&inputs)?, scales(&outputs)?);
        let setup = Setup {
            instance_name: model.name.clone(),
            start_values: start_values(&model.start, it)?,
            inputs,
            outputs,
            stop_time: Some(model.end),
            ..Setup::default()
        };
        let slave = load(&fmu, &setup, &fmu_place(model.isolation, self.host)?).map_err(refused)?;
        let (own, present) = (vec![[0.0; 3]; input_scales.len()], vec![0.0; input_scales.len()]);
        Ok(Box::new(InSi { slave, inputs: input_scales, outputs: output_scales, own, present }))
    }
}

/// A variable, or an element of one.
fn port(it: &ModelDescription, name: &str) -> Result<Port, MechanicsError> {
    if it.variable(name).is_some() {
        return Ok(Port { variable: name.to_owned(), element: 0 });
    }
    let unknown = || refused(format!("the FMU has no variable `{name}`; `servobench fmu info` lists what it has"));
    let (variable, indices) = name.strip_suffix(']').and_then(|name| name.rsplit_once('[')).ok_or_else(unknown)?;
    let shape = it.shape(it.variable(variable).ok_or_else(unknown)?);
    let indices: Vec<u64> = indices.split(',').map(|index| index.trim().parse().unwrap_or(0)).collect();
    let fits =
        indices.len() == shape.len() && indices.iter().zip(&shape).all(|(index, length)| (1..=*length).contains(index));
    if !fits {
        return Err(refused(format!("`{name}`: `{variable}` has the dimensions {shape:?}, and indices count from 1")));
    }
    let element = indices.iter().zip(&shape).fold(0, |element, (index, length)| element * length + index - 1);
    Ok(Port { variable: variable.to_owned(), element: usize::try_from(element).unwrap_or(usize::MAX) })
}

fn scale(it: &ModelDescription, name: &str) -> Result<Scale, MechanicsError> {
    let none = Scale { factor: 1.0, offset: 0.0 };
    let Some(variable) = it.variable(name) else { return Ok(none) };
    let Some(unit) = it.unit(variable) else { return Ok(none) };
    match unit.base {
        Some(base) => {
            let is_relative = |variable: &Variable| variable.is_relative;
            Ok(Scale { factor: base.factor, offset: if is_relative(variable) { 0.0 } else { base.offset } })
        }
        // Tools that define no units write their names; one that is no SI unit would be taken for one.
        None if SI_NAMES.contains(&unit.name.as_str()) => Ok(none),
        None => Err(refused(format!(
            "the FMU does not say what the unit `{}` of `{name}` is in SI units, so it cannot be connected",
            unit.name
        ))),
    }
}

/// Names of SI units that tools write without defining them.
const SI_NAMES: [&str; 24] = [
    "", "1", "-", "N", "N.m", "N*m", "N·m", "Nm", "m", "rad", "m/s", "m.s-1", "rad/s", "rad.s-1", "1/s", "s", "kg",
    "A", "V", "m/s2", "m/s^2", "rad/s2", "K", "Pa",
];

impl Slave for InSi {
    fn capabilities(&self) -> Capabilities {
        self.slave.capabilities()
    }

    fn feeds_through(&self, output: usize, input: usize) -> bool {
        self.slave.feeds_through(output, input)
    }

    fn step(&mut self, time: f64, length: f64, inputs: &[[f64; 3]]) -> Result<Progress, SlaveError> {
        for ((own, scale), [value, slope, bend]) in self.own.iter_mut().zip(&self.inputs).zip(inputs) {
            *own = [(value - scale.offset) / scale.factor, slope / scale.factor, bend / scale.factor];
        }
        self.slave.step(time, length, &self.own)
    }

    fn read(&mut self, inputs: Option<&[f64]>, outputs: &mut [f64]) -> Result<(), SlaveError> {
        let present = inputs.map(|inputs| {
            for ((own, scale), value) in self.present.iter_mut().zip(&self.inputs).zip(inputs) {
                *own = (value - scale.offset) / scale.factor;
            }
            self.present.as_slice()
        });
        self.slave.read(present, outputs)?;
        for (output, scale) in outputs.iter_mut().zip(&self.outputs) {
            *output = scale.factor * *output + scale.offset;
        }
        Ok(())
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
