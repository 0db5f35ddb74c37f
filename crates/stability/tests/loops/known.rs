//! Two bodies at common settings: warnings, what differences cost, and how long an analysis takes.
use crate::axes::{TAU, Tuning, analyse, body, chain, report, servo};
use servobench_plant::Chain;
use servobench_stability::{Depth, Loop, VelocitySignal};
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
