//! Users' MJCF files in Rapier against closed forms and against chains.
mod agreement;
mod geoms;
mod hinges;
mod mujoco;
mod refusals;
mod slides;
mod subset;

use servobench_engine_rapier::Rapier;
use servobench_plant::{
    Actuation, BodyState, Drive, Engine, Input, Mechanics, MechanicsError, MechanicsSetup, MjcfModel, Model,
};

/// Tick length (s).
const H: f64 = 1.0 / 16_000.0;

/// The file with motor joint `m`, load joint `load` and actuator `u`.
fn file(xml: &str, load: &str) -> MjcfModel {
    MjcfModel {
        xml: xml.into(),
        path: "axis.xml".into(),
        motor_joint: "m".into(),
        load_joint: load.into(),
        actuator: "u".into(),
        transmission: 1.0,
        axis: None,
        is_smooth: false,
    }
}

fn try_build(file: MjcfModel, step: f64, initial: Vec<BodyState>) -> Result<Box<dyn Mechanics>, MechanicsError> {
    Rapier.build(&MechanicsSetup { model: Model::Mjcf(file), drive: Drive::Effort, step, initial })
}

fn build(xml: &str, load: &str, step: f64, initial: Vec<BodyState>) -> Box<dyn Mechanics> {
    try_build(file(xml, load), step, initial).unwrap()
}

/// `<mujoco>` with this in its world, radians, no gravity, and motor `u` on joint `m`.
fn world(bodies: &str) -> String {
    format!(
        r#"<mujoco><compiler angle="radian"/><option gravity="0 0 0"/><worldbody>{bodies}</worldbody>
        <actuator><motor name="u" joint="m"/></actuator></mujoco>"#
    )
}

fn effort(effort: f64) -> Input {
    Input { actuation: Actuation::Effort(effort), motor_disturbance: 0.0, load_disturbance: 0.0 }
}

fn state(position: f64, velocity: f64) -> BodyState {
    BodyState { position, velocity }
}
