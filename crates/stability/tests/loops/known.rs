//! Axes that were run: which of them are unstable is known from runs with an initial deviation.
use crate::axes::{TAU, Tuning, analyse, body, chain, ideal, report, servo};
use servobench_plant::Chain;
use servobench_stability::{Depth, Loop, LoopName, PositionFeedback, VelocitySignal};
use std::time::Instant;

const STIFF: f64 = 7e5;
const SOFT: f64 = 700.0;

fn two_bodies(stiffness: f64) -> Chain {
    let mut bodies = vec![body(0.005, 0.0), body(0.005, 0.0)];
    for body in &mut bodies {
        body.coordinate = servobench_base::Coordinate::Rotary;
    }
    chain(bodies, &[(stiffness, 0.01)])
}

/// Current, velocity and position bandwidth (Hz); the velocity loop's integral time is 4/ω, its gain J·ω.
fn bandwidths(current: f64, velocity: f64, position: f64) -> Tuning {
    let omega = TAU * velocity;
    Tuning { current, velocity: 0.01 * omega, integral_time: 4.0 / omega, filter_time: 0.0, position: TAU * position }
}

/// Two bodies of 0.005 kg·m², 16/8/4 kHz.
#[test]
fn two_bodies_at_common_settings() {
    let load = |model: Loop| Loop { position_feedback: PositionFeedback::Load, ..model };
    let filtered = Tuning { filter_time: 5e-3, ..bandwidths(1200.0, 100.0, 12.0) };
    let heavy = Tuning { velocity: 0.505 * TAU * 60.0, ..bandwidths(1200.0, 60.0, 12.0) };
    for (what, model, unstable) in [
        ("U1", servo(bandwidths(40.0, 200.0, 10.0), two_bodies(STIFF)), Some(LoopName::Velocity)),
        ("U2", servo(bandwidths(1200.0, 60.0, 80.0), two_bodies(STIFF)), Some(LoopName::Velocity)),
        ("U3", load(servo(bandwidths(1200.0, 60.0, 20.0), two_bodies(SOFT))), None),
        ("U4", servo(filtered, two_bodies(STIFF)), Some(LoopName::Position)),
        ("U5", servo(heavy, two_bodies(STIFF)), Some(LoopName::Velocity)),
        ("U6", servo(bandwidths(1200.0, 400.0, 12.0), two_bodies(SOFT)), None),
        ("U7", servo(bandwidths(2200.0, 60.0, 12.0), two_bodies(STIFF)), Some(LoopName::Velocity)),
        ("U8", servo(bandwidths(3500.0, 60.0, 12.0), two_bodies(STIFF)), Some(LoopName::Current)),
    ] {
        let report = report(&model);
        println!("{what}: {report:#?}");
        if let Some(instability) = &report.instability {
            println!("{what}: {instability}");
        }
        assert_eq!(report.instability.map(|found| found.name), unstable, "{what}");
    }
}

/// 10 kg on an ideal source at 16 kHz: 2·m/h = 320 000 N·s/m.
#[test]
fn one_mass_beyond_its_boundary() {
    for gain in [330_000.0, 400_000.0] {
        let mut model = ideal(16_000, 1, gain, chain(vec![body(10.0, 0.0)], &[]));
        model.closes_position = true;
        model.drive.position_gain = 20.0;
        let found = report(&model).instability.unwrap();
        assert_eq!(found.name, LoopName::Velocity);
        println!("{found}");
        let boundary = found.boundaries.below.unwrap().gain;
        // The position loop takes K_v·h/2 = 0.06 % of the gain.
        assert!((boundary / 320_000.0 - 1.0).abs() < 1e-3, "{boundary}");
    }
}

#[test]
fn a_rotor_under_far_too_much_gain() {
    let tuning = Tuning { current: 1200.0, velocity: 9.0, integral_time: 10e-3, filter_time: 0.0, position: 30.0 };
    let mut rotor = body(1e-3, 0.0);
    rotor.coordinate = servobench_base::Coordinate::Rotary;
    let found = report(&servo(tuning, chain(vec![rotor], &[]))).instability.unwrap();
    println!("{found}");
    assert_eq!(found.name, LoopName::Velocity);
    assert!(found.to_string().starts_with("the loop is unstable: velocity loop, gain 9 N·m·s/rad: a pole of |λ| "));
    assert!(found.boundaries.below.is_some());
}

/// The order of the loops is said with its reason.
#[test]
fn an_outer_loop_above_an_inner_one_is_a_warning() {
    let said = |tuning| {
        let warnings = report(&servo(tuning, two_bodies(STIFF))).warnings;
        warnings.iter().map(ToString::to_string).collect::<Vec<_>>()
    };
    assert_eq!(
        said(bandwidths(1200.0, 60.0, 80.0)),
        [
            "the bandwidth of the position loop (80 Hz) is above that of the velocity loop (60 Hz): the velocity loop does not \
             follow what the position loop asks for as fast as it asks, so that both swing"
        ]
    );
    let current = said(bandwidths(40.0, 200.0, 10.0));
    assert_eq!(current.len(), 1);
    assert!(
        current[0].starts_with("the bandwidth of the velocity loop (200 Hz) is above that of the current loop (40 Hz)")
    );
    assert!(said(bandwidths(1200.0, 60.0, 60.0)).is_empty(), "equal is not above");
}

/// An encoder that only gives positions costs half a period of the velocity loop.
#[test]
fn differences_of_positions_lower_the_boundary() {
    let boundary = |signal| {
        let model = servo(bandwidths(1200.0, 60.0, 12.0), chain(vec![body(0.01, 0.0)], &[]));
        let report = report(&Loop { velocity_signal: signal, ..model });
        report.loops[1].boundaries.unwrap().above.unwrap().factor
    };
    let (encoder, differences) = (boundary(VelocitySignal::Encoder), boundary(VelocitySignal::Differences));
    assert!(differences < 0.9 * encoder, "{encoder} {differences}");
}

/// What an analysis costs is printed; a verdict is asked for by every run.
#[test]
fn a_verdict_takes_milliseconds() {
    let stable = servo(bandwidths(1200.0, 60.0, 12.0), two_bodies(SOFT));
    let unstable = servo(bandwidths(1200.0, 60.0, 80.0), two_bodies(STIFF));
    for (what, model) in [("stable", stable), ("unstable", unstable)] {
        for depth in [Depth::Verdict, Depth::Boundaries] {
            let best = (0..20).map(|_| {
                let start = Instant::now();
                analyse(&model, depth).unwrap();
                start.elapsed().as_secs_f64()
            });
            let best = best.fold(f64::INFINITY, f64::min);
            println!("{what}, {depth:?}: {:.2} ms", 1e3 * best);
            // On any machine: a search that does not end would take longer.
            assert!(best < 5.0);
        }
    }
}
