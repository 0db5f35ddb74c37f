//! The plant of a scenario: mechanics, power stage and sensors, without the firmware.
use crate::coupled::replaces_the_drive;
use crate::error::BuildError;
use servobench_drive::Stage;
use servobench_plant::{
    self as plant, BodyState, Chain, EndStops, Engine, Mechanics, MechanicsSetup, ModelKind, PowerStage, Switches,
    inverter,
};
use servobench_scenario::{Actuator, AxisMechanics, Scenario};

/// The mechanics at tick 0 and the names of its bodies.
pub(crate) fn mechanics(
    scenario: &Scenario,
    engine: &dyn Engine,
) -> Result<(Box<dyn Mechanics>, Vec<String>), BuildError> {
    let drive = match scenario.actuator {
        Actuator::Prescribed => plant::Drive::Prescribed,
        Actuator::Off(_) | Actuator::Pmsm { .. } | Actuator::IdealSource { .. } => plant::Drive::Effort,
    };
    if engine.name().simulates(ModelKind::Fmu) {
        let model = scenario.axis.fmu.clone().ok_or(BuildError::NoFmu { engine: engine.name() })?;
        let names = if model.load.is_some() { &["motor", "load"][..] } else { &["motor"] };
        let names = names.iter().map(|name| (*name).to_owned()).collect();
        let model = plant::Model::Fmu(Box::new(model));
        let setup = MechanicsSetup { model, drive, step: scenario.base_rate.period(), initial: Vec::new() };
        return Ok((engine.build(&setup)?, names));
    }
    let (model, names): (_, Vec<&str>) = match &scenario.axis.mechanics {
        AxisMechanics::Bodies(chain) => {
            let names = chain.bodies().iter().map(|body| body.name).collect();
            (plant::Model::Chain(checked(chain)?), names)
        }
        AxisMechanics::InTheFmu => return Err(BuildError::OnlyAnFmu { engine: engine.name() }),
        AxisMechanics::Mjcf(mjcf) => {
            let (motor, load) = (scenario.axis.motor_motion, scenario.axis.motion);
            let axis = Some(plant::MjcfAxis { motor, load, max_effort: max_effort(scenario) });
            let names = if mjcf.motor_joint == mjcf.load_joint { vec!["motor"] } else { vec!["motor", "load"] };
            (plant::Model::Mjcf(plant::MjcfModel { axis, ..mjcf.clone() }), names)
        }
    };
    let names: Vec<String> = names.into_iter().map(str::to_owned).collect();
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

/// Largest effort that the drive requests; 0 without a drive, or if FMUs replace it and the effort is unknown.
fn max_effort(scenario: &Scenario) -> f64 {
    match scenario.actuator {
        Actuator::Prescribed | Actuator::Off(_) => 0.0,
        _ if replaces_the_drive(scenario) => 0.0,
        Actuator::Pmsm { .. } | Actuator::IdealSource { .. } => scenario.actuator.max_effort(),
    }
}

/// The chain, checked again because it may have been changed since it was made.
pub(crate) fn checked(chain: &Chain) -> Result<Chain, BuildError> {
    chain.check()?;
    Ok(chain.clone())
}

/// The stops at the ends of the travel, checked with the inertia of the load where it is known.
pub(super) fn end_stops(scenario: &Scenario) -> Result<Option<EndStops>, BuildError> {
    if let Some(stops) = &scenario.axis.end_stops {
        let inertia = match &scenario.axis.mechanics {
            AxisMechanics::Bodies(chain) => {
                chain.bodies().last().map(|load| load.inertia / (load.transmission * load.transmission))
            }
            AxisMechanics::Mjcf(_) | AxisMechanics::InTheFmu => None,
        };
        stops.check(scenario.base_rate.period(), inertia)?;
    }
    Ok(scenario.axis.end_stops)
}

pub(super) fn switches(scenario: &Scenario) -> Result<Switches, BuildError> {
    let normally_closed = scenario.bus.as_ref().is_some_and(|bus| bus.reverse_switches);
    let switches = Switches { normally_closed, ..scenario.axis.switches.clone() };
    switches.check()?;
    Ok(switches)
}

/// The power stage that turns the drive's command into effort, with the motor at `speed` (its own coordinate, per second), in
/// ticks of `h` (s).
pub(super) fn power_stage(actuator: &Actuator, speed: f64, h: f64) -> Result<PowerStage, BuildError> {
    Ok(match actuator {
        Actuator::Prescribed | Actuator::Off(None) => PowerStage::OFF,
        Actuator::Off(Some(idle)) => PowerStage::pmsm(idle.motor, 0.0, speed, h)?.with_effects(&idle.effects, h)?,
        Actuator::IdealSource { source, .. } => PowerStage::ideal(source),
        Actuator::Pmsm { motor, effects, wiring, dc_link, inverter, link, drive, .. } => {
            let mut stage =
                PowerStage::pmsm(*motor, *dc_link, speed, h)?.with_effects(effects, h)?.with_wiring(*wiring)?;
            if inverter.is_some() || link.is_some() {
                stage = stage.with_inverter(&inverter.unwrap_or(inverter::Params::IDEAL), link.as_ref(), h)?;
            }
            match (drive.current_sensor, &drive.params.stage) {
                (Some(sensor), Stage::Current { every, .. }) => stage.with_current_sensor(sensor, *every, h)?,
                _ => stage,
            }
        }
    })
}
