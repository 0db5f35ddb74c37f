//! Agreement with chains, which are simulated by other code of this engine.
use super::{H, MjcfModel, effort, file, try_build};
use servobench_base::Coordinate;
use servobench_engine_rapier::Rapier;
use servobench_plant::{Body, Chain, Drive, Engine, Friction, Link, MechanicsSetup, Model, chain_to_mjcf};

/// A servo motor on a ball screw of 10 mm lead, a table and a flexible load.
fn feed_axis() -> Chain {
    let body = |name, inertia, viscous| Body {
        name,
        coordinate: Coordinate::Linear,
        inertia,
        transmission: 1.0,
        friction: Friction { viscous, ..Friction::NONE },
        bias: 0.0,
    };
    let lead = 10e-3 / (2.0 * std::f64::consts::PI);
    let motor = Body { coordinate: Coordinate::Rotary, transmission: lead, ..body("m", 6e-4, 1e-3) };
    let link = |stiffness, damping| Link { stiffness, damping };
    Chain::new(vec![motor, body("table", 60.0, 100.0), body("load", 25.0, 20.0)], vec![link(1e8, 2e4), link(8e6, 2e3)])
        .unwrap()
}

/// Oracle: the MJCF of a chain, read back and put on joints and tendons, moves as the chain does.
#[test]
fn the_mjcf_of_a_chain_moves_as_the_chain() {
    let chain = feed_axis();
    let xml = chain_to_mjcf(&chain, Drive::Effort, H);
    let model = MjcfModel { actuator: "motor_effort".into(), ..file(&xml, "load") };
    let mut mjcf = try_build(model, H, vec![]).unwrap();
    let setup = MechanicsSetup { model: Model::Chain(chain), drive: Drive::Effort, step: H, initial: vec![] };
    let mut lumps = Rapier.build(&setup).unwrap();
    let mut vibration = 0.0_f64;
    for k in 0..16_000 {
        let t = f64::from(k) * H;
        let mut input = effort(0.5 + 2.0 * (300.0 * t * t).sin());
        input.load_disturbance = if k > 8_000 { -50.0 } else { 0.0 };
        mjcf.advance(&input).unwrap();
        lumps.advance(&input).unwrap();
        let (found, expected) = (mjcf.bodies(), lumps.bodies());
        vibration = vibration.max((expected[2].position - expected[1].position).abs());
        // Both are of second order and differ in the dampers of the tendons only: their difference stays below the bar of 10 nm.
        assert!((found[1].position - expected[2].position).abs() < 1e-8, "tick {k}: {found:?} {expected:?}");
        assert!((found[0].position - expected[0].position).abs() < 2e-6, "tick {k}: {found:?} {expected:?}");
        assert!((found[1].velocity - expected[2].velocity).abs() < 1e-5, "tick {k}: {found:?} {expected:?}");
    }
    assert!(vibration > 1e-5, "the load vibrated by {vibration:e} m: too little to tell");
}

/// The same bits from the same file, twice at a time.
#[test]
fn two_of_a_kind_are_the_same_to_the_bit() {
    let xml = chain_to_mjcf(&feed_axis(), Drive::Effort, H);
    let model = MjcfModel { actuator: "motor_effort".into(), ..file(&xml, "load") };
    let start = || try_build(model.clone(), H, vec![]).unwrap();
    let (mut first, mut second) = (start(), start());
    for k in 0..4_000 {
        first.advance(&effort((f64::from(k) * 0.01).sin())).unwrap();
        second.advance(&effort((f64::from(k) * 0.01).sin())).unwrap();
        assert_eq!(first.bodies(), second.bodies(), "tick {k}");
    }
    let bits = |state: servobench_plant::BodyState| [state.position.to_bits(), state.velocity.to_bits()];
    assert_eq!(bits(first.bodies()[1]), bits(second.bodies()[1]));
}
