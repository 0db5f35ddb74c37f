//! What no loop reaches is out of the verdict by structure.
use crate::axes::{Tuning, analyse, body, chain, ideal, report, running, sensors, servo, ticks};
use servobench_drive::{self as drive, Parameter};
use servobench_plant::CurrentSensor;
use servobench_sim::{AtRest, WiredSensors};
use servobench_stability::{Depth, Loop, LoopName, StabilityError, VelocitySignal, analyse as analyse_running};
use servobench_testkit::Random;

const TUNING: Tuning =
    Tuning { current: 1200.0, velocity: 0.01 * 377.0, integral_time: 0.01, filter_time: 0.0, position: 40.0 };

fn three_bodies() -> servobench_plant::Chain {
    chain(vec![body(0.003, 0.0), body(0.004, 0.0), body(0.003, 0.0)], &[(4e4, 0.0), (9e4, 0.0)])
}

/// Without a gain the axis is a free double integrator: two poles at 1 that would grow under a tolerance, and undamped modes.
#[test]
fn an_axis_that_no_loop_holds_is_not_unstable() {
    for signal in [VelocitySignal::Encoder, VelocitySignal::Differences] {
        let model = Loop { velocity_signal: signal, ..ideal(12_000, 3, 0.0, three_bodies()) };
        let report = report(&model);
        assert!(report.is_stable(), "{signal:?}: {report:?}");
        assert_eq!(report.largest, None, "there is no loop");
        assert_eq!(
            (report.loops[0].boundaries, report.loops[0].least_damped, report.loops[0].bandwidth),
            (None, None, None)
        );
        let integrating = drive::velocity::Params { integral_time: Some(1e-3), ..model.drive.velocity };
        let model = Loop { drive: drive::Params { velocity: integrating, ..model.drive }, ..model };
        assert!(analyse(&model, Depth::Verdict).unwrap().is_stable());
    }
}

/// With the position loop open the position is in no loop, also where velocities are differences of positions.
#[test]
fn a_position_that_nobody_holds_is_in_no_loop() {
    for signal in [VelocitySignal::Encoder, VelocitySignal::Differences] {
        for closes_position in [true, false] {
            let mut model = servo(Tuning { position: 0.0, ..TUNING }, chain(vec![body(0.01, 0.0)], &[]));
            (model.velocity_signal, model.closes_position) = (signal, closes_position);
            let report = report(&model);
            assert!(report.is_stable());
            let velocity = report.loops.iter().find(|found| found.name == LoopName::Velocity).unwrap();
            assert!(velocity.least_damped.unwrap().magnitude < 0.999, "no pole at 1: {velocity:?}");
            assert_eq!(report.loops.len(), 2 + usize::from(closes_position));
        }
    }
}

/// The same where currents and voltages of a d current turn with the rotor: they meet again but for roundings.
#[test]
fn a_position_that_a_current_turns_with_is_in_no_loop() {
    let mut random = Random::seeded(5);
    for _ in 0..12 {
        let transmission = random.logarithmic(1e-3, 1e-2);
        let mut motor = body(0.01, 0.0);
        motor.transmission = transmission;
        let load = body(0.01 / (transmission * transmission), 0.0);
        let link = (random.logarithmic(3e3, 3e4) * load.inertia, random.logarithmic(3.0, 30.0) * load.inertia);
        let mut model = servo(Tuning { velocity: 0.4, position: 0.0, ..TUNING }, chain(vec![motor, load], &[link]));
        model.velocity_signal = VelocitySignal::Differences;
        (model.drive.velocity_every, model.drive.position_every) = (ticks(8), ticks(16));
        model.drive.transmission = transmission;
        let drive::Stage::Current { params, every } = &mut model.drive.stage else { panic!("a current loop") };
        *every = ticks(2);
        params.d_reference = -random.logarithmic(0.1, 5.0);
        model.d_current = params.d_reference;
        let gain_error = [random.logarithmic(0.9, 1.1) - 1.0; 2];
        let late = CurrentSensor { gain_error, delay: 1, shift: 1e-5, ..CurrentSensor::default() };
        let sensors = WiredSensors { current: Some(late), ..sensors(&model, 62.5e-6) };
        let running = Box::new(AtRest::new(&model, &sensors, None).unwrap());
        let report = analyse_running(&model, running, Depth::Boundaries).unwrap();
        let velocity = report.loops.iter().find(|found| found.name == LoopName::Velocity).unwrap();
        for pole in [report.largest, report.slowest.real, velocity.least_damped].into_iter().flatten() {
            assert!((pole.magnitude - 1.0).abs() > 1e-5, "no pole at 1: {pole:?}");
        }
    }
}

/// The velocity loop open, the rotor turns at any constant speed: the pole at 1 is counted, not tolerated. With
/// friction it is none.
#[test]
fn a_rotor_under_a_current_loop_alone_turns_on() {
    for viscous in [0.0, 1e-4] {
        for every in [1, 2] {
            let mut model = servo(Tuning { velocity: 0.0, ..TUNING }, chain(vec![body(0.01, viscous)], &[]));
            let drive::Stage::Current { every: current, .. } = &mut model.drive.stage else { panic!("a current loop") };
            *current = crate::axes::ticks(every);
            let report = report(&model);
            assert!(report.is_stable(), "{viscous} {every}: {:?}", report.instability);
            // Friction stops it with b/J = 0.01 1/s; without, what is left are the current loop's own poles.
            let largest = report.largest.unwrap();
            assert_eq!(largest.growth > -0.02, viscous > 0.0, "{viscous} {every}: {largest:?}");
        }
    }
}

/// A drive that believes in ten times the flux linkage decouples ten times the back-EMF: with the shaft free that is a loop of its
/// own, which no gain of the velocity loop cures.
#[test]
fn decoupling_ten_times_the_back_emf_is_the_current_loops_fault() {
    let mut model = servo(Tuning { velocity: 1e-4, position: 0.0, ..TUNING }, chain(vec![body(1e-6, 0.0)], &[]));
    let drive::Stage::Current { params, .. } = &mut model.drive.stage else { panic!("a current loop") };
    params.motor.flux_linkage *= 10.0;
    let found = report(&model).instability.unwrap();
    assert_eq!((found.name, found.boundaries.is_none()), (LoopName::Current, true), "{found:?}");
    assert!(found.to_string().ends_with("no bandwidth from a thousandth to a thousand times this one makes it stable"));
}

/// Oracle: the sum of the torque constant's derivative: with L_d = L_q a current at standstill changes nothing but the ripple of a
/// rotor that turns under a held voltage.
#[test]
fn a_holding_current_of_a_round_rotor_hardly_moves_the_boundary() {
    let model = servo(TUNING, chain(vec![body(0.01, 0.0)], &[]));
    let held = {
        let mut held = Loop { d_current: -5.0, ..model.clone() };
        let drive::Stage::Current { params, .. } = &mut held.drive.stage else { panic!("a current loop") };
        params.d_reference = held.d_current;
        held
    };
    let factor = |model: &Loop| report(model).loops[1].boundaries.unwrap().above.unwrap().factor;
    let (free, held) = (factor(&model), factor(&held));
    assert!((free / held - 1.0).abs() < 0.02 && free.to_bits() != held.to_bits(), "{free} {held}");
}

#[test]
fn what_cannot_be_analysed_is_said() {
    let right = ideal(12_000, 1, 3.0, three_bodies());
    let mut model = right.clone();
    model.drive.position_gain = f64::NAN;
    let error = analyse_running(&model, running(&right), Depth::Verdict).unwrap_err();
    assert!(matches!(error, StabilityError::Drive(error) if error.name == Parameter::POSITION_GAIN));
    let mixed = Loop { source: servo(TUNING, three_bodies()).source, ..right.clone() };
    assert!(matches!(analyse_running(&mixed, running(&right), Depth::Verdict), Err(StabilityError::SourceDoesNotFit)));
    // 1e300 N·s/m on 10 g is a pole of −1e298 a tick.
    let model = ideal(12_000, 1, 1e300, chain(vec![body(0.01, 0.0)], &[]));
    let error = analyse(&model, Depth::Verdict).unwrap_err();
    assert_eq!(error, StabilityError::Overflow { ticks: 1 });
}
