//! Direct feedthrough between what is wired.
use crate::description::{Causality, DataType, ModelDescription, Version};
use crate::setup::Setup;
use crate::slave::Port;

/// Which wired outputs may follow which wired inputs at once, without a step, as far as the model description says.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Feedthrough {
    inputs: usize,
    /// By output, then by input.
    pairs: Vec<bool>,
}

impl Feedthrough {
    /// Of the ports of `setup`. An element of an array is taken as its variable, and a variable of FMI 2.0 as all that have its
    /// value reference.
    #[must_use]
    pub fn new(it: &ModelDescription, setup: &Setup) -> Self {
        let position = |port: &Port| it.position(&port.variable);
        let inputs: Vec<_> = setup.inputs.iter().map(position).collect();
        let of = |output: &Port| {
            let output = position(output);
            inputs
                .iter()
                .map(move |input| output.zip(*input).is_none_or(|(output, input)| may_follow(it, output, input)))
        };
        Self { inputs: inputs.len(), pairs: setup.outputs.iter().flat_map(of).collect() }
    }

    /// Whether the output with this position in the setup may follow the input with that position. What the FMU does not
    /// exclude may be.
    #[must_use]
    pub fn between(&self, output: usize, input: usize) -> bool {
        input >= self.inputs || self.pairs.get(output * self.inputs + input).is_none_or(|may| *may)
    }
}

/// FMI 2.0.5, §2.2.8, and FMI 3.0.2, §2.4.8: dependencies list inputs and states. Of parameters they say nothing.
fn may_follow(it: &ModelDescription, output: usize, input: usize) -> bool {
    let of_output = it.structure.outputs.iter().filter(|unknown| are_one(it, unknown.variable, output));
    let mut said = of_output.filter_map(|unknown| unknown.dependencies.as_ref());
    let is_input = it.variables[input].causality == Causality::Input;
    let dependencies = said.next().filter(|_| is_input);
    dependencies.is_none_or(|all| all.iter().any(|(variable, _)| are_one(it, *variable, input)))
}

/// Whether two variables are one to the library. In FMI 2.0 enumerations have the value references of the integers.
fn are_one(it: &ModelDescription, one: usize, other: usize) -> bool {
    let name = |at: usize| {
        let variable = &it.variables[at];
        let is_enumeration = variable.data_type == DataType::Enumeration;
        (if is_enumeration { DataType::Int32 } else { variable.data_type }, variable.value_reference)
    };
    one == other || (it.version == Version::Two && name(one) == name(other))
}
