//! Modes that a tick cannot carry.
use super::{H, body, build, effort, state};
use servobench_engine_rapier::Rapier;
use servobench_plant::{Chain, Drive, Engine, Link, MechanicsSetup, Model};

#[test]
fn a_mode_that_the_tick_cannot_carry_is_refused() {
    // ω·h = 2 at c = 4·m_red/h²; nothing but the tick is out of bounds.
    let chain = |stiffness| Chain::new(vec![body(1.0), body(1.0)], vec![Link { stiffness, damping: 0.0 }]).unwrap();
    let limit = 4.0 * 0.5 / (H * H);
    let model = Model::Chain(chain(1.001 * limit));
    let setup = MechanicsSetup { model, drive: Drive::Effort, step: H, initial: vec![] };
    let message = Rapier.build(&setup).err().unwrap().to_string();
    assert!(message.contains("5093 Hz") && message.contains("`exact`"), "{message}");
    let mut axis = build(&chain(0.999 * limit), Drive::Effort, H, vec![state(1e-6, 0.0), state(0.0, 0.0)]);
    for _ in 0..100_000 {
        axis.advance(&effort(0.0)).unwrap();
    }
    assert!(axis.bodies()[0].position.abs() < 1e-3, "stable just below the limit");
}
