//! Direct feedthrough between wired variables.
use crate::description::{Causality, DataType, Initial, ModelDescription, Unknown, Variability, Version};
use crate::setup::Setup;
use crate::slave::Port;

/// Wired outputs that may follow wired inputs at once, without a step, as far as the model description states.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Feedthrough {
    inputs: usize,
    /// By output, then by input.
    pairs: Vec<bool>,
    /// The same by the initial equations.
    initial: Vec<bool>,
    /// By output: true if it changes at events only.
    discrete: Vec<bool>,
}

impl Feedthrough {
    /// Feedthrough between the ports of `setup`. An element of an array counts as its variable, and a variable of FMI 2.0 as all that
    /// share its value reference.
    #[must_use]
    pub fn new(it: &ModelDescription, setup: &Setup) -> Self {
        let position = |port: &Port| it.position(&port.variable);
        let inputs: Vec<_> = setup.inputs.iter().map(position).collect();
        let outputs: Vec<_> = setup.outputs.iter().map(position).collect();
        let pairs = |may_follow: fn(&ModelDescription, usize, usize) -> bool| {
            let all = outputs.iter().flat_map(|output| inputs.iter().map(move |input| (*output, *input)));
            all.map(|(output, input)| output.zip(input).is_none_or(|(output, input)| may_follow(it, output, input)))
                .collect()
        };
        let is_discrete = |at: usize| it.variables[at].variability != Variability::Continuous;
        Self {
            inputs: inputs.len(),
            pairs: pairs(may_follow),
            initial: pairs(may_follow_at_start),
            discrete: outputs.iter().map(|output| output.is_some_and(is_discrete)).collect(),
        }
    }

    /// True if the output at this position in the setup may follow the input at that position; also where the FMU does not exclude it.
    #[must_use]
    pub fn between(&self, output: usize, input: usize) -> bool {
        input >= self.inputs || self.pairs.get(output * self.inputs + input).is_none_or(|may| *may)
    }

    /// The same by the initial equations.
    #[must_use]
    pub fn at_start(&self, output: usize, input: usize) -> bool {
        input >= self.inputs || self.initial.get(output * self.inputs + input).is_none_or(|may| *may)
    }

    /// True if the output at this position in the setup changes at events only.
    #[must_use]
    pub fn is_discrete(&self, output: usize) -> bool {
        self.discrete.get(output).is_some_and(|is| *is)
    }
}

/// FMI 2.0.5, §2.2.8, and FMI 3.0.2, §2.4.8: dependencies list inputs and states, not parameters.
fn may_follow(it: &ModelDescription, output: usize, input: usize) -> bool {
    let is_input = it.variables[input].causality == Causality::Input;
    !is_input || is_among(it, &it.structure.outputs, output, input)
}

/// FMI 2.0.4, §2.2.8, and FMI 3.0.1, §2.4.8: a variable started by its own value is not an initial unknown.
fn may_follow_at_start(it: &ModelDescription, output: usize, input: usize) -> bool {
    it.variables[output].initial != Some(Initial::Exact) && is_among(it, &it.structure.initial_unknowns, output, input)
}

/// True if the unknown `output` may depend on `input`, according to `unknowns`.
fn is_among(it: &ModelDescription, unknowns: &[Unknown], output: usize, input: usize) -> bool {
    let of_output = unknowns.iter().filter(|unknown| are_one(it, unknown.variable, output));
    let mut said = of_output.filter_map(|unknown| unknown.dependencies.as_ref());
    said.next().is_none_or(|all| all.iter().any(|(variable, _)| are_one(it, *variable, input)))
}

/// True if the library cannot distinguish two variables. In FMI 2.0 enumerations share the value references of the integers.
fn are_one(it: &ModelDescription, one: usize, other: usize) -> bool {
    let name = |at: usize| {
        let variable = &it.variables[at];
        let is_enumeration = variable.data_type == DataType::Enumeration;
        (if is_enumeration { DataType::Int32 } else { variable.data_type }, variable.value_reference)
    };
    one == other || (it.version == Version::Two && name(one) == name(other))
}
