//! Random axes: a lower ceiling is not faster, and random set-points are not better than an advice.
mod axis;

use axis::{Axis, family};
use servobench_advise::{SetPoint, advise};
use servobench_motion::Limits;
use servobench_testkit::Random;

/// Size of a test: `few`, or `SERVOBENCH_SWEEP` times as many.
fn count(few: usize) -> usize {
    few * std::env::var("SERVOBENCH_SWEEP").ok().and_then(|times| times.parse().ok()).unwrap_or(1)
}

fn axis(random: &mut Random) -> Axis {
    let mut between = |low: f64, high: f64| low * (high / low).powf(random.unit());
    let (distance, velocity, acceleration) = (between(0.05, 0.5), between(0.2, 1.5), between(2.0, 20.0));
    let frequency = between(6.0, 50.0);
    let (width, payload) = (between(0.02, 0.2), between(5.0, 20.0));
    let gain = between(20.0, 200.0);
    Axis {
        distance,
        ceiling: Limits { velocity, acceleration, jerk: f64::INFINITY, snap: f64::INFINITY },
        frequencies: [frequency * (1.0 - width), frequency * (1.0 + width)],
        payloads: [payload, 1.2 * payload],
        vibration: between(1e-5, 5e-4),
        force: 1.2 * payload * acceleration * between(0.4, 1.6),
        following: velocity / gain * between(0.3, 2.5),
        gain,
        families: vec![family(2, false), family(3, false), family(4, false), family(2, true), family(3, true)],
        runs: 0,
    }
}

/// Ceilings relative to the highest.
const CEILINGS: [f64; 4] = [1.0, 0.85, 0.6, 0.4];
/// Factor of time by which nothing else may be faster.
const FASTER: f64 = 0.995;
/// One in this many axes may hide its best lobe from the search.
const HIDDEN: usize = 20;

/// Many axes with `SERVOBENCH_SWEEP=20`.
#[test]
fn a_lower_ceiling_is_not_faster() {
    let mut random = Random::seeded(3);
    let axes = count(5);
    let mut found = Vec::new();
    for index in 0..axes {
        let axis = axis(&mut random);
        let times = CEILINGS.map(|part| {
            let mut axis = axis.clone();
            axis.ceiling.velocity *= part;
            advise(&axis.question(), &mut axis).map_or(f64::INFINITY, |advice| advice.worst.time)
        });
        let falls = times.windows(2).any(|pair| pair[1] < FASTER * pair[0]);
        found.extend(falls.then(|| format!("{index}: {times:?}")));
    }
    println!("{axes} axes, faster with a lower ceiling: {found:?}");
    assert!(found.len() <= axes / HIDDEN, "{found:?}");
}

/// 8 000 set-points with lengths of averages from the shortest to four times that with `SERVOBENCH_SWEEP=8`.
#[test]
fn random_set_points_are_not_better() {
    let mut random = Random::seeded(7);
    let mut compared = 0;
    for index in 0..5 {
        let mut axis = axis(&mut random);
        let advice = advise(&axis.question(), &mut axis).unwrap();
        let Limits { velocity, acceleration, .. } = axis.ceiling;
        for _ in 0..count(1_000) {
            let mut below = |most: f64| most * 4_f64.powf(-random.unit());
            let cruise = axis.distance / below(velocity);
            let ramp = axis.distance / cruise / below(acceleration);
            let (rise, rise_of_jerk) = (ramp * random.unit(), ramp * random.unit());
            for (family, kind) in axis.families.iter().enumerate() {
                let boxes = [cruise, ramp, rise, rise.min(rise_of_jerk)];
                let point = SetPoint::by_boxes(family, kind.order, axis.distance, boxes);
                let Some(time) = axis.time_of(&point) else { continue };
                compared += 1;
                assert!(time >= FASTER * advice.worst.time, "{index}: {time} s with {point:?}, {advice:?}");
            }
        }
    }
    println!("{compared} set-points keep all limits");
    assert!(compared > 100);
}
