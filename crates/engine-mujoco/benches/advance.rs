//! Cost of `advance` above the bare engine step of the same model: two masses at 16 kHz.
//!
//! `MUJOCO_DYNAMIC_LINK_DIR=<target>/native/lib cargo bench -p servobench-engine-mujoco`

use mujoco_rs::prelude::{MjModel, MjtDisableBit};
use servobench_base::Coordinate;
use servobench_base::Setpoint;
use servobench_engine_mujoco::Mujoco;
use servobench_plant::{
    Actuation, Body, Chain, Drive, Engine as _, Friction, Input, Link, Mechanics, MechanicsSetup, Model, chain_to_mjcf,
};

const STEP: f64 = 1.0 / 16_000.0;
/// Steps per sample: 62.5 ms of the axis.
const STEPS: usize = 1000;

/// Counts the allocations of each benchmark: there must be none.
#[global_allocator]
static ALLOCATOR: divan::AllocProfiler = divan::AllocProfiler::system();

fn main() {
    divan::main();
}

/// The motor-load system of Lambrechts (2004), with or without Coulomb friction.
fn chain(coulomb: f64) -> Chain {
    let friction = Friction { viscous: 10.0, ..Friction::coulomb(coulomb) };
    let body =
        |name, inertia| Body { name, coordinate: Coordinate::Linear, inertia, transmission: 1.0, friction, bias: 0.0 };
    Chain::new(vec![body("motor", 20.0), body("load", 10.0)], vec![Link { stiffness: 6e5, damping: 500.0 }]).unwrap()
}

fn mechanics(coulomb: f64, drive: Drive) -> Box<dyn Mechanics> {
    let model = Model::Chain(chain(coulomb));
    Mujoco.build(&MechanicsSetup { model, drive, step: STEP, initial: Vec::new() }).unwrap()
}

fn thousand_ticks(bencher: divan::Bencher, mut mechanics: Box<dyn Mechanics>, actuation: Actuation) {
    let input = Input { actuation, motor_disturbance: 0.0, load_disturbance: 0.0 };
    bencher.counter(STEPS).bench_local(|| {
        for _ in 0..STEPS {
            mechanics.advance(divan::black_box(&input)).unwrap();
        }
    });
}

#[divan::bench]
fn bare_step(bencher: divan::Bencher) {
    let mut model = MjModel::from_xml_string(&chain_to_mjcf(&chain(0.0), Drive::Effort, STEP)).unwrap();
    for unused in [
        MjtDisableBit::mjDSBL_CONSTRAINT,
        MjtDisableBit::mjDSBL_CONTACT,
        MjtDisableBit::mjDSBL_GRAVITY,
        MjtDisableBit::mjDSBL_ACTUATION,
        MjtDisableBit::mjDSBL_SENSOR,
    ] {
        model.opt_mut().disableflags |= unused as i32;
    }
    let mut data = model.make_data();
    data.qfrc_applied_mut()[0] = 1.0;
    bencher.counter(STEPS).bench_local(|| (0..STEPS).for_each(|_| data.step()));
}

#[divan::bench]
fn effort(bencher: divan::Bencher) {
    thousand_ticks(bencher, mechanics(0.0, Drive::Effort), Actuation::Effort(1.0));
}

#[divan::bench]
fn effort_with_friction(bencher: divan::Bencher) {
    thousand_ticks(bencher, mechanics(2.0, Drive::Effort), Actuation::Effort(30.0));
}

#[divan::bench]
fn prescribed(bencher: divan::Bencher) {
    let actuation = Actuation::Motion(Setpoint { v: 0.1, ..Setpoint::default() });
    thousand_ticks(bencher, mechanics(0.0, Drive::Prescribed), actuation);
}
