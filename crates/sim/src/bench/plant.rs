//! The plant of a scenario: mechanics, power stage and sensors. Nothing here knows of the firmware.
use crate::error::BuildError;
use crate::power::PowerStage;
use servobench_base::{Dq, Rotation};
use servobench_plant::{self as plant, BodyState, Chain, Encoder, Engine, Mechanics, MechanicsSetup, Switches, pmsm};
use servobench_scenario::{self as scenario, Actuator, BodySignal, EngineName, Scenario, Signal, StartValue};
use std::time::Duration;

/// The mechanics at tick 0 and the names of its bodies.
pub(super) fn mechanics(
    scenario: &Scenario,
    engine: &dyn Engine,
) -> Result<(Box<dyn Mechanics>, Vec<String>), BuildError> {
    let drive = match scenario.actuator {
        Actuator::Prescribed => plant::Drive::Prescribed,
        Actuator::Off | Actuator::Pmsm { .. } | Actuator::IdealSource { .. } => plant::Drive::Effort,
    };
    if engine.name() == EngineName::Fmu.as_str() {
        let fmu = scenario.axis.fmu.as_ref().ok_or(BuildError::NoFmu)?;
        let model = fmu_model(fmu, scenario)?;
        let names = if model.load.is_some() { &["motor", "load"][..] } else { &["motor"] };
        let names = names.iter().map(|name| (*name).to_owned()).collect();
        let model = plant::Model::Fmu(model);
        let setup = MechanicsSetup { model, drive, step: scenario.base_rate.period(), initial: Vec::new() };
        return Ok((engine.build(&setup)?, names));
    }
    let (model, names) = match &scenario.axis.mechanics {
        scenario::AxisMechanics::Bodies(bodies) => {
            let names: Vec<String> = bodies.iter().map(|body| body.name.to_owned()).collect();
            (plant::Model::Chain(chain(&scenario.axis, bodies)?), names)
        }
        scenario::AxisMechanics::InTheFmu => return Err(BuildError::OnlyAnFmu { engine: engine.name() }),
        scenario::AxisMechanics::Mjcf(mjcf) => {
            let model = plant::MjcfModel {
                xml: mjcf.xml.clone(),
                path: mjcf.path.clone(),
                motor_joint: mjcf.motor_joint.clone(),
                load_joint: mjcf.load_joint.clone(),
                actuator: mjcf.actuator.clone(),
                transmission: scenario.axis.transmission,
            };
            let names = if model.motor_joint == model.load_joint { &["motor"][..] } else { &["motor", "load"] };
            (plant::Model::Mjcf(model), names.iter().map(|name| (*name).to_owned()).collect())
        }
    };
    let mut initial = vec![BodyState::default(); names.len()];
    if let Some(load) = initial.last_mut() {
        *load = BodyState { position: scenario.initial.load_position, velocity: scenario.initial.load_velocity };
    }
    if let [motor] = initial.as_mut_slice() {
        motor.position /= scenario.axis.transmission;
        motor.velocity /= scenario.axis.transmission;
    }
    let setup = MechanicsSetup { model, drive, step: scenario.base_rate.period(), initial };
    Ok((engine.build(&setup)?, names))
}

/// Which variables of an FMU are the mechanics.
fn fmu_model(fmu: &scenario::Fmu<BodySignal>, scenario: &Scenario) -> Result<plant::FmuModel, BuildError> {
    let axis = &scenario.axis;
    let input = |channel: &'static str| {
        let given = fmu.inputs.iter().find(|(_, signal)| *signal == Signal::Channel(channel));
        given.map(|(variable, _)| fmu_port(variable))
    };
    let output = |signal| fmu.outputs.iter().find(|(_, to)| *to == signal).map(|(variable, _)| fmu_port(variable));
    let body = |motion, position, velocity| {
        let coordinate = coordinate(motion);
        output(position).map(|position| plant::FmuBody { coordinate, position, velocity: output(velocity) })
    };
    Ok(plant::FmuModel {
        path: fmu.path.clone(),
        effort: input("effort.motor").ok_or(BuildError::NoFmu)?,
        motor: body(axis.motor_motion, BodySignal::ShaftPosition, BodySignal::ShaftVelocity)
            .ok_or(BuildError::NoFmu)?,
        load: body(axis.motion, BodySignal::LoadPosition, BodySignal::LoadVelocity),
        motor_disturbance: input("disturbance.motor"),
        load_disturbance: input("disturbance.load"),
        transmission: axis.transmission,
        start: fmu_start(&fmu.start),
        ticks: fmu.every,
        extrapolation: match scenario.coupling.extrapolation {
            0 => plant::Extrapolation::Hold,
            1 => plant::Extrapolation::Linear,
            _ => plant::Extrapolation::Quadratic,
        },
        isolation: fmu_isolation(fmu),
    })
}

/// Start values of an FMU. What has a unit is converted to that of its variable.
#[must_use]
pub fn fmu_start(given: &[(String, StartValue)]) -> Vec<plant::FmuStart> {
    let mut all = Vec::new();
    for (variable, value) in given {
        let mut values = Vec::new();
        flatten(value, &mut values);
        all.push(plant::FmuStart { variable: variable.clone(), values });
    }
    all
}

fn flatten(value: &StartValue, values: &mut Vec<plant::FmuValue>) {
    values.push(match value {
        StartValue::Number(number) => plant::FmuValue::Number(*number),
        StartValue::Flag(flag) => plant::FmuValue::Boolean(*flag),
        StartValue::Text(text) => match scenario::any_quantity(text) {
            Some((si, exponents)) => plant::FmuValue::Quantity { text: text.clone(), si, exponents },
            None => plant::FmuValue::Text(text.clone()),
        },
        StartValue::List(list) => return list.iter().for_each(|value| flatten(value, values)),
    });
}

/// Where an FMU runs.
#[must_use]
pub fn fmu_isolation<To>(fmu: &scenario::Fmu<To>) -> plant::Isolation {
    match fmu.isolation {
        scenario::Isolation::None => plant::Isolation::None,
        scenario::Isolation::Process => plant::Isolation::Process {
            patience: Duration::from_secs_f64(fmu.patience),
            memory: u64::from(fmu.memory) << 20,
        },
    }
}

fn fmu_port(variable: &str) -> plant::FmuPort {
    plant::FmuPort { variable: variable.to_owned(), element: 0 }
}

fn coordinate(motion: scenario::Motion) -> plant::Coordinate {
    match motion {
        scenario::Motion::Linear => plant::Coordinate::Linear,
        scenario::Motion::Rotary => plant::Coordinate::Rotary,
    }
}

fn chain(axis: &scenario::Axis, bodies: &[scenario::Body]) -> Result<Chain, BuildError> {
    let links = bodies
        .iter()
        .filter_map(|body| body.coupling)
        .map(|coupling| plant::Link { stiffness: coupling.stiffness, damping: coupling.damping })
        .collect();
    let bodies = bodies
        .iter()
        .enumerate()
        .map(|(i, body)| plant::Body {
            name: body.name,
            coordinate: coordinate(if i == 0 { axis.motor_motion } else { axis.motion }),
            inertia: body.inertia,
            transmission: if i == 0 { axis.transmission } else { 1.0 },
            viscous: body.viscous,
            dry: plant::DryFriction {
                coulomb: body.coulomb,
                breakaway: body.breakaway,
                stribeck_velocity: body.stribeck_velocity,
            },
            bias: body.bias,
        })
        .collect();
    Ok(Chain::new(bodies, links)?)
}

pub(super) fn encoder(encoder: scenario::Encoder) -> Result<Encoder, BuildError> {
    let encoder = Encoder { increment: encoder.resolution };
    encoder.check()?;
    Ok(encoder)
}

pub(super) fn switches(switches: &scenario::Switches) -> Result<Switches, BuildError> {
    let scenario::Switches { negative, positive, home, index } = *switches;
    let switches = Switches { negative, positive, home: home.map(|home| home.from..=home.to), index };
    switches.check()?;
    Ok(switches)
}

/// What turns the drive's command into effort, with the motor at `speed` (its own coordinate, per second).
pub(super) fn power_stage(actuator: &Actuator, speed: f64) -> Result<PowerStage, BuildError> {
    match actuator {
        Actuator::Prescribed | Actuator::Off => Ok(PowerStage::Off),
        Actuator::IdealSource { source, .. } => Ok(PowerStage::Ideal { gain: source.gain, limit: source.limit }),
        Actuator::Pmsm { motor, dc_link, .. } => {
            let params = pmsm::Params {
                pole_pairs: motor.electrical_ratio,
                resistance: motor.resistance,
                inductance: Dq { d: motor.inductance_d, q: motor.inductance_q },
                flux_linkage: motor.flux_linkage,
            };
            params.check()?;
            Ok(PowerStage::Pmsm {
                params,
                state: pmsm::State::default(),
                u_dc: *dc_link,
                last_speed: speed,
                rotor: Rotation::default(),
                shortens: false,
            })
        }
    }
}
