//! The plant of a scenario: mechanics, power stage and sensors. Nothing here knows of the firmware.
use crate::coupled::replaces_the_drive;
use crate::error::BuildError;
use crate::power::PowerStage;
use servobench_base::{Dq, Rotation};
use servobench_plant::{self as plant, BodyState, Chain, Encoder, Engine, Mechanics, MechanicsSetup, Switches, pmsm};
use servobench_scenario::{self as scenario, Actuator, EngineName, Scenario};
use std::sync::Arc;

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
        let model = super::fmu::mechanics(fmu, scenario)?;
        let names = if model.load.is_some() { &["motor", "load"][..] } else { &["motor"] };
        let names = names.iter().map(|name| (*name).to_owned()).collect();
        let model = plant::Model::Fmu(Box::new(model));
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
                axis: Some(plant::MjcfAxis {
                    motor: scenario.axis.motor_motion,
                    load: scenario.axis.motion,
                    max_effort: max_effort(scenario),
                }),
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

/// Largest effort that the drive asks for; 0 where there is none, or where FMUs are the drive and nobody can tell.
fn max_effort(scenario: &Scenario) -> f64 {
    match scenario.actuator {
        Actuator::Prescribed | Actuator::Off => 0.0,
        _ if replaces_the_drive(scenario) => 0.0,
        Actuator::Pmsm { .. } | Actuator::IdealSource { .. } => scenario.actuator.max_effort(),
    }
}

pub(crate) fn chain(axis: &scenario::Axis, bodies: &[scenario::Body]) -> Result<Chain, BuildError> {
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
            coordinate: if i == 0 { axis.motor_motion } else { axis.motion },
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

pub(super) fn switches(scenario: &scenario::Scenario) -> Result<Switches, BuildError> {
    let scenario::Switches { negative, positive, home, index } = scenario.axis.switches;
    let home = home.map(|home| home.from..=home.to);
    let normally_closed = scenario.bus.as_ref().is_some_and(|bus| bus.reverse_switches);
    let switches = Switches { negative, positive, home, index, normally_closed };
    switches.check()?;
    Ok(switches)
}

/// What turns the drive's command into effort, with the motor at `speed` (its own coordinate, per second), in
/// ticks of `h` (s).
pub(super) fn power_stage(actuator: &Actuator, speed: f64, h: f64) -> Result<PowerStage, BuildError> {
    match actuator {
        Actuator::Prescribed | Actuator::Off => Ok(PowerStage::Off),
        Actuator::IdealSource { source, .. } => Ok(PowerStage::Ideal { gain: source.gain, limit: source.limit }),
        Actuator::Pmsm { motor, dc_link, .. } => {
            let params = synchronous_motor(motor);
            params.check()?;
            Ok(PowerStage::Pmsm {
                motor: Arc::new(pmsm::Ticks::new(params, h)),
                state: pmsm::State::default(),
                u_dc: *dc_link,
                last_speed: speed,
                rotor: Rotation::default(),
                shortens: false,
                voltage: Dq::default(),
                power: Some(pmsm::Power::default()),
            })
        }
    }
}

pub(crate) fn synchronous_motor(motor: &scenario::Pmsm) -> pmsm::Params {
    pmsm::Params {
        pole_pairs: motor.electrical_ratio,
        resistance: motor.resistance,
        inductance: Dq { d: motor.inductance_d, q: motor.inductance_q },
        flux_linkage: motor.flux_linkage,
    }
}
