//! FMUs of a scenario as the plant and the coupling take them.
use servobench_base::Coordinate;
use servobench_plant::{
    Extrapolation, FmuBody, FmuFile, FmuModel, FmuPartner, FmuPort, FmuStart, FmuValue, Isolation, SiUnit,
};
use servobench_scenario::{self as scenario, BodySignal, Fmu, InputSource, LoopSignal, Scenario, StartValue};
use servobench_signals::{Equipment, Signal};
use std::time::Duration;

/// Which variables of an FMU are the mechanics.
pub(super) fn mechanics(fmu: &Fmu<BodySignal>, scenario: &Scenario) -> Option<FmuModel> {
    let axis = &scenario.axis;
    let input = |signal, unit| {
        let given = fmu.inputs.iter().find(|(_, source)| *source == InputSource::Signal(signal));
        given.map(|(variable, _)| port(variable, unit))
    };
    let body = |motion: Coordinate, position, velocity| {
        let output = |signal, unit: String| {
            fmu.outputs.iter().find(|(_, to)| *to == signal).map(|(variable, _)| port(variable, &unit))
        };
        let unit = motion.unit();
        Some(FmuBody { position: output(position, unit.to_owned())?, velocity: output(velocity, format!("{unit}/s")) })
    };
    let (motor_effort, load_effort) = (axis.motor_motion.effort_unit(), axis.motion.effort_unit());
    Some(FmuModel {
        file: file(fmu),
        effort: input(Signal::EffortMotor, motor_effort)?,
        motor: body(axis.motor_motion, BodySignal::ShaftPosition, BodySignal::ShaftVelocity)?,
        load: body(axis.motion, BodySignal::LoadPosition, BodySignal::LoadVelocity),
        motor_disturbance: input(Signal::DisturbanceMotor, motor_effort),
        load_disturbance: input(Signal::DisturbanceLoad, load_effort),
        transmission: axis.transmission,
        ticks: fmu.every,
        extrapolation: Extrapolation::Linear,
    })
}

/// An FMU beside the axis, of whose outputs `outputs` are wanted, each with what it is if it goes to the axis. Its steps are `step` (s) long, and the last one ends at `end` (s).
pub(crate) fn partner(
    fmu: &Fmu<LoopSignal>,
    outputs: &[(&str, Option<LoopSignal>)],
    (equipment, motor_motion): (&Equipment, Coordinate),
    (step, end): (f64, f64),
) -> FmuPartner {
    let shaft = motor_motion.unit();
    let given = |source: &InputSource| match source {
        InputSource::Time => "s".to_owned(),
        InputSource::ShaftPosition => shaft.to_owned(),
        InputSource::ShaftVelocity => format!("{shaft}/s"),
        InputSource::Signal(signal) => signal.unit().symbol(equipment),
        InputSource::Fmu { .. } => String::new(),
    };
    let taken = |taken: LoopSignal| taken.signal().unit().symbol(equipment);
    FmuPartner {
        file: file(fmu),
        name: fmu.name.clone(),
        inputs: fmu.inputs.iter().map(|(variable, signal)| port(variable, &given(signal))).collect(),
        outputs: outputs
            .iter()
            .map(|(variable, signal)| port(variable, &signal.map_or_else(String::new, taken)))
            .collect(),
        step,
        end,
    }
}

fn file<To>(fmu: &Fmu<To>) -> FmuFile {
    FmuFile {
        path: fmu.path.clone(),
        start: fmu.start.iter().map(|(variable, value)| start(variable, value)).collect(),
        event_mode: fmu.event_mode,
        isolation: match fmu.isolation {
            scenario::Isolation::None => Isolation::None,
            scenario::Isolation::Process => Isolation::Process {
                patience: Duration::from_secs_f64(fmu.patience),
                memory: u64::from(fmu.memory) * 1_000_000,
            },
        },
    }
}

/// A start value; what has a unit is converted to that of its variable.
fn start(variable: &str, value: &StartValue) -> FmuStart {
    let mut values = Vec::new();
    flatten(value, &mut values);
    FmuStart { variable: variable.to_owned(), values }
}

fn flatten(value: &StartValue, values: &mut Vec<FmuValue>) {
    values.push(match value {
        StartValue::Number(number) => FmuValue::Number(*number),
        StartValue::Flag(flag) => FmuValue::Boolean(*flag),
        StartValue::Text(text) => match scenario::any_quantity(text) {
            Some((si, exponents)) => FmuValue::Quantity { text: text.clone(), si, exponents },
            None => FmuValue::Text(text.clone()),
        },
        StartValue::List(list) => return list.iter().for_each(|value| flatten(value, values)),
    });
}

fn port(variable: &str, unit: &str) -> FmuPort {
    FmuPort { variable: variable.to_owned(), unit: si_unit(unit) }
}

/// The SI unit of this name; `None` for what has none.
fn si_unit(name: &str) -> Option<SiUnit> {
    let (_, exponents) = scenario::any_quantity(&format!("1 {name}"))?;
    Some(SiUnit { name: name.to_owned(), exponents })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: the definitions of the units.
    #[test]
    fn units_of_channels_are_known() {
        for (name, exponents) in [
            ("m", [0, 1, 0, 0]),
            ("rad", [0; 4]),
            ("m/s", [0, 1, -1, 0]),
            ("rad/s²", [0, 0, -2, 0]),
            ("m/s⁴", [0, 1, -4, 0]),
            ("N", [1, 1, -2, 0]),
            ("N m", [1, 2, -2, 0]),
            ("A", [0, 0, 0, 1]),
            ("V", [1, 2, -3, -1]),
            ("s", [0, 0, 1, 0]),
        ] {
            assert_eq!(si_unit(name).map(|unit| unit.exponents), Some(exponents), "{name}");
        }
        assert_eq!(si_unit(""), None);
    }
}
