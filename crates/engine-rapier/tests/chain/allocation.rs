//! Allocations per tick: Rapier's own, and none of ours.
use super::{H, build, effort, feed_axis, two_mass};
use rapier3d_f64::prelude::{GenericJointBuilder, JointAxesMask, PhysicsWorld, RigidBodyBuilder};
use servobench_engine_rapier::Rapier;
use servobench_plant::{Drive, Engine, Mechanics, MechanicsSetup, MjcfModel, Model};
use servobench_testkit::CountingAllocator;

#[global_allocator]
static ALLOCATOR: CountingAllocator = CountingAllocator;

/// Allocations per call once everything has its size.
fn per_call(mut call: impl FnMut(u32)) -> f64 {
    (0..100).for_each(&mut call);
    let before = CountingAllocator::count();
    (0..1_000).for_each(&mut call);
    (CountingAllocator::count() - before) as f64 / 1_000.0
}

fn per_tick(axis: &mut dyn Mechanics) -> f64 {
    per_call(|k| axis.advance(&effort(f64::from(k % 3) - 1.0)).unwrap())
}

/// A bare scene of two bodies, on joints of a multibody or without.
fn bare(jointed: bool) -> PhysicsWorld {
    let mut scene = PhysicsWorld::new();
    scene.integration_parameters.dt = H;
    scene.integration_parameters.num_solver_iterations = 1;
    let mut parent = scene.bodies.insert(RigidBodyBuilder::fixed());
    for _ in 0..2 {
        let child = scene.bodies.insert(RigidBodyBuilder::dynamic().additional_mass(1.0).can_sleep(false));
        if jointed {
            let slide = GenericJointBuilder::new(JointAxesMask::all() ^ JointAxesMask::LIN_X);
            scene.multibody_joints.insert(parent, child, slide, true).unwrap();
        }
        parent = child;
    }
    scene
}

/// Oracle: a bare Rapier scene of as many bodies. Four lumps are in two scenes; the motor of the feed axis also changes
/// its centre a few times, which Rapier notes in a list.
#[test]
fn a_tick_allocates_what_the_bare_step_does() {
    let mut scene = bare(false);
    let step = per_call(|_| scene.step());
    let two = per_tick(build(&two_mass(0.01), Drive::Effort, H, vec![]).as_mut());
    assert!((two - step).abs() < 1e-12, "{two} against {step}");
    let four = per_tick(build(&feed_axis(), Drive::Effort, H, vec![]).as_mut());
    assert!((four - 2.0 * step).abs() < 0.1, "{four} against two times {step}");
}

#[test]
fn a_tick_of_an_mjcf_file_allocates_what_the_bare_step_does() {
    let mut scene = bare(true);
    let step = per_call(|_| scene.step());
    let xml = r#"<mujoco><option gravity="0 0 0"/><worldbody>
        <body><joint name="m" type="slide" axis="1 0 0" damping="1"/><inertial pos="0 0 0" mass="2" diaginertia="1 1 1"/>
          <body><joint name="load" type="slide" axis="1 0 0" stiffness="1e4"/><inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>
        </body></body></worldbody><actuator><motor name="u" joint="m"/></actuator></mujoco>"#;
    let model = Model::Mjcf(MjcfModel {
        xml: xml.into(),
        path: "axis.xml".into(),
        motor_joint: "m".into(),
        load_joint: "load".into(),
        actuator: "u".into(),
        transmission: 1.0,
        axis: None,
        is_smooth: false,
    });
    let setup = MechanicsSetup { model, drive: Drive::Effort, step: H, initial: vec![] };
    let found = per_tick(Rapier.build(&setup).unwrap().as_mut());
    assert!((found - step).abs() < 1e-12, "{found} against {step}");
}
