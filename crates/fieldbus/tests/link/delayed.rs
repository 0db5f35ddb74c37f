//! Without faults the output is the motion of the samples, a constant time later.
use crate::rig::{BUS, MOTION, RATE, Rig, follow, sample, settings};
use servobench_base::{Setpoint, Tick};
use servobench_fieldbus::Interpolation;
use servobench_fieldbus::link::Settings;
use servobench_motion::interpolate::{Interpolator, Mode, Sample};
use servobench_motion::{Limits, Order, Profile};

const LIMITS: Limits = Limits { velocity: 1.0, acceleration: 5.0, jerk: 50.0, snap: 1000.0 };
/// Cycles of the motion task before the move, in which the drive comes to power.
const BEFORE: u64 = 12;

/// At rest, a move of a metre, at rest again.
fn motion(cycle: u64) -> Setpoint {
    let profile = Profile::plan(Order::Fourth, 1.0, &LIMITS).unwrap();
    profile.at((cycle as f64 - BEFORE as f64) * MOTION as f64 / RATE)
}

/// Interpolation of the samples by `mode` at `tick` − `delay`; the oracle is the interpolator, which does not depend on ticks.
fn expected(mode: Mode, tick: u64, delay: u64) -> Setpoint {
    let then = tick - delay;
    let mut interpolator = Interpolator::new(mode, MOTION as f64 / RATE).unwrap();
    for cycle in 0..=then / MOTION + mode.delay_samples() as u64 {
        interpolator.push(sample(motion(cycle))).unwrap();
    }
    interpolator.at((then % MOTION) as f64 / MOTION as f64).unwrap().setpoint
}

#[test]
fn the_output_is_the_interpolation_at_the_delayed_time() {
    for mode in Mode::ALL {
        for margin in [0, 7, 320, 640] {
            let mut rig = Rig::new(Settings { interpolation: mode, margin, ..settings() });
            let delay = rig.params.delay();
            assert_eq!(delay, mode.delay_samples() as u64 * MOTION + u64::from(margin));
            rig.run(BEFORE, |cycle| follow(sample(motion(cycle))));
            let mut moved = 0.0;
            for _ in 0..100 {
                rig.run(1, |cycle| follow(sample(motion(cycle))));
                assert_eq!(rig.feedback().interpolation, Interpolation::Run1, "{mode:?}");
                // Within the last bus cycle, base tick by base tick.
                for tick in rig.tick - BUS..rig.tick {
                    let at = rig.state.setpoint(&rig.params, Tick(tick));
                    let expected = expected(mode, tick, delay);
                    // The same polynomial at the same fraction; at its seams either of two polynomials.
                    let same = (at.x - expected.x).abs() < 1e-14 && (at.v - expected.v).abs() < 1e-12;
                    assert!(same, "{mode:?}, margin {margin}, tick {tick}: {at:?} for {expected:?}");
                }
                let counts = f64::from(rig.commands.target_position);
                assert!((counts - 1e6 * rig.setpoint().x).abs() <= 0.5 + 1e-9, "to the nearest count");
                moved = rig.setpoint().x;
            }
            assert!((moved - 1.0).abs() < 1e-12, "{mode:?}: the move ends at {moved}");
            assert_eq!(rig.drive.counts, 1_000_000);
        }
    }
}

#[test]
fn offsets_carry_velocity_and_torque_of_the_set_point() {
    let mut rig = Rig::new(settings());
    let creeping = |cycle: u64| follow(Sample { x: 0.01 * cycle as f64, v: 0.5, a: 0.0, torque: 2.0 });
    rig.run(60, creeping);
    assert_eq!((rig.commands.velocity_offset, rig.commands.torque_offset), (500_000, 200));
    assert!((rig.setpoint().x - 0.5 * (rig.tick - BUS - MOTION) as f64 / RATE).abs() < 1e-9);
}

#[test]
fn a_motion_task_as_fast_as_the_bus_is_followed_sample_by_sample() {
    let mut rig = Rig::new(Settings { motion_cycle: settings().bus_cycle, ..settings() });
    assert_eq!(rig.params.delay(), BUS);
    let motion = |tick: u64| Setpoint { x: 0.1 * (1.0 - (tick as f64 / RATE).cos()), ..Setpoint::default() };
    for _ in 0..2_000 {
        let at = motion(rig.tick);
        rig.write(rig.tick, follow(Sample { x: at.x, v: 0.1 * (rig.tick as f64 / RATE).sin(), ..Sample::default() }));
        rig.cycle();
        if rig.tick > 30 * BUS {
            assert_eq!(rig.feedback().interpolation, Interpolation::Run1);
        }
        if rig.tick > 1_000 * BUS {
            // The starting difference is removed: the output is now the sample of the cycle before.
            assert!((rig.setpoint().x - motion(rig.tick - 2 * BUS).x).abs() < 1e-15);
        }
    }
}
