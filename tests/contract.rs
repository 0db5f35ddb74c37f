//! What `Engine` and `Mechanics` promise, held against every engine of the build.
mod dry_friction;
mod modes;
mod order;
mod saved_state;

use servobench_base::Coordinate;
use servobench_base::Setpoint;
use servobench_fmi::{FmuFile, Isolation, SiPort};
use servobench_plant::{
    Actuation, Body, BodyState, Chain, Drive, Engine, FmuBody, FmuModel, Friction, Input, Link, Mechanics,
    MechanicsError, MechanicsSetup, MjcfModel, Model,
};
use servobench_tests::engines;
use std::f64::consts::TAU;

const STEP: f64 = 1.0 / 16_000.0;
/// A rotary motor behind a screw of 10 mm.
const LEAD: f64 = 0.01 / TAU;
const NAMES: [&str; 4] = ["motor", "table", "load", "tool"];

/// `count` bodies, the first one rotary behind the screw.
fn chain(count: usize, friction: Friction) -> Chain {
    let bodies = NAMES.into_iter().take(count).enumerate().map(|(i, name)| Body {
        name,
        coordinate: if i == 0 { Coordinate::Rotary } else { Coordinate::Linear },
        inertia: if i == 0 { 2e-4 } else { 10.0 },
        transmission: if i == 0 { LEAD } else { 1.0 },
        friction,
        bias: 0.0,
    });
    let link = Link { stiffness: 1e7, damping: 100.0 };
    Chain::new(bodies.collect(), vec![link; count - 1]).unwrap()
}

fn setup(count: usize, drive: Drive) -> MechanicsSetup {
    MechanicsSetup { model: Model::Chain(chain(count, Friction::NONE)), drive, step: STEP, initial: Vec::new() }
}

/// `bodies` in a row, with a name for each.
fn in_a_row(mut bodies: Vec<Body>, links: Vec<Link>) -> Chain {
    bodies.iter_mut().zip(NAMES).for_each(|(body, name)| body.name = name);
    Chain::new(bodies, links).unwrap()
}

/// A body without friction.
fn body(inertia: f64) -> Body {
    let (transmission, friction, bias) = (1.0, Friction::NONE, 0.0);
    Body { name: "", coordinate: Coordinate::Linear, inertia, transmission, friction, bias }
}

fn viscous(viscous: f64) -> Friction {
    Friction { viscous, ..Friction::NONE }
}

fn effort(effort: f64) -> Input {
    Input { actuation: Actuation::Effort(effort), ..REST }
}

fn motion(setpoint: Setpoint) -> Input {
    Input { actuation: Actuation::Motion(setpoint), ..REST }
}

fn state(position: f64, velocity: f64) -> BodyState {
    BodyState { position, velocity }
}

const REST: Input = Input { actuation: Actuation::Effort(0.0), motor_disturbance: 0.0, load_disturbance: 0.0 };

fn build(engine: &dyn Engine, setup: &MechanicsSetup) -> Box<dyn Mechanics> {
    engine.build(setup).unwrap_or_else(|error| panic!("{}: {error}", engine.name()))
}

#[test]
fn a_chain_starts_in_the_given_states() {
    for engine in engines() {
        for count in 1..=Chain::MAX_BODIES {
            let initial: Vec<BodyState> =
                (0..count).map(|i| BodyState { position: 0.25 + i as f64, velocity: 0.5 - i as f64 }).collect();
            let mechanics = build(engine, &MechanicsSetup { initial: initial.clone(), ..setup(count, Drive::Effort) });
            assert_eq!(mechanics.bodies(), initial, "{}", engine.name());
        }
    }
}

/// Oracle: uniform acceleration, which every scheme here integrates without error but for rounding.
#[test]
fn disturbances_act_in_their_own_coordinates() {
    let (ticks, force) = (1600, 100.0);
    let time = f64::from(ticks) * STEP;
    for engine in engines() {
        // The load of a single rotary body is the body itself: the force acts through the screw.
        for (input, torque) in [
            (Input { load_disturbance: force, ..REST }, LEAD * force),
            (Input { motor_disturbance: 0.3, ..REST }, 0.3),
            (Input { actuation: Actuation::Effort(0.3), ..REST }, 0.3),
        ] {
            let mut mechanics = build(engine, &setup(1, Drive::Effort));
            for _ in 0..ticks {
                mechanics.advance(&input).unwrap();
            }
            let (found, expected) = (mechanics.bodies()[0].position, torque / 2e-4 * time * time / 2.0);
            assert!((found / expected - 1.0).abs() < 1e-10, "{}: {found} {expected}", engine.name());
        }
    }
}

/// Oracle: momentum. The force on the load is the only one from outside, whatever the links do.
#[test]
fn the_load_disturbance_of_a_chain_pushes_all_of_it() {
    let ticks = 1600;
    for engine in engines() {
        for count in 2..=Chain::MAX_BODIES {
            let mut mechanics = build(engine, &setup(count, Drive::Effort));
            for _ in 0..ticks {
                mechanics.advance(&Input { load_disturbance: 100.0, ..REST }).unwrap();
            }
            let momentum: f64 = chain(count, Friction::NONE)
                .bodies()
                .iter()
                .zip(mechanics.bodies())
                .map(|(body, state)| body.inertia / body.transmission * state.velocity)
                .sum();
            let expected = 100.0 * f64::from(ticks) * STEP;
            assert!((momentum / expected - 1.0).abs() < 1e-10, "{}: {momentum} {expected}", engine.name());
        }
    }
}

#[test]
fn a_prescribed_motor_follows_and_nothing_else_is_accepted() {
    let now = Setpoint { x: 0.1, v: 0.2, a: 3.0, j: 40.0, s: 500.0 };
    for engine in engines() {
        let mut follower = build(engine, &setup(2, Drive::Prescribed));
        let error = follower.advance(&REST).unwrap_err();
        assert_eq!(error, MechanicsError::wrong_actuation(engine.name()));
        let mut pushed = build(engine, &setup(2, Drive::Effort));
        let motion = Input { actuation: Actuation::Motion(now), ..REST };
        assert_eq!(pushed.advance(&motion).unwrap_err(), MechanicsError::wrong_actuation(engine.name()));

        // One body is the base itself: the engine has nothing to move.
        for count in 1..=2 {
            let mut follower = build(engine, &setup(count, Drive::Prescribed));
            follower.advance(&motion).unwrap();
            let motor = follower.bodies()[0];
            let end = now.after(STEP);
            // Two roundings: the polynomial and the transmission.
            assert!((motor.position * LEAD / end.x - 1.0).abs() < 1e-15, "{}: {motor:?}", engine.name());
            assert!((motor.velocity * LEAD / end.v - 1.0).abs() < 1e-15, "{}: {motor:?}", engine.name());
        }
    }
}

#[test]
fn a_wrong_setup_is_refused_by_the_name_of_its_field() {
    let state = |position| state(position, 0.0);
    let cases = [
        (MechanicsSetup { step: 0.0, ..setup(2, Drive::Effort) }, "step"),
        (MechanicsSetup { step: f64::NAN, ..setup(2, Drive::Effort) }, "step"),
        (MechanicsSetup { initial: vec![state(0.0)], ..setup(2, Drive::Effort) }, "initial"),
        (MechanicsSetup { initial: vec![state(0.0); 3], ..setup(2, Drive::Effort) }, "initial"),
        (
            MechanicsSetup { initial: vec![state(0.0), state(f64::INFINITY)], ..setup(2, Drive::Effort) },
            "initial position",
        ),
        (
            MechanicsSetup {
                initial: vec![BodyState { position: 0.0, velocity: f64::NAN }; 2],
                ..setup(2, Drive::Effort)
            },
            "initial velocity",
        ),
    ];
    for engine in engines() {
        for (wrong, field) in &cases {
            match engine.build(wrong).err() {
                Some(MechanicsError::Parameter(error)) if error.name == *field => {}
                other => panic!("{} with a wrong {field}: {other:?}", engine.name()),
            }
        }
    }
}

/// A run that ends by it has failed, on every engine, and is no error of the program.
#[test]
fn what_is_not_finite_is_divergence() {
    for engine in engines() {
        for count in 1..=2 {
            for input in [
                Input { actuation: Actuation::Effort(f64::NAN), ..REST },
                Input { actuation: Actuation::Effort(f64::NEG_INFINITY), ..REST },
                Input { motor_disturbance: f64::INFINITY, ..REST },
                Input { load_disturbance: f64::NAN, ..REST },
            ] {
                let mut mechanics = build(engine, &setup(count, Drive::Effort));
                let error = mechanics.advance(&input).unwrap_err();
                assert!(matches!(error, MechanicsError::Diverged { .. }), "{} of {input:?}: {error}", engine.name());
            }
        }
    }
}

/// A state that is finite, but none of a machine, does not come to sensors and drive.
#[test]
fn what_is_beyond_every_machine_is_divergence() {
    for engine in engines() {
        for count in 1..=2 {
            for most in [1e12, 1e308] {
                let mut mechanics = build(engine, &setup(count, Drive::Effort));
                let error = (0..16).find_map(|_| mechanics.advance(&effort(most)).err()).unwrap();
                assert!(matches!(error, MechanicsError::Diverged { .. }), "{}: {error}", engine.name());
            }
        }
    }
}

/// Every kind of model that is not among the engine's capabilities is refused by name, and none that is.
#[test]
fn an_engine_simulates_what_its_capabilities_list() {
    let port = || SiPort { variable: "x".into(), unit: None };
    let file = FmuFile { path: "none.fmu".into(), start: Vec::new(), isolation: Isolation::None, event_mode: true };
    let models = [
        setup(2, Drive::Effort).model,
        Model::Mjcf(MjcfModel {
            xml: "<mujoco/>".into(),
            path: "none.xml".into(),
            motor_joint: "motor".into(),
            load_joint: "load".into(),
            actuator: "motor".into(),
            transmission: 1.0,
            axis: None,
            is_smooth: false,
        }),
        Model::Fmu(Box::new(FmuModel {
            file,
            effort: port(),
            motor: FmuBody { position: port(), velocity: None },
            load: None,
            motor_disturbance: None,
            load_disturbance: None,
            transmission: 1.0,
            ticks: 1,
        })),
    ];
    for engine in engines() {
        for model in &models {
            let refusal = MechanicsError::not_simulated(engine.name(), model);
            assert!(refusal.to_string().contains("; choose "), "a way out: {refusal}");
            let built = engine.build(&MechanicsSetup { model: model.clone(), ..setup(2, Drive::Effort) });
            let is_refused = built.err() == Some(refusal);
            assert_eq!(is_refused, !engine.name().simulates(model.kind()), "{}: {model:?}", engine.name());
        }
    }
}
