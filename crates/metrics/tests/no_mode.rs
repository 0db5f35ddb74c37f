//! Motions without a mode: none may be reported, whatever they look like.
use core::f64::consts::PI;
use servobench_metrics::{Signal, Vibration, vibration};
use servobench_testkit::Random;

const RATE: f64 = 8000.0;
/// Records of each kind; more by `SERVOBENCH_SWEEP=3000`.
const CASES: usize = 125;
/// Largest distance at which a mode still stands for an oscillation with a frequency, but without a damping ratio.
const NEAR: f64 = 0.05;
/// Records in a hundred that may have a mode nevertheless.
const WRONG: usize = 1;

fn cases() -> usize {
    std::env::var("SERVOBENCH_SWEEP").ok().and_then(|text| text.parse().ok()).unwrap_or(CASES)
}

/// Nearly normal, of standard deviation 1: the sum of twelve.
fn normal(random: &mut Random) -> f64 {
    (0..12).map(|_| random.unit()).sum::<f64>() - 6.0
}

fn times(seconds: f64) -> impl Iterator<Item = f64> {
    (0_u32..).map(|k| f64::from(k) / RATE).take_while(move |t| *t < seconds)
}

/// Vibration of a record in which nothing smaller than `least` matters.
fn of(values: &[f64], least: f64) -> Vibration {
    let largest = values.iter().fold(0.0, |most: f64, y| most.max(y.abs()));
    let signal = Signal { values, start: 0.0, step: 1.0 / RATE, resolution: 8.0 * f64::EPSILON * largest, least };
    vibration(&signal, None).unwrap()
}

#[track_caller]
fn assert_rare(kind: &str, found: &[Vibration]) {
    let wrong: Vec<_> = found.iter().filter(|found| found.mode().is_ok()).collect();
    println!("{kind}: {} of {} have a mode", wrong.len(), found.len());
    assert!(wrong.len() * 100 <= WRONG * found.len(), "{kind}: {} of {}, {wrong:?}", wrong.len(), found.len());
}

/// White noise beside a rest or a tail is not a vibration.
#[test]
fn noise() {
    let mut random = Random::seeded(21);
    let found: Vec<_> = (0..cases())
        .map(|_| {
            let (seconds, size) = (random.between(0.1, 1.0), random.logarithmic(1e-8, 1e-4));
            let (tail, tau) = (size * random.between(0.0, 30.0), random.between(0.02, 0.3));
            let values: Vec<f64> =
                times(seconds).map(|t| tail * (-t / tau).exp() + size * normal(&mut random)).collect();
            of(&values, 0.0)
        })
        .collect();
    assert_rare("noise", &found);
    let swings = found.iter().filter(|found| found.amplitude > 0.0).count();
    assert!(swings * 100 <= found.len(), "{swings} of {}", found.len());
}

/// A load that wanders, moved by noise through a low pass of second order: it swings, but without a frequency and
/// damping of its own.
#[test]
fn wandering() {
    let mut random = Random::seeded(22);
    let found: Vec<_> = (0..cases())
        .map(|_| {
            let (seconds, pole) = (random.between(0.3, 1.0), 2.0 * PI * random.logarithmic(20.0, 400.0));
            let share = 1.0 - (-pole / RATE).exp();
            let (mut one, mut two) = (0.0, 0.0);
            // Starts from its own past.
            let settle = |one: &mut f64, two: &mut f64, y: f64| {
                *one += share * (y - *one);
                *two += share * (*one - *two);
                *two
            };
            for _ in 0..4000 {
                settle(&mut one, &mut two, normal(&mut random));
            }
            let values: Vec<f64> = times(seconds).map(|_| settle(&mut one, &mut two, normal(&mut random))).collect();
            of(&values, 0.0)
        })
        .collect();
    assert_rare("wandering", &found);
}

/// An encoder's last counts, by chance or as a tail passes through them: four increments matter.
#[test]
fn counts() {
    let mut random = Random::seeded(23);
    let found: Vec<_> = (0..cases())
        .map(|case| {
            let (seconds, count) = (random.between(0.1, 1.0), random.logarithmic(1e-8, 1e-5));
            let (tail, tau) = (random.between(0.0, 40.0), random.between(0.02, 0.3));
            let hold = random.logarithmic(1e-3, 50e-3);
            let (mut jitter, mut until) = (0.0, 0.0);
            let values: Vec<f64> = times(seconds)
                .map(|t| {
                    if t >= until {
                        jitter = if case % 2 == 0 { 0.0 } else { (1.2 * random.signed()).round() };
                        until = t + hold * random.unit();
                    }
                    count * ((tail * (-t / tau).exp()).round() + jitter)
                })
                .collect();
            of(&values, 4.0 * count)
        })
        .collect();
    assert_rare("counts", &found);
    let swings = found.iter().filter(|found| found.amplitude > 0.0).count();
    assert!(swings * 100 <= found.len(), "{swings} of {}", found.len());
}

/// Sticks for a while, slips somewhere, sticks again: at random times and on random paths, or to and fro without an end.
#[test]
fn stick() {
    let mut random = Random::seeded(24);
    let found: Vec<_> = (0..cases())
        .map(|case| {
            let (seconds, size) = (random.between(0.3, 1.0), random.logarithmic(1e-8, 1e-5));
            let slip = random.between(5e-3, 20e-3);
            let hold = random.between(2.0, 8.0) * slip;
            let (mut from, mut to, mut begins) = (0.0, random.signed(), hold * random.unit());
            let values: Vec<f64> = times(seconds)
                .map(|t| {
                    if t > begins + slip {
                        (from, begins) = (to, t + hold * if case % 2 == 0 { 1.0 } else { random.between(0.5, 1.5) });
                        to = if case % 2 == 0 { -from } else { random.signed() };
                    }
                    let u = ((t - begins) / slip).clamp(0.0, 1.0);
                    size * (from + (to - from) * (0.5 - 0.5 * (PI * u).cos()))
                })
                .collect();
            of(&values, 0.0)
        })
        .collect();
    assert_rare("stick", &found);
}

/// Up to four aperiodic tails, with a little noise: nothing swings but an overshoot.
#[test]
fn tails() {
    let mut random = Random::seeded(25);
    let found: Vec<_> = (0..cases())
        .map(|case| {
            let (seconds, size) = (random.between(0.2, 1.0), random.logarithmic(1e-8, 1e-4));
            let tails: Vec<(f64, f64)> =
                (0..=case % 4).map(|_| (size * random.signed(), seconds * random.logarithmic(0.02, 0.5))).collect();
            let noise = if case % 2 == 0 { 0.0 } else { size * random.logarithmic(1e-5, 1e-2) };
            let at = |t: f64| tails.iter().map(|(height, tau)| height * (-t / tau).exp()).sum::<f64>();
            let values: Vec<f64> = times(seconds).map(|t| at(t) + noise * normal(&mut random)).collect();
            of(&values, 1e-4 * size)
        })
        .collect();
    assert_rare("tails", &found);
}

/// A tail that stops halfway, as dry friction holds a load, with and without counts of an encoder: a constant from then on.
#[test]
fn held_tails() {
    let mut random = Random::seeded(26);
    let found: Vec<_> = (0..cases())
        .map(|case| {
            let (seconds, size) = (random.between(0.2, 1.0), random.logarithmic(1e-8, 1e-4));
            let (tau, held) = (seconds * random.logarithmic(0.05, 1.0), seconds * random.between(0.05, 0.8));
            let count = if case % 2 == 0 { 0.0 } else { size * random.logarithmic(1e-4, 3e-2) };
            let rounded = |y: f64| if count > 0.0 { count * (y / count).round() } else { y };
            let values: Vec<f64> = times(seconds).map(|t| rounded(size * (-t.min(held) / tau).exp())).collect();
            of(&values, (4.0 * count).max(1e-3 * size))
        })
        .collect();
    assert_rare("held tails", &found);
}

/// A load on a spring with dry friction alone: consecutive half cosines about ±`band`, each smaller by twice as much, until it is held.
/// It has a frequency, but not a damping ratio; another frequency is not there.
#[test]
fn dry_friction() {
    let mut random = Random::seeded(27);
    let (mut found, mut elsewhere) = (Vec::new(), Vec::new());
    for _ in 0..cases() {
        let (frequency, size) = (random.logarithmic(5.0, 100.0), random.logarithmic(1e-8, 1e-4));
        let band = size * random.logarithmic(0.02, 0.2);
        let at = |t: f64| {
            // Beginning of the swing of this half period, until one begins within the band.
            let (mut from, mut sign, mut left) = (size, 1.0, 2.0 * frequency * t);
            while left > 1.0 && from > band {
                (from, sign, left) = (from - 2.0 * band, -sign, left - 1.0);
            }
            if from <= band { sign * from } else { sign * (band + (from - band) * (PI * left).cos()) }
        };
        let seconds = (0.5 * size / band * random.between(1.0, 3.0)).max(4.0) / frequency / 2.0;
        let values: Vec<f64> = times(seconds.min(2.0)).map(at).collect();
        let vibration = of(&values, 1e-3 * size);
        let is_its_own = vibration.mode().is_ok_and(|mode| (mode.frequency / frequency - 1.0).abs() < NEAR);
        (if is_its_own { &mut found } else { &mut elsewhere }).push(vibration);
    }
    assert_rare("dry friction", &elsewhere);
    assert!(found.len() * 50 <= cases(), "{} of {}: {found:?}", found.len(), cases());
    assert!(found.iter().chain(&elsewhere).all(|vibration| vibration.amplitude > 0.0));
}

/// Lines, parabolas and ramps with an end, with noise or counts: a drift does not swing.
#[test]
fn drifts() {
    let mut random = Random::seeded(28);
    let found: Vec<_> = (0..cases())
        .map(|case| {
            let (seconds, size) = (random.between(0.1, 1.0), random.logarithmic(1e-8, 1e-4));
            let (slope, bend, end) = (size * random.signed(), size * random.signed(), random.between(0.1, 1.5));
            let noise = if case % 3 == 0 { size * random.logarithmic(1e-4, 1e-1) } else { 0.0 };
            let count = if case % 3 == 1 { size * random.logarithmic(1e-4, 1e-1) } else { 0.0 };
            let rounded = |y: f64| if count > 0.0 { count * (y / count).round() } else { y };
            let values: Vec<f64> = times(seconds)
                .map(|t| {
                    let u = (t / seconds).min(end);
                    rounded(slope * u + bend * u * u) + noise * normal(&mut random)
                })
                .collect();
            of(&values, (4.0 * count).max(1e-3 * size))
        })
        .collect();
    assert_rare("drifts", &found);
}
