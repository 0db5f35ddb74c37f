//! FMUs of a scenario as the plant and the coupling take them.
use crate::channels::Equipment;
use crate::error::BuildError;
use servobench_plant::{
    Extrapolation, FmuBody, FmuFile, FmuModel, FmuPartner, FmuPort, FmuStart, FmuValue, Isolation, SiUnit,
};
use servobench_scenario::{self as scenario, BodySignal, Fmu, LoopSignal, Motion, Scenario, Signal, StartValue};
use servobench_trace::ChannelSpec;
use std::time::Duration;

/// Which variables of an FMU are the mechanics.
pub(super) fn mechanics(fmu: &Fmu<BodySignal>, scenario: &Scenario) -> Result<FmuModel, BuildError> {
    let axis = &scenario.axis;
    let input = |channel: &'static str, unit| {
        let given = fmu.inputs.iter().find(|(_, signal)| *signal == Signal::Channel(channel));
        given.map(|(variable, _)| port(variable, unit))
    };
    let body = |motion, position, velocity| {
        let output = |signal, unit: String| {
            fmu.outputs.iter().find(|(_, to)| *to == signal).map(|(variable, _)| port(variable, &unit))
        };
        let unit = length_unit(motion);
        Some(FmuBody { position: output(position, unit.to_owned())?, velocity: output(velocity, format!("{unit}/s")) })
    };
    let (motor_effort, load_effort) = (effort_unit(axis.motor_motion), effort_unit(axis.motion));
    Ok(FmuModel {
        file: file(fmu),
        effort: input("effort.motor", motor_effort).ok_or(BuildError::NoFmu)?,
        motor: body(axis.motor_motion, BodySignal::ShaftPosition, BodySignal::ShaftVelocity)
            .ok_or(BuildError::NoFmu)?,
        load: body(axis.motion, BodySignal::LoadPosition, BodySignal::LoadVelocity),
        motor_disturbance: input("disturbance.motor", motor_effort),
        load_disturbance: input("disturbance.load", load_effort),
        transmission: axis.transmission,
        ticks: fmu.every,
        extrapolation: Extrapolation::Linear,
    })
}

/// An FMU beside the axis, of whose outputs `outputs` are wanted, each with what it is if it goes to the axis. `channels` are those
/// that FMUs are given; its steps are `step` (s) long, and the last one ends at `end` (s).
pub(crate) fn partner(
    fmu: &Fmu<LoopSignal>,
    outputs: &[(&str, Option<LoopSignal>)],
    (equipment, motor_motion): (&Equipment, Motion),
    channels: &[ChannelSpec],
    (step, end): (f64, f64),
) -> FmuPartner {
    let shaft = length_unit(motor_motion);
    let given = |signal: &Signal| match signal {
        Signal::Time => "s".to_owned(),
        Signal::ShaftPosition => shaft.to_owned(),
        Signal::ShaftVelocity => format!("{shaft}/s"),
        Signal::Channel(name) => channels
            .iter()
            .find(|channel| channel.name == *name)
            .map_or_else(String::new, |channel| channel.unit.clone()),
        Signal::Fmu { .. } => String::new(),
    };
    let taken = |signal: LoopSignal| match signal {
        LoopSignal::MotorEffort | LoopSignal::Effort => equipment.effort_unit.to_owned(),
        LoopSignal::LoadEffort => equipment.load_effort_unit.to_owned(),
        LoopSignal::SetpointPosition => equipment.axis_unit.to_owned(),
        LoopSignal::SetpointVelocity => format!("{}/s", equipment.axis_unit),
        LoopSignal::SetpointAcceleration => format!("{}/s²", equipment.axis_unit),
        LoopSignal::VoltageD | LoopSignal::VoltageQ => "V".to_owned(),
    };
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

const fn length_unit(motion: Motion) -> &'static str {
    match motion {
        Motion::Linear => "m",
        Motion::Rotary => "rad",
    }
}

const fn effort_unit(motion: Motion) -> &'static str {
    match motion {
        Motion::Linear => "N",
        Motion::Rotary => "N m",
    }
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
