//! Boundaries of random loops against bisection of runs.
//!
//! The sweep is small in ordinary runs. `SERVOBENCH_SWEEP=200 cargo test --release -p servobench-sim --test stability -- --nocapture`
//! runs more loops, bisects each boundary by runs to 0.02 % and prints how far off the analysis was at most.
use crate::deviation::grows;
use crate::files::report;
use crate::random::{Random, random_loop};
use servobench_scenario::{Actuator, CurrentGain, Scenario};
use servobench_stability::{Depth, GainName};
use std::time::Instant;

const SEED: u64 = 20_261_122;
/// The bar, as a share of the gain.
const BAR: f64 = 0.005;

/// `scenario` with the gain `name` by `factor`.
fn scaled(scenario: &Scenario, name: GainName, factor: f64) -> Scenario {
    let mut scaled = scenario.clone();
    let (Actuator::Pmsm { drive, .. } | Actuator::IdealSource { drive, .. }) = &mut scaled.actuator else {
        panic!("a motor with a drive")
    };
    match name {
        GainName::Position => drive.position.gain *= factor,
        GainName::Velocity => drive.velocity.gain *= factor,
        GainName::CurrentBandwidth | GainName::CurrentD | GainName::CurrentQ => {
            let Actuator::Pmsm { current, .. } = &mut scaled.actuator else { panic!("a synchronous motor") };
            let CurrentGain::Bandwidth(alpha) = &mut current.gain else { panic!("a bandwidth") };
            *alpha *= factor;
        }
    }
    scaled
}

/// The factor between `same`, at which runs do as at 1, and `other`, at which they do not; as near as runs can tell.
fn bisected(scenario: &Scenario, name: GainName, is_unstable: bool, mut same: f64, mut other: f64) -> f64 {
    while (same / other - 1.0).abs() > 2e-4 {
        let middle = (same * other).sqrt();
        let Some(grows) = grows(&scaled(scenario, name, middle)) else { break };
        *(if grows == is_unstable { &mut same } else { &mut other }) = middle;
    }
    (same * other).sqrt()
}

#[test]
fn boundaries_are_where_runs_change_from_decay_to_growth() {
    let asked: Option<usize> = std::env::var("SERVOBENCH_SWEEP").ok().and_then(|count| count.parse().ok());
    let count = asked.unwrap_or(20);
    let mut random = Random(SEED);
    let (mut done, mut drawn, mut worst, mut kinds) = (0, 0, 0.0_f64, [0; 3]);
    let (mut slowest, mut misses, mut undecided) = ([0.0_f64; 2], Vec::new(), 0);
    while done < count {
        drawn += 1;
        let scenario = random_loop(&mut random);
        let start = Instant::now();
        let verdict = report(&scenario, Depth::Verdict).is_stable();
        slowest[0] = slowest[0].max(start.elapsed().as_secs_f64());
        let start = Instant::now();
        let report = report(&scenario, Depth::Boundaries);
        slowest[1] = slowest[1].max(start.elapsed().as_secs_f64());
        let is_unstable = !report.is_stable();
        assert_eq!(verdict, report.is_stable());
        let all: Vec<(GainName, f64)> = report
            .loops
            .iter()
            .filter_map(|found| Some((found.gain_name, found.boundaries?)))
            .flat_map(|(name, at)| [at.below, at.above].map(|at| at.map(|at| (name, at.factor))))
            .flatten()
            .collect();
        if all.is_empty() {
            continue;
        }
        let (name, factor) = random.pick(&all);
        // Runs at 1 and on the way do as the analysis says, and beyond the boundary they do not.
        let way = [0.0, 0.4, 0.8].map(|share| factor.powf(share));
        let outward = if factor > 1.0 { 1.0 + BAR } else { 1.0 / (1.0 + BAR) };
        let (before, behind) = (factor / outward, factor * outward);
        let does = |factor: f64| grows(&scaled(&scenario, name, factor));
        let is_on_the_way = |at: f64| (at - factor).abs() > 2.0 * BAR * factor;
        let expected = way.iter().filter(|&&at| is_on_the_way(at)).map(|&at| (at, is_unstable));
        let expected = expected.chain([(before, is_unstable), (behind, !is_unstable)]);
        let found: Vec<(f64, Option<bool>)> =
            expected.map(|(at, expected)| (at, does(at).map(|grows| grows == expected))).collect();
        if found.iter().any(|(_, agrees)| agrees.is_none()) {
            undecided += 1;
            println!("loop {drawn}: {name:?} at {factor}: no run of 600 000 ticks tells: {found:?}");
            if found.iter().all(|(_, agrees)| *agrees != Some(false)) {
                continue;
            }
        }
        done += 1;
        kinds[match name {
            GainName::Position => 2,
            GainName::Velocity => 1,
            GainName::CurrentBandwidth | GainName::CurrentD | GainName::CurrentQ => 0,
        }] += 1;
        if found.iter().any(|(_, agrees)| *agrees == Some(false)) {
            println!("loop {drawn}: {name:?} at {factor}, unstable {is_unstable}: {found:?}\n{report:?}\n{scenario:?}");
            misses.push(drawn);
            continue;
        }
        if asked.is_some() {
            let boundary = bisected(&scenario, name, is_unstable, before, behind);
            worst = worst.max((boundary / factor - 1.0).abs());
        }
    }
    let [current, velocity, position] = kinds;
    println!(
        "seed {SEED}: {done} loops of {drawn} drawn, {undecided} that runs cannot tell ({current} boundaries of the current loop, {velocity} of the velocity loop, \
         {position} of the position loop); worst deviation {:.4} %; slowest verdict {:.2} ms, with all boundaries {:.0} ms",
        100.0 * worst,
        1e3 * slowest[0],
        1e3 * slowest[1],
    );
    assert_eq!(misses, [0_usize; 0], "loops whose boundary is off by more than {BAR}");
}
