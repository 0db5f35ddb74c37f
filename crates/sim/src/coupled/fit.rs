//! Units and types of values exchanged between FMUs.
use super::block::Part;
use servobench_coupling::{Connection, Member};
use servobench_fmi::{Choice as _, DataType, DeclaredNumber, DeclaredUnit, FmuEntry, FmuMistake};
use servobench_scenario::Scenario;

/// Mismatches between FMUs, each at the index of the FMU with the input.
#[derive(Debug, Default)]
pub(super) struct Misfits {
    /// Values that cannot be exchanged.
    pub(super) mistakes: Vec<(usize, FmuMistake)>,
    /// Values that may not be intended.
    pub(super) doubts: Vec<(usize, FmuMistake)>,
}

impl Misfits {
    /// Mismatches of the connections between two FMUs of `scenario`, which are the `members`.
    pub(super) fn of(scenario: &Scenario, members: &[Member<Part>], connections: &[Connection]) -> Self {
        let mut found = Self::default();
        for Connection { from, to, .. } in connections {
            let (Some(source), Some(destination)) = (members.get(from.block), members.get(to.block)) else { continue };
            let (Part::Fmu(giver), Part::Fmu(taker)) = (&source.block, &destination.block) else { continue };
            let (Some(output), Some(input)) =
                (giver.slave.declared_output(from.port), taker.slave.declared_input(to.port))
            else {
                continue;
            };
            let variable = &scenario.fmus[to.block].inputs[to.port].0;
            let names = [format!("{}.{}", source.name, source.outputs[from.port]), variable.clone()];
            let at = |(message, help): (String, &str)| {
                (to.block, FmuMistake { at: FmuEntry::Input(variable.clone()), message, help: help.to_owned() })
            };
            found.mistakes.extend(types(&names, output, input).or_else(|| units(&names, output, input)).map(at));
            found.doubts.extend(without_unit(&names, output, input).map(at));
        }
        found
    }
}

/// A type that the input cannot take.
fn types([from, to]: &[String; 2], output: &DeclaredNumber, input: &DeclaredNumber) -> Option<(String, &'static str)> {
    let (gives, takes) = (output.data_type, input.data_type);
    let is_wrong = match (gives, takes) {
        (gives, takes) if gives.is_float() => !takes.is_float(),
        (DataType::Boolean, DataType::Enumeration) | (DataType::Enumeration, DataType::Boolean) => true,
        _ => false,
    };
    is_wrong.then(|| {
        let message = format!("`{to}` is of type {}, and `{from}` of type {}", takes.name(), gives.name());
        (message, "connect variables of one type")
    })
}

/// Units of different quantities.
fn units([from, to]: &[String; 2], output: &DeclaredNumber, input: &DeclaredNumber) -> Option<(String, &'static str)> {
    let (Some(gives), Some(takes)) = (&output.unit, &input.unit) else { return None };
    (!gives.measures_the_same_as(takes)).then(|| {
        let (DeclaredUnit { name: given, .. }, DeclaredUnit { name: taken, .. }) = (gives, takes);
        let message = format!("`{to}` counts in `{taken}`, into which `{given}` of `{from}` cannot be turned");
        (message, "connect what it is a measure of")
    })
}

/// A number without a unit for one with a unit, or the reverse.
fn without_unit(
    [from, to]: &[String; 2],
    output: &DeclaredNumber,
    input: &DeclaredNumber,
) -> Option<(String, &'static str)> {
    let (bare, counted, unit) = match (&output.unit, &input.unit) {
        (None, Some(unit)) if output.data_type.is_float() => (from, to, unit),
        (Some(unit), None) if input.data_type.is_float() => (to, from, unit),
        _ => return None,
    };
    let message =
        format!("`{bare}` has no unit, and `{counted}` counts in `{}`: it is taken to count in SI units", unit.name);
    Some((message, "export the FMU with a unit for it"))
}
