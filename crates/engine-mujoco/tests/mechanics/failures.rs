//! Errors are reported; inputs that would cause them are refused.
use super::{STEP, body, efforts, free_omega, mujoco, setup, two_mass, unchecked};
use servobench_base::Coordinate;
use servobench_engine_mujoco::Mujoco;
use servobench_plant::{Body, Chain, Drive, Engine as _, EngineName, Friction, Link, Mechanics, MechanicsError};
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

/// Oracle: |R(i·y)| of RK4 is one at y = 2·√2. A user's own MJCF file is not checked, and shows what MuJoCo does with the
/// chain that is refused: a stretch of a millimetre falls below it, and grows above it.
#[test]
fn a_chain_that_rk4_blows_up_is_refused_and_no_other_is() {
    let stretch_after = |angle: f64| {
        let mut mechanics = unchecked(&two_mass(), angle / free_omega(), &[(-0.001, 0.0), (0.001, 0.0)]);
        for _ in 0..40 {
            mechanics.advance(&efforts(0.0, 0.0)).unwrap();
        }
        let [motor, load] = mechanics.bodies() else { panic!("two bodies") };
        (motor.position - load.position).abs().max((motor.velocity - load.velocity).abs() / free_omega())
    };
    for (angle, is_refused) in [(2.79, false), (2.87, true)] {
        let built = Mujoco.build(&setup(two_mass(), Drive::Effort, angle / free_omega(), &[]));
        let error = built.err().map(|error| error.to_string());
        assert_eq!(error.is_some(), is_refused, "{error:?}");
        assert!(error.is_none_or(|error| error.contains("a mode of 84 Hz") && error.contains("2.87")));
        assert_eq!(stretch_after(angle) > 2e-3, is_refused, "{angle}: {:e}", stretch_after(angle));
    }
}

/// Oracle: R of RK4 on the negative real axis, below one down to −2.785.
#[test]
fn a_damper_that_rk4_blows_up_is_refused() {
    for (rate, is_refused) in [(2.7, false), (2.9, true)] {
        let plain = two_mass().bodies()[0].clone();
        let braked = Body { friction: Friction { viscous: rate / STEP * plain.inertia, ..Friction::NONE }, ..plain };
        let chain = Chain::new(vec![braked], Vec::new()).unwrap();
        let built = Mujoco.build(&setup(chain, Drive::Effort, STEP, &[]));
        assert_eq!(built.is_err(), is_refused, "{rate}");
    }
}

/// A fatal error cannot be caught: a program that must survive it needs a separate process, as this test does.
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
