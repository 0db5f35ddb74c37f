//! Mechanics that save and restore their state, on every engine of the build.
use super::{STEP, build, chain};
use servobench_base::Setpoint;
use servobench_base::state::{Reader, words};
use servobench_plant::{
    Actuation, Drive, DryFriction, Engine, EngineName, Friction, Input, Mechanics, MechanicsError, MechanicsSetup,
    MjcfModel, Model,
};
use servobench_testkit::Random;
use servobench_tests::engines;

/// Ticks before the state is saved, unless the environment gives another number: `SERVOBENCH_TICKS=1000000`.
const TICKS: u32 = 1_000;
/// Ticks that are run twice from there.
const AGAIN: u32 = 500;

/// A crank that turns round and round with dry friction, a pendulum on it, a spring between both: Coriolis forces, whole turns.
const CRANK: &str = r#"<mujoco><compiler angle="radian"/><option gravity="0 0 -9.81"/>
  <worldbody>
    <body><joint name="motor" type="hinge" axis="0 1 0" frictionloss="0.1" damping="1e-3"/>
      <inertial pos="0.1 0 0" mass="1" diaginertia="0.01 0.01 0.01"/>
      <body pos="0.2 0 0"><joint name="load" type="hinge" axis="0 1 0" frictionloss="0.02"/>
        <inertial pos="0.1 0 0" mass="0.5" diaginertia="4e-3 4e-3 4e-3"/></body>
    </body>
  </worldbody>
  <tendon><fixed stiffness="20" damping="0.05" springlength="0"><joint joint="load" coef="1"/></fixed></tendon>
  <actuator><motor name="drive" joint="motor"/></actuator></mujoco>"#;

/// Two slides with a spring and damper between them.
const SLIDES: &str = include_str!("../models/axes/swaying-load.xml");

fn mjcf(xml: &str, [motor_joint, load_joint, actuator]: [&str; 3]) -> Model {
    Model::Mjcf(MjcfModel {
        xml: xml.into(),
        path: "axis.xml".into(),
        motor_joint: motor_joint.into(),
        load_joint: load_joint.into(),
        actuator: actuator.into(),
        transmission: 1.0,
        axis: None,
        is_smooth: false,
    })
}

/// Models with an effort that moves each of them by several of its widths, and back.
fn setups(engine: EngineName) -> Vec<(MechanicsSetup, f64)> {
    let dry = DryFriction { coulomb: 0.1, breakaway: 0.3, stribeck_velocity: 0.1 };
    let friction = Friction { viscous: 1e-3, dry };
    let of = |model, drive| MechanicsSetup { model, drive, step: STEP, initial: Vec::new() };
    let chain = |count, friction| Model::Chain(chain(count, friction));
    let mut all: Vec<_> = (1..=4).map(|count| (of(chain(count, friction), Drive::Effort), 0.4)).collect();
    all.push((of(chain(2, Friction::NONE), Drive::Effort), 0.4));
    all.push((of(chain(3, friction), Drive::Prescribed), 1e-5));
    let files =
        [(mjcf(CRANK, ["motor", "load", "drive"]), 300.0), (mjcf(SLIDES, ["carriage", "load", "force"]), 300.0)];
    for (model, most) in files {
        if engine.simulates(model.kind()) {
            all.push((of(model, Drive::Effort), most));
        }
    }
    all
}

/// Random efforts, or steps of the base, each held for a while; the bits of the bodies after each tick.
fn run(mechanics: &mut dyn Mechanics, drive: Drive, most: f64, ticks: std::ops::Range<u32>) -> Vec<[u64; 2]> {
    let mut bits = Vec::new();
    for k in ticks {
        let mut random = Random::seeded(u64::from(k / 40));
        let (drawn, held) = (random.signed(), random.signed());
        let actuation = match drive {
            Drive::Effort => Actuation::Effort(most * drawn),
            Drive::Prescribed => {
                let t = f64::from(k) * STEP;
                Actuation::Motion(Setpoint {
                    x: most * (90.0 * t).sin(),
                    v: most * 90.0 * (90.0 * t).cos(),
                    ..Setpoint::default()
                })
            }
        };
        let input = Input { actuation, motor_disturbance: 0.0, load_disturbance: most * held };
        mechanics.advance(&input).unwrap();
        bits.extend(mechanics.bodies().iter().map(|body| [body.position, body.velocity].map(f64::to_bits)));
    }
    bits
}

fn saved(mechanics: &mut dyn Mechanics) -> Vec<u64> {
    let mut state = Vec::new();
    mechanics.save(&mut words(|word| state.push(word))).unwrap();
    state
}

fn restore(mechanics: &mut dyn Mechanics, state: &[u64]) -> Result<(), MechanicsError> {
    let mut from = Reader::new(state);
    mechanics.restore(&mut from)?;
    Ok(from.end()?)
}

fn ticks() -> u32 {
    std::env::var("SERVOBENCH_TICKS").map_or(TICKS, |ticks| ticks.parse().unwrap())
}

fn each(test: impl Fn(&dyn Engine, &MechanicsSetup, f64)) {
    for engine in engines() {
        for (setup, most) in setups(engine.name()) {
            test(engine, &setup, most);
        }
    }
}

/// At each of many ticks in a row: at some of them bodies come to rest or break away, and a joint has just turned round.
#[test]
fn a_state_of_every_tick_can_be_restored() {
    each(|engine, setup, most| {
        let [mut mechanics, mut other] = [(); 2].map(|()| build(engine, setup));
        for begin in 0..2_000 {
            let state = saved(&mut *mechanics);
            restore(&mut *other, &state).unwrap();
            let found = run(&mut *other, setup.drive, most, begin..begin + 3);
            let expected = run(&mut *mechanics, setup.drive, most, begin..begin + 3);
            assert!(found == expected, "{} from tick {begin} on: {:?}", engine.name(), setup.model);
            restore(&mut *mechanics, &state).unwrap();
            run(&mut *mechanics, setup.drive, most, begin..begin + 1);
        }
    });
}

/// The same mechanics and others of the same setup, which are fresh or were elsewhere, go on with the same bits.
#[test]
fn what_was_restored_goes_on_with_the_same_bits() {
    each(|engine, setup, most| {
        let mut mechanics = build(engine, setup);
        let mut began = 0;
        for begin in [1, 7, 301, ticks(), ticks() + 1] {
            let context = format!("{} from tick {begin} on: {:?}", engine.name(), setup.model);
            run(&mut *mechanics, setup.drive, most, began..begin);
            began = begin;
            let state = saved(&mut *mechanics);
            let [mut fresh, mut elsewhere] = [(); 2].map(|()| build(engine, setup));
            run(&mut *elsewhere, setup.drive, most, 5..300);
            let bodies = mechanics.bodies().to_vec();
            let expected = run(&mut *mechanics, setup.drive, most, begin..begin + AGAIN);
            for other in [&mut mechanics, &mut fresh, &mut elsewhere] {
                restore(&mut **other, &state).unwrap();
                assert_eq!(other.bodies(), bodies, "{context}");
                assert_eq!(saved(&mut **other), state, "{context}");
                let found = run(&mut **other, setup.drive, most, begin..begin + AGAIN);
                assert!(found == expected, "{context}");
            }
            restore(&mut *mechanics, &state).unwrap();
        }
    });
}

#[test]
fn a_state_of_other_mechanics_or_a_part_of_one_is_refused() {
    let all: Vec<_> = engines()
        .into_iter()
        .flat_map(|engine| setups(engine.name()).into_iter().map(move |(setup, most)| (engine, setup, most)))
        .collect();
    let states: Vec<_> = all
        .iter()
        .map(|(engine, setup, most)| {
            let mut mechanics = build(*engine, setup);
            run(&mut *mechanics, setup.drive, *most, 0..50);
            saved(&mut *mechanics)
        })
        .collect();
    for (i, (engine, setup, _)) in all.iter().enumerate() {
        let mut mechanics = build(*engine, setup);
        for (j, state) in states.iter().enumerate() {
            assert_eq!(restore(&mut *mechanics, state).is_ok(), i == j, "{} {:?}", engine.name(), setup.model);
        }
        for cut in 0..states[i].len() {
            assert!(restore(&mut *mechanics, &states[i][..cut]).is_err(), "{} {:?}", engine.name(), setup.model);
        }
        assert!(restore(&mut *mechanics, &[&states[i][..], &[0]].concat()).is_err());
        // A mass or a tick that differs is another axis.
        let mut heavier = setup.clone();
        match &mut heavier.model {
            Model::Chain(chain) => chain.bodies_mut()[0].inertia *= 1.1,
            _ => heavier.step *= 0.5,
        }
        assert!(restore(&mut *build(*engine, &heavier), &states[i]).is_err());
        restore(&mut *mechanics, &states[i]).unwrap();
    }
}

/// Bodies are held and break away, and joints turn round, in the runs of these tests.
#[test]
fn the_runs_of_these_tests_stick_and_slip() {
    each(|engine, setup, most| {
        let mut mechanics = build(engine, setup);
        let (mut at_rest, mut moves, mut turns) = (false, false, false);
        for k in 0..2_000 {
            run(&mut *mechanics, setup.drive, most, k..k + 1);
            at_rest |= mechanics.bodies().iter().any(|body| body.velocity == 0.0);
            moves |= mechanics.bodies().iter().any(|body| body.velocity != 0.0);
            turns |= mechanics.bodies()[0].position.abs() > std::f64::consts::TAU;
        }
        let is_dry = matches!(&setup.model, Model::Chain(chain) if chain.bodies()[0].friction.breakaway() > 0.0);
        let is_crank = matches!(&setup.model, Model::Mjcf(file) if file.xml == CRANK);
        assert!(moves && (at_rest || !is_dry) && (turns || !is_crank), "{} {:?}", engine.name(), setup.model);
    });
}

/// Again, in turns with others a tick behind, and on another thread.
#[test]
fn the_same_inputs_give_the_same_bits() {
    each(|engine, setup, most| {
        let one = |mechanics: &mut dyn Mechanics, k: u32| run(mechanics, setup.drive, most, k..k + 1);
        let [mut alone, mut first, mut second] = [(); 3].map(|()| build(engine, setup));
        let expected: Vec<_> = (0..5_000).map(|k| one(&mut *alone, k)).collect();
        for k in 0..5_000 {
            assert!(one(&mut *first, k) == expected[k as usize], "{} at tick {k}", engine.name());
            if let Some(before) = k.checked_sub(1) {
                assert!(one(&mut *second, before) == expected[before as usize], "{} at tick {k}", engine.name());
            }
        }
        let elsewhere = std::thread::scope(|scope| {
            let run = || run(&mut *build(engine, setup), setup.drive, most, 0..5_000);
            scope.spawn(run).join().unwrap()
        });
        assert!(elsewhere == expected.concat(), "{} on another thread", engine.name());
    });
}
