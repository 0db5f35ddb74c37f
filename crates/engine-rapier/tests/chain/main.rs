//! Chains in Rapier against the engine `exact`, and what is Rapier's own. Closed forms: `tests/contract.rs`.
mod agreement;
mod allocation;
mod refusals;
mod rotation;

use servobench_base::Coordinate;
use servobench_base::Setpoint;
use servobench_engine_rapier::Rapier;
use servobench_plant::{
    Actuation, Body, BodyState, Chain, Drive, Engine, Friction, Input, Link, Mechanics, MechanicsSetup, Model,
};

/// Tick length (s): the 16 kHz of the project's speed and accuracy bars.
const H: f64 = 1.0 / 16_000.0;

fn body(inertia: f64) -> Body {
    Body {
        name: "body",
        coordinate: Coordinate::Linear,
        inertia,
        transmission: 1.0,
        friction: Friction::NONE,
        bias: 0.0,
    }
}

fn viscous(viscous: f64) -> Friction {
    Friction { viscous, ..Friction::NONE }
}

fn build(chain: &Chain, drive: Drive, step: f64, initial: Vec<BodyState>) -> Box<dyn Mechanics> {
    Rapier.build(&MechanicsSetup { model: Model::Chain(chain.clone()), drive, step, initial }).unwrap()
}

fn effort(effort: f64) -> Input {
    Input { actuation: Actuation::Effort(effort), motor_disturbance: 0.0, load_disturbance: 0.0 }
}

fn motion(setpoint: Setpoint) -> Input {
    Input { actuation: Actuation::Motion(setpoint), motor_disturbance: 0.0, load_disturbance: 0.0 }
}

fn state(position: f64, velocity: f64) -> BodyState {
    BodyState { position, velocity }
}

/// Saarakkala/Hinkkanen: J_M = J_L = 0.005 kg·m², K_s = 700 N·m/rad.
fn two_mass(damping: f64) -> Chain {
    let rotor = Body { coordinate: Coordinate::Rotary, ..body(5e-3) };
    Chain::new(vec![rotor.clone(), rotor], vec![Link { stiffness: 700.0, damping }]).unwrap()
}

/// Lambrechts: 20/10 kg, 6e5 N/m, 500 N·s/m, 10 N·s/m against the ground on both.
fn lambrechts() -> Chain {
    let slide = |mass| Body { friction: viscous(10.0), ..body(mass) };
    Chain::new(vec![slide(20.0), slide(10.0)], vec![Link { stiffness: 6e5, damping: 500.0 }]).unwrap()
}

/// A servo motor on a ball screw of 10 mm lead, a table and a flexible load: modes at 90 Hz, 266 Hz, 681 Hz.
fn feed_axis() -> Chain {
    let lead = 10e-3 / (2.0 * std::f64::consts::PI);
    let motor = Body { coordinate: Coordinate::Rotary, transmission: lead, friction: viscous(1e-3), ..body(6e-4) };
    let screw = Body { friction: viscous(100.0), ..body(60.0) };
    let table = Body { friction: viscous(200.0), bias: 5.0, ..body(40.0) };
    let load = Body { friction: viscous(20.0), ..body(25.0) };
    let link = |stiffness, damping| Link { stiffness, damping };
    Chain::new(vec![motor, screw, table, load], vec![link(8e8, 4e4), link(1e8, 2e4), link(8e6, 2e3)]).unwrap()
}
