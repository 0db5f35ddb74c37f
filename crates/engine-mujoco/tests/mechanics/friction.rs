//! Sticking and sliding.
use super::{STEP, body, efforts, motion, setup, ticks};
use servobench_base::Coordinate;
use servobench_base::Setpoint;
use servobench_engine_mujoco::Mujoco;
use servobench_plant::{Body, Chain, Drive, DryFriction, Engine as _, Exact, Friction, Input, Link};

const DRY: Friction =
    Friction { viscous: 0.0, dry: DryFriction { coulomb: 20.0, breakaway: 30.0, stribeck_velocity: 2e-3 } };

fn slider() -> Body {
    Body { friction: DRY, ..body("load", Coordinate::Linear, 10.0) }
}

/// A motor with stiction and a spring to a table with stiction. Nothing closed describes it; the engine `exact` does
/// the same in another way (stuck bodies struck out of the matrix exponential).
fn stick_slip(motor_friction: Friction) -> Chain {
    let motor =
        Body { friction: Friction { viscous: 15.0, ..motor_friction }, ..body("motor", Coordinate::Linear, 20.0) };
    let table = Body { bias: 1.5, friction: Friction { viscous: 4.0, ..DRY }, ..slider() };
    Chain::new(vec![motor, table], vec![Link { stiffness: 6e5, damping: 500.0 }]).unwrap()
}

fn assert_agrees(chain: Chain, drive: Drive, seconds: f64, input: impl Fn(f64) -> Input) {
    let setup = setup(chain, drive, STEP, &[]);
    let mut mujoco = Mujoco.build(&setup).unwrap();
    let mut exact = Exact.build(&setup).unwrap();
    let (mut worst, mut travel, mut stops) = (0.0_f64, 0.0_f64, 0);
    for k in 0..ticks(seconds, STEP) {
        let input = input(k as f64 * STEP);
        let moved = exact.bodies()[1].velocity != 0.0;
        mujoco.advance(&input).unwrap();
        exact.advance(&input).unwrap();
        for (one, other) in mujoco.bodies().iter().zip(exact.bodies()) {
            assert_eq!(one.velocity == 0.0, other.velocity == 0.0, "tick {k}: only one of them sticks");
            worst = worst.max((one.position - other.position).abs());
            travel = travel.max(other.position.abs());
        }
        stops += usize::from(moved && exact.bodies()[1].velocity == 0.0);
    }
    assert!(stops > 3 && travel > 1e-3, "{stops} stops, {travel} m");
    // Both stop and break away in the same ticks. In between, a held body gives way to its neighbour within the tick
    // by (ω·h)³/6 of that one's motion, with ω = 245 rad/s: 6e-7.
    assert!(worst < 1e-6 * travel, "{worst:e} m apart after {travel} m and {stops} stops");
}

#[test]
fn stick_slip_agrees_with_the_engine_exact() {
    let dry = DryFriction { coulomb: 5.0, breakaway: 6.0, stribeck_velocity: 1e-2 };
    assert_agrees(stick_slip(Friction { dry, ..Friction::NONE }), Drive::Effort, 2.0, |t| {
        efforts(60.0 * (8.0 * t).sin(), 3.0 * (31.0 * t).cos())
    });
}

#[test]
fn a_load_that_sticks_behind_a_prescribed_base_agrees_with_the_engine_exact() {
    // A sinusoidal base in pieces of constant snap, one per tick.
    let (amplitude, w) = (0.01, 12.0_f64);
    assert_agrees(stick_slip(Friction::NONE), Drive::Prescribed, 2.0, |t| {
        let (sin, cos) = (w * t).sin_cos();
        motion(Setpoint {
            x: amplitude * (1.0 - cos),
            v: amplitude * w * sin,
            a: amplitude * w.powi(2) * cos,
            j: -amplitude * w.powi(3) * sin,
            s: -amplitude * w.powi(4) * cos,
        })
    });
}
