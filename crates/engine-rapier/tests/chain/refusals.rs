//! What is refused, and with which words.
use super::{H, body, build, effort, lambrechts, motion, state, two_mass};
use servobench_base::Setpoint;
use servobench_engine_rapier::Rapier;
use servobench_plant::{Chain, Drive, Engine, Link, MechanicsError, MechanicsSetup, Model};

fn refusal(chain: Chain, step: f64, initial: Vec<servobench_plant::BodyState>) -> String {
    let setup = MechanicsSetup { model: Model::Chain(chain), drive: Drive::Effort, step, initial };
    Rapier.build(&setup).err().expect("must be refused").to_string()
}

#[test]
fn an_effort_that_is_not_finite_ends_the_run() {
    for bad in [f64::NAN, f64::INFINITY] {
        let mut axis = build(&two_mass(0.0), Drive::Effort, H, vec![]);
        assert!(matches!(axis.advance(&effort(bad)), Err(MechanicsError::Diverged { .. })), "{bad}");
    }
}

#[test]
fn a_state_that_overflows_ends_the_run() {
    let mut axis = build(&two_mass(0.0), Drive::Effort, H, vec![]);
    let end = (0..10_000).find_map(|_| axis.advance(&effort(1e308)).err());
    assert!(matches!(end, Some(MechanicsError::Diverged { .. })), "{end:?}");
}

#[test]
fn the_other_actuation_is_refused() {
    let mut driven = build(&lambrechts(), Drive::Effort, H, vec![]);
    let mut behind = build(&lambrechts(), Drive::Prescribed, H, vec![]);
    for error in [driven.advance(&motion(Setpoint::default())), behind.advance(&effort(0.0))] {
        let message = error.unwrap_err().to_string();
        assert!(message.contains("`Drive::Effort`") && message.contains("`Drive::Prescribed`"), "{message}");
    }
}

#[test]
fn a_mode_that_the_tick_cannot_carry_is_refused() {
    // ω·h = 2 at c = 4·m_red/h²; nothing but the tick is out of bounds.
    let chain = |stiffness| Chain::new(vec![body(1.0), body(1.0)], vec![Link { stiffness, damping: 0.0 }]).unwrap();
    let limit = 4.0 * 0.5 / (H * H);
    let message = refusal(chain(1.001 * limit), H, vec![]);
    assert!(message.contains("5093 Hz") && message.contains("`exact`"), "{message}");
    let mut axis = build(&chain(0.999 * limit), Drive::Effort, H, vec![state(1e-6, 0.0), state(0.0, 0.0)]);
    for _ in 0..100_000 {
        axis.advance(&effort(0.0)).unwrap();
    }
    assert!(axis.bodies()[0].position.abs() < 1e-3, "stable just below the limit");
}

#[test]
fn set_up_values_are_checked_by_name() {
    assert!(refusal(two_mass(0.0), 0.0, vec![]).contains("`step`"));
    assert!(refusal(two_mass(0.0), H, vec![state(f64::NAN, 0.0); 2]).contains("`initial position`"));
    assert!(refusal(two_mass(0.0), H, vec![state(0.0, f64::NAN); 2]).contains("`initial velocity`"));
    assert!(refusal(two_mass(0.0), H, vec![state(0.0, 0.0)]).contains("`initial`"));
}
