//! Start and wiring of an FMU.
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

/// Start and wiring of an FMU.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Setup {
    /// Name of the instance in its messages.
    pub instance_name: String,
    /// Start values of variables by name: parameters, inputs, and others whose start value the FMU lets change.
    pub start_values: Vec<(String, Value)>,
    /// Ports set at each step.
    pub inputs: Vec<Port>,
    /// Ports that are read.
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
    /// True if the FMU is to log its activity.
    pub logging: bool,
    /// True if it waits in its initialisation until it is started ([`Slave::start`](crate::Slave::start)).
    pub waits: bool,
    /// True if it is to handle events by itself, although it has an event mode (FMI 3.0).
    pub without_event_mode: bool,
}

/// A port, looked up in the description.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Wire {
    pub(crate) variable: usize,
    pub(crate) element: usize,
}

/// A setup, looked up in the description.
#[derive(Debug)]
pub(crate) struct Plan {
    /// Structural parameters, then all others.
    pub(crate) starts: Vec<Start>,
    pub(crate) inputs: Vec<Wire>,
    pub(crate) outputs: Vec<Wire>,
    /// Number of elements of each variable.
    pub(crate) counts: Vec<usize>,
}

impl Setup {
    /// Looks everything up in the description without opening the library, for `fmu check`.
    ///
    /// # Errors
    /// [`FmuError::Setup`] names what is missing or impossible, and the alternatives.
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

/// True if it can be set between steps.
fn is_settable(variable: &Variable) -> bool {
    let is_tunable = variable.causality == Causality::Parameter && variable.variability == Variability::Tunable;
    variable.causality == Causality::Input || is_tunable
}

fn setup(fmu: &Unpacked, what: &'static str, name: &str, problem: String) -> FmuError {
    FmuError::Setup { path: fmu.path().to_owned(), what, name: name.to_owned(), problem }
}

/// The element of the variable for a port, which is a number.
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

/// Position of a variable; an error suggests a similar name.
fn position(it: &ModelDescription, name: &str) -> Result<usize, String> {
    it.position(name).ok_or_else(|| {
        match nearest(name, it.variables.iter().take(10_000).map(|variable| variable.name.as_str())) {
            Some(near) => format!("there is no such variable; is it `{near}`?"),
            None => "there is no such variable".to_owned(),
        }
    })
}

/// Number of elements of each variable, with the start values of structural parameters.
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
