//! The engine against closed forms and the engine `exact`. What every engine promises: `tests/contract.rs`.

mod base;
mod failures;
mod friction;
mod mjcf;

use servobench_base::Coordinate;
use servobench_engine_mujoco::Mujoco;
use servobench_plant::{
    Actuation, Body, BodyState, Chain, Drive, Engine as _, Friction, Input, Link, Mechanics, MechanicsSetup, MjcfModel,
    Model, chain_to_mjcf,
};

/// Tick length of a 16 kHz bench (s).
const STEP: f64 = 1.0 / 16_000.0;

/// A body without friction.
fn body(name: &'static str, coordinate: Coordinate, inertia: f64) -> Body {
    let (transmission, friction, bias) = (1.0, Friction::NONE, 0.0);
    Body { name, coordinate, inertia, transmission, friction, bias }
}

/// The two-mass drive of Saarakkala and Hinkkanen: 0.005 kg·m² on each side of 700 N·m/rad, here without damping.
fn two_mass() -> Chain {
    let rotary = |name| body(name, Coordinate::Rotary, 0.005);
    let link = Link { stiffness: 700.0, damping: 0.0 };
    Chain::new(vec![rotary("motor"), rotary("load")], vec![link]).unwrap()
}

/// 84.22 Hz: both masses swing against each other.
fn free_omega() -> f64 {
    (700.0_f64 * (2.0 / 0.005)).sqrt()
}

fn setup(chain: Chain, drive: Drive, step: f64, initial: &[(f64, f64)]) -> MechanicsSetup {
    let state = |&(position, velocity): &(f64, f64)| BodyState { position, velocity };
    let initial = initial.iter().map(state).collect();
    MechanicsSetup { model: Model::Chain(chain), drive, step, initial }
}

fn mujoco(chain: Chain, drive: Drive, step: f64, initial: &[(f64, f64)]) -> Box<dyn Mechanics> {
    Mujoco.build(&setup(chain, drive, step, initial)).unwrap()
}

/// The chain as a user's own MJCF file, for which the stability of RK4 is not checked.
fn unchecked(chain: &Chain, step: f64, initial: &[(f64, f64)]) -> Box<dyn Mechanics> {
    let model = Model::Mjcf(MjcfModel {
        xml: chain_to_mjcf(chain, Drive::Effort, step),
        path: "chain.xml".into(),
        motor_joint: "motor".into(),
        load_joint: "load".into(),
        actuator: "motor_effort".into(),
        transmission: 1.0,
        axis: None,
        is_smooth: false,
    });
    Mujoco.build(&MechanicsSetup { model, ..setup(two_mass(), Drive::Effort, step, initial) }).unwrap()
}

/// Drive effort and load disturbance.
fn efforts(effort: f64, load_disturbance: f64) -> Input {
    Input { actuation: Actuation::Effort(effort), motor_disturbance: 0.0, load_disturbance }
}

fn motion(setpoint: servobench_base::Setpoint) -> Input {
    Input { actuation: Actuation::Motion(setpoint), motor_disturbance: 0.0, load_disturbance: 0.0 }
}

/// Ticks that a time takes.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "small and positive")]
fn ticks(time: f64, step: f64) -> usize {
    (time / step).round() as usize
}
