//! How an FMU is started and wired.
mod clocked;
mod start;

pub(crate) use start::Start;

use crate::archive::Unpacked;
use crate::bits;
use crate::description::{Causality, DataType, Dimension, ModelDescription, Values, Variability, Variable};
use crate::error::FmuError;
use crate::slave::Port;
use serde::{Deserialize, Serialize};
use servobench_config::Choice as _;
use servobench_files::nearest;
use servobench_fmu_file::Value;
use std::collections::HashSet;

/// How an FMU is started and wired.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Setup {
    /// What the instance calls itself in its messages.
    pub instance_name: String,
    /// Start values of variables by name: parameters, inputs, and what the FMU lets start elsewhere.
    pub start_values: Vec<(String, Value)>,
    /// What is set at each step.
    pub inputs: Vec<Port>,
    /// What is read.
    pub outputs: Vec<Port>,
    /// Time at the start (s).
    #[serde(with = "bits::float")]
    pub start_time: f64,
    /// Time at the end (s), if it is known.
    #[serde(with = "bits::optional")]
    pub stop_time: Option<f64>,
    /// Relative tolerance for a solver in the FMU.
    #[serde(with = "bits::optional")]
    pub tolerance: Option<f64>,
    /// Whether the FMU is to say what it does.
    pub logging: bool,
    /// Whether it waits in its initialisation until it is started ([`Slave::start`](crate::Slave::start)).
    pub waits: bool,
    /// Whether it is to deal with events by itself, although it has an event mode (FMI 3.0).
    pub without_event_mode: bool,
}

/// What is to be set or read, found in the description.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Wire {
    pub(crate) variable: usize,
    pub(crate) element: usize,
}

/// What of a setup is found in the description.
#[derive(Debug)]
pub(crate) struct Plan {
    /// Structural parameters, then all others.
    pub(crate) starts: Vec<Start>,
    pub(crate) inputs: Vec<Wire>,
    pub(crate) outputs: Vec<Wire>,
    /// How many elements each variable has.
    pub(crate) counts: Vec<usize>,
}

impl Setup {
    /// Finds everything in the description, without opening the library: what `fmu check` needs.
    ///
    /// # Errors
    /// [`FmuError::Setup`] names what is not there or cannot be, and what is there.
    pub fn check(&self, fmu: &Unpacked) -> Result<(), FmuError> {
        self.plan(fmu).map(|_| ())
    }

    pub(crate) fn plan(&self, fmu: &Unpacked) -> Result<Plan, FmuError> {
        let it = fmu.description();
        clocked::check(it).map_err(|(clock, problem)| setup(fmu, "clock", clock, problem))?;
        let (starts, counts) = start::all(fmu, &self.start_values)?;
        let mut wired = HashSet::new();
        let mut inputs = vec![];
        for port in &self.inputs {
            let refuse = |problem| setup(fmu, "input", &port.variable, problem);
            let wire = find(it, port, &counts).map_err(refuse)?;
            let variable = &it.variables[wire.variable];
            if !is_settable(variable) {
                let causality = variable.causality.name();
                let what = format!(
                    "it is {causality}, {}; inputs and tunable parameters can be set",
                    variable.variability.name()
                );
                return Err(refuse(what));
            }
            if !wired.insert((wire.variable, wire.element)) {
                return Err(refuse(format!("element {} is wired twice", port.element)));
            }
            inputs.push(wire);
        }
        let output =
            |port: &Port| find(it, port, &counts).map_err(|problem| setup(fmu, "output", &port.variable, problem));
        let outputs = self.outputs.iter().map(output).collect::<Result<_, _>>()?;
        Ok(Plan { starts, inputs, outputs, counts })
    }
}

/// Whether it can be set between steps.
fn is_settable(variable: &Variable) -> bool {
    let is_tunable = variable.causality == Causality::Parameter && variable.variability == Variability::Tunable;
    variable.causality == Causality::Input || is_tunable
}

fn setup(fmu: &Unpacked, what: &'static str, name: &str, problem: String) -> FmuError {
    FmuError::Setup { path: fmu.path().to_owned(), what, name: name.to_owned(), problem }
}

/// The element of the variable that a port stands for, which is a number.
fn find(it: &ModelDescription, port: &Port, counts: &[usize]) -> Result<Wire, String> {
    let variable = position(it, &port.variable)?;
    let data_type = it.variables[variable].data_type;
    if matches!(data_type, DataType::String | DataType::Binary | DataType::Clock) {
        return Err(format!("it is a `{}`; numbers, booleans and enumerations can be wired", data_type.name()));
    }
    clocked::check_wired(it, variable)?;
    let count = counts[variable];
    if port.element >= count {
        return Err(format!("it has no element {}; it has {count}, counted from 0", port.element));
    }
    Ok(Wire { variable, element: port.element })
}

/// Position of a variable; names that are like the one that is not there help.
fn position(it: &ModelDescription, name: &str) -> Result<usize, String> {
    it.position(name).ok_or_else(|| {
        match nearest(name, it.variables.iter().take(10_000).map(|variable| variable.name.as_str())) {
            Some(near) => format!("there is no such variable; is it `{near}`?"),
            None => "there is no such variable".to_owned(),
        }
    })
}

/// How many elements each variable has, with structural parameters as they are started.
fn counts(it: &ModelDescription, starts: &[Start]) -> Vec<usize> {
    let structural = |at: usize| {
        let started = starts.iter().find(|start| start.variable == at).map(|start| &start.values);
        match started.or(it.variables[at].start.as_ref()) {
            Some(Values::Integer(values)) => values.first().and_then(|&value| value.try_into().ok()).unwrap_or(0),
            _ => 0,
        }
    };
    let extent = |dimension: &Dimension| match dimension {
        Dimension::Fixed(extent) => usize::try_from(*extent).unwrap_or(usize::MAX),
        Dimension::Structural(at) => structural(*at),
    };
    it.variables.iter().map(|variable| variable.dimensions.iter().map(extent).fold(1, usize::saturating_mul)).collect()
}
