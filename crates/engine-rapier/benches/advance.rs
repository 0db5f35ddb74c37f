//! Cost of a tick against the bare Rapier step of the same scene.
//!
//! `cargo bench -p servobench-engine-rapier`. The difference of the two is what servobench adds: efforts, half kicks,
//! dry friction, reading back. Both run alternately in one process, so that a busy machine slows both.
use divan::Bencher;
use rapier3d_f64::prelude::*;
use servobench_base::Coordinate;
use servobench_engine_rapier::Rapier;
use servobench_plant::{
    Actuation, Body, Chain, Drive, Engine, Friction, Input, Link, Mechanics, MechanicsSetup, MjcfModel, Model,
};
use std::hint::black_box;

const H: f64 = 1.0 / 16_000.0;

fn main() {
    divan::main();
}

/// A chain of `bodies` equal masses.
fn chain(bodies: usize, friction: Friction) -> Chain {
    let body = Body {
        name: "body",
        coordinate: Coordinate::Linear,
        inertia: 10.0,
        transmission: 1.0,
        friction: Friction { viscous: 10.0, ..friction },
        bias: 0.0,
    };
    Chain::new(vec![body; bodies], vec![Link { stiffness: 6e5, damping: 500.0 }; bodies - 1]).unwrap()
}

fn build(chain: &Chain) -> Box<dyn Mechanics> {
    let model = Model::Chain(chain.clone());
    Rapier.build(&MechanicsSetup { model, drive: Drive::Effort, step: H, initial: vec![] }).unwrap()
}

/// `bodies` sliding bodies in scenes of three, as the engine has them.
struct Bare {
    scenes: Vec<PhysicsWorld>,
}

impl Bare {
    fn new(bodies: usize) -> Self {
        let mut scenes: Vec<PhysicsWorld> = (0..bodies.div_ceil(3)).map(|_| PhysicsWorld::new()).collect();
        for scene in &mut scenes {
            let parameters = &mut scene.integration_parameters;
            parameters.dt = H;
            parameters.num_solver_iterations = 1;
            parameters.num_internal_stabilization_iterations = 0;
            parameters.max_ccd_substeps = 0;
            parameters.warmstart_coefficient = 0.0;
            parameters.normalized_max_linear_velocity = f64::MAX;
        }
        for i in 0..bodies {
            let free = LockedAxes::from_bits_truncate(1 << (i % 3));
            let mass = MassProperties::new(Vector::ZERO, 10.0, Vector::splat(10.0));
            let body =
                RigidBodyBuilder::dynamic().locked_axes(LockedAxes::all() ^ free).additional_mass_properties(mass);
            scenes[i / 3].bodies.insert(body.can_sleep(false));
        }
        Self { scenes }
    }

    fn step(&mut self, acceleration: f64) {
        for scene in &mut self.scenes {
            scene.gravity = Vector::splat(acceleration);
            scene.step();
        }
    }
}

/// A table of 20 kg on a slide and a load of 10 kg on a slide of the table's.
const NESTED: &str = r#"<mujoco><option gravity="0 0 0"/><worldbody>
  <body><joint name="motor" type="slide" axis="1 0 0" damping="10"/>
    <inertial pos="0 0 0" mass="20" diaginertia="1 1 1"/>
    <body><joint name="load" type="slide" axis="1 0 0" stiffness="6e5" damping="500"/>
      <inertial pos="0 0 0" mass="10" diaginertia="1 1 1"/></body></body>
  </worldbody><actuator><motor name="motor" joint="motor"/></actuator></mujoco>"#;

/// The bodies and joints of [`NESTED`].
fn bare_multibody() -> Bare {
    let mut bare = Bare::new(1);
    let scene = &mut bare.scenes[0];
    scene.bodies = RigidBodySet::new();
    let mut parent = scene.bodies.insert(RigidBodyBuilder::fixed());
    for mass in [20.0, 10.0] {
        let mass = MassProperties::new(Vector::ZERO, mass, Vector::ONE);
        let body = RigidBodyBuilder::dynamic().additional_mass_properties(mass).can_sleep(false);
        let child = scene.bodies.insert(body);
        let slide = GenericJointBuilder::new(JointAxesMask::all() ^ JointAxesMask::LIN_X);
        scene.multibody_joints.insert(parent, child, slide, true).unwrap();
        parent = child;
    }
    bare
}

fn torque(k: u32) -> f64 {
    f64::from(k % 7) - 3.0
}

#[divan::bench(args = [1, 2, 3, 4], sample_count = 400, sample_size = 500)]
fn a_bare_step(bencher: Bencher, bodies: usize) {
    let (mut bare, mut k) = (Bare::new(bodies), 0_u32);
    bencher.bench_local(|| {
        k = k.wrapping_add(1);
        bare.step(black_box(torque(k)));
    });
}

#[divan::bench(args = [1, 2, 3, 4], sample_count = 400, sample_size = 500)]
fn advance(bencher: Bencher, bodies: usize) {
    let (mut axis, mut k) = (build(&chain(bodies, Friction::NONE)), 0_u32);
    bencher.bench_local(|| {
        k = k.wrapping_add(1);
        let actuation = Actuation::Effort(black_box(torque(k)));
        axis.advance(&Input { actuation, motor_disturbance: 0.0, load_disturbance: 0.0 }).unwrap();
    });
}

#[divan::bench(sample_count = 400, sample_size = 500)]
fn a_bare_multibody_step(bencher: Bencher) {
    let (mut bare, mut k) = (bare_multibody(), 0_u32);
    bencher.bench_local(|| {
        k = k.wrapping_add(1);
        bare.step(black_box(torque(k)));
    });
}

#[divan::bench(sample_count = 400, sample_size = 500)]
fn advance_mjcf(bencher: Bencher) {
    let model = Model::Mjcf(MjcfModel {
        xml: NESTED.into(),
        path: "nested.xml".into(),
        motor_joint: "motor".into(),
        load_joint: "load".into(),
        actuator: "motor".into(),
        transmission: 1.0,
        axis: None,
        is_smooth: false,
    });
    let setup = MechanicsSetup { model, drive: Drive::Effort, step: H, initial: vec![] };
    let (mut axis, mut k) = (Rapier.build(&setup).unwrap(), 0_u32);
    bencher.bench_local(|| {
        k = k.wrapping_add(1);
        let actuation = Actuation::Effort(black_box(torque(k)));
        axis.advance(&Input { actuation, motor_disturbance: 0.0, load_disturbance: 0.0 }).unwrap();
    });
}
