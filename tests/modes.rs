//! The two-mass drive on every engine: an undamped mode is distorted exactly as its integrator says, and no other way.
use super::{STEP, body, build, effort, in_a_row, motion, state};
use servobench_base::{Coordinate, Setpoint};
use servobench_plant::{Body, Chain, Distortion, Drive, Engine, Link, MechanicsSetup, Model};
use servobench_tests::engines;
use std::f64::consts::TAU;

/// Saarakkala/Hinkkanen: J_M = J_L = 0.005 kg·m², K_s = 700 N·m/rad, here without damping.
fn two_mass() -> Chain {
    let rotor = Body { coordinate: Coordinate::Rotary, ..body(5e-3) };
    in_a_row(vec![rotor; 2], vec![Link { stiffness: 700.0, damping: 0.0 }])
}

/// Stretch of the shaft after each of `ticks`, from a wind-up of 1 mrad; `held` keeps the motor where it is.
fn ring_down(engine: &dyn Engine, held: bool, step: f64, ticks: usize) -> Vec<f64> {
    let drive = if held { Drive::Prescribed } else { Drive::Effort };
    let initial = vec![state(0.0, 0.0), state(1e-3, 0.0)];
    let mut axis = build(engine, &MechanicsSetup { model: Model::Chain(two_mass()), drive, step, initial });
    let input = if held { motion(Setpoint::at_rest(0.0)) } else { effort(0.0) };
    let stretch = |_| {
        axis.advance(&input).unwrap();
        axis.bodies()[1].position - axis.bodies()[0].position
    };
    (0..ticks).map(stretch).collect()
}

/// Oracle: published, 84.22 Hz free and 59.55 Hz with the motor held; and the powers of what each integrator makes of e^(iωt) in a tick, which
/// is exact whatever ω·h is.
#[test]
fn a_mode_is_distorted_as_the_integrator_of_the_engine_says() {
    for (held, inertia, published) in [(false, 2.5e-3, 84.22), (true, 5e-3, 59.55)] {
        let omega = f64::sqrt(700.0 / inertia);
        assert!((omega / TAU - published).abs() < 0.005, "{omega}");
        for engine in engines() {
            let integrator = engine.name().capabilities().integrator.unwrap();
            for (step, ticks) in [(STEP, 64_000), (1.0 / 2e3, 2_000), (1.0 / 1e3, 1_000), (1.0 / 600.0, 600)] {
                let Distortion { damping, shift } = integrator.distortion(omega, step).unwrap();
                let turned = omega * (1.0 + shift);
                let decay = turned * damping / (1.0 - damping * damping).sqrt();
                let ring = ring_down(engine, held, step, ticks);
                let exact = |k: usize| {
                    let t = (k + 1) as f64 * step;
                    1e-3 * (-decay * t).exp() * (turned * t).cos()
                };
                let off = ring.iter().enumerate().map(|(k, found)| (found - exact(k)).abs()).fold(0.0, f64::max);
                println!("{} held {held} at {step} s: {off:.1e} rad off", engine.name());
                // The rounding of 64 000 ticks: 2e-15 rad.
                assert!(off < 1e-13, "{} held {held} at {step} s: {off:e} rad", engine.name());
            }
        }
    }
}
