//! What goes wrong is said, and what goes right goes the same way twice.
use super::{STEP, body, efforts, motion, mujoco, setup, two_mass, unchecked};
use servobench_base::Coordinate;
use servobench_base::Setpoint;
use servobench_engine_mujoco::Mujoco;
use servobench_plant::{Actuation, Chain, Drive, Engine as _, EngineName, Input, Link, Mechanics, MechanicsError};
use std::path::Path;
use std::process::Command;

/// RK4 is unstable beyond ω·h = 2.83; here it is 32.
fn too_stiff() -> Box<dyn Mechanics> {
    let lump = |name| body(name, Coordinate::Linear, 1e-3);
    let link = Link { stiffness: 1.25e8, damping: 0.0 };
    let chain = Chain::new(vec![lump("motor"), lump("load")], vec![link]).unwrap();
    unchecked(&chain, STEP, &[(1e-6, 0.0), (0.0, 0.0)])
}

#[test]
fn divergence_is_an_error_and_not_a_restart() {
    let mut mechanics = too_stiff();
    let error = (0..1000).find_map(|_| mechanics.advance(&efforts(0.0, 0.0)).err());
    let Some(MechanicsError::Diverged { engine: EngineName::Mujoco, message }) = error else {
        panic!("{error:?}");
    };
    assert!(message.contains("QACC") || message.contains("QVEL") || message.contains("QPOS"), "{message}");
    let far = mechanics.bodies()[0].position.abs();
    assert!(far > 1.0, "MuJoCo's reset would have put it back to 1e-6: {far}");
    assert!(!Path::new("MUJOCO_LOG.TXT").exists(), "messages go to the handler");
}

#[test]
fn an_input_that_is_not_a_number_is_divergence_by_name() {
    let mut mechanics = mujoco(two_mass(), Drive::Effort, STEP, &[]);
    for (input, said) in [
        (efforts(f64::NAN, 0.0), "the effort is not finite: NaN"),
        (efforts(0.0, f64::INFINITY), "the disturbance of the load is not finite: inf"),
    ] {
        let error = mechanics.advance(&input).unwrap_err();
        assert!(matches!(&error, MechanicsError::Diverged { message, .. } if message == said), "{error}");
    }
}

#[test]
fn an_actuation_of_the_other_kind_is_refused() {
    let mut pushed = mujoco(two_mass(), Drive::Effort, STEP, &[]);
    let mut led = mujoco(two_mass(), Drive::Prescribed, STEP, &[]);
    for error in
        [pushed.advance(&motion(Setpoint::default())).unwrap_err(), led.advance(&efforts(1.0, 0.0)).unwrap_err()]
    {
        assert!(matches!(error, MechanicsError::Unsupported { .. }), "{error}");
    }
}

#[test]
fn a_step_of_zero_and_an_initial_nan_are_refused() {
    let wrong_step = setup(two_mass(), Drive::Effort, 0.0, &[]);
    let error = Mujoco.build(&wrong_step).err().unwrap();
    assert_eq!(error.to_string(), "`step` must be finite and positive, got 0");
    let wrong_start = setup(two_mass(), Drive::Effort, STEP, &[(f64::NAN, 0.0)]);
    assert!(Mujoco.build(&wrong_start).is_err());
}

/// One body behind a prescribed base is the base itself, and `MuJoCo` has nothing to move.
#[test]
fn a_prescribed_single_body_is_where_the_set_point_is() {
    let chain = Chain::new(vec![body("motor", Coordinate::Linear, 1.0)], vec![]).unwrap();
    let mut mechanics = mujoco(chain, Drive::Prescribed, STEP, &[]);
    let now = Setpoint { x: 1.0, v: 2.0, a: 3.0, j: 4.0, s: 5.0 };
    mechanics.advance(&motion(now)).unwrap();
    let state = mechanics.bodies()[0];
    assert_eq!((state.position, state.velocity), (now.after(STEP).x, now.after(STEP).v));
}

#[test]
fn the_same_inputs_give_the_same_bits_also_on_another_thread() {
    let run = || {
        let mut mechanics = mujoco(two_mass(), Drive::Effort, STEP, &[(0.0, 0.0), (1e-3, 0.0)]);
        let mut bits = Vec::new();
        for k in 0..5000 {
            let input = Input {
                actuation: Actuation::Effort((f64::from(k) * 0.003).sin()),
                motor_disturbance: 0.1,
                load_disturbance: -0.2,
            };
            mechanics.advance(&input).unwrap();
            for body in mechanics.bodies() {
                bits.extend([body.position.to_bits(), body.velocity.to_bits()]);
            }
        }
        bits
    };
    let other = std::thread::spawn(run);
    let here = run();
    assert_eq!(here, other.join().unwrap());
}

/// A fatal error cannot be caught: whoever must survive it needs a process of its own, as this test does.
#[test]
fn a_fatal_error_is_said_and_ends_the_process_with_code_1() {
    const INSIDE: &str = "SERVOBENCH_TEST_FATAL";
    if std::env::var_os(INSIDE).is_some() {
        drop(mujoco(two_mass(), Drive::Effort, STEP, &[]));
        mujoco_rs::prelude::log_error("nothing works");
    }
    let itself = std::env::current_exe().unwrap();
    let name = "failures::a_fatal_error_is_said_and_ends_the_process_with_code_1";
    let child = Command::new(itself).args(["--exact", name, "--nocapture"]).env(INSIDE, "1").output().unwrap();
    assert_eq!(child.status.code(), Some(1));
    let said = String::from_utf8(child.stderr).unwrap();
    assert!(said.contains("mujoco: nothing works"), "{said}");
    assert!(!Path::new("MUJOCO_LOG.TXT").exists(), "messages go to the handler");
}
