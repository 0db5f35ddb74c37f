//! Boundaries of random loops against runs.
//!
//! The sweep is small in ordinary runs. `SERVOBENCH_SWEEP=200 cargo test --release -p servobench-sim --test stability -- --nocapture`
//! runs more loops, and `SERVOBENCH_SEED` others. Runs 0.5 % to both sides of a boundary must fade and grow as the analysis says; with
//! the first variable set, how much nearer they still do so is printed. Where no run tells, what it shows and what the analysis has
//! is printed: loops with a mode on the circle but for rounding.
use crate::deviation::{NotTold, growth};
use crate::files::report;
use crate::random::random_loop;
use servobench_drive::Stage;
use servobench_drive::current::{Gains, Tuning};
use servobench_scenario::{Actuator, Scenario};
use servobench_stability::{Depth, GainName};
use servobench_testkit::Random;
use std::time::Instant;

const SEED: u64 = 20_261_122;
/// The bar, as a share of the gain.
const BAR: f64 = 0.005;
/// How near to the boundary runs are looked at where the sweep is asked for.
const SHARES: [f64; 4] = [BAR, 0.002, 0.001, 0.0005];

/// `scenario` with the gain `name` by `factor`.
fn scaled(scenario: &Scenario, name: GainName, factor: f64) -> Scenario {
    let mut scaled = scenario.clone();
    let (Actuator::Pmsm { drive, .. } | Actuator::IdealSource { drive, .. }) = &mut scaled.actuator else {
        panic!("a motor with a drive")
    };
    match name {
        GainName::Position => drive.params.position_gain *= factor,
        GainName::Velocity => drive.params.velocity.k_p *= factor,
        GainName::CurrentBandwidth | GainName::CurrentD | GainName::CurrentQ => {
            let Stage::Current { params, .. } = &mut drive.params.stage else { panic!("a synchronous motor") };
            let Some(Tuning::Bandwidth(alpha)) = &mut drive.current_tuning else { panic!("a bandwidth") };
            *alpha *= factor;
            params.gains = Gains::tuned(&params.motor, Tuning::Bandwidth(*alpha), None);
        }
    }
    scaled
}

/// A boundary of a random loop as the analysis has it.
struct Case {
    scenario: Scenario,
    name: GainName,
    factor: f64,
    is_unstable: bool,
}

impl Case {
    /// Whether runs with the gain by `at` do as the analysis says.
    ///
    /// # Errors
    /// [`NotTold`] where they do not tell.
    fn agrees(&self, at: f64) -> Result<bool, NotTold> {
        let is_beyond = (at > self.factor) == (self.factor > 1.0);
        growth(&scaled(&self.scenario, self.name, at)).map(|growth| (growth > 0.0) == (self.is_unstable != is_beyond))
    }

    /// At 1, on the way to the boundary and at the bar on both sides.
    fn along_the_way(&self) -> Vec<(f64, Result<bool, NotTold>)> {
        let way = [0.0, 0.4, 0.8].map(|share| self.factor.powf(share));
        let is_on_the_way = |at: &f64| (at - self.factor).abs() > 2.0 * BAR * self.factor;
        let sides = [self.factor / (1.0 + BAR), self.factor * (1.0 + BAR)];
        way.into_iter().filter(is_on_the_way).chain(sides).map(|at| (at, self.agrees(at))).collect()
    }

    /// The largest pole that the analysis has where runs do not agree.
    fn print_poles(&self, found: &[(f64, Result<bool, NotTold>)], of: impl Fn(&Result<bool, NotTold>) -> bool) {
        for (at, _) in found.iter().filter(|(_, agrees)| of(agrees)) {
            println!("    by {at}: {:?}", report(&scaled(&self.scenario, self.name, *at), Depth::Verdict).largest);
        }
    }

    /// The smallest of `SHARES` at which runs on both sides still do as the analysis says, and whether they contradict it nearer
    /// than that.
    fn confirmed(&self) -> (f64, bool) {
        let mut confirmed = BAR;
        for share in &SHARES[1..] {
            let found = [self.factor / (1.0 + share), self.factor * (1.0 + share)].map(|at| self.agrees(at));
            if !found.iter().all(|agrees| matches!(agrees, Ok(true))) {
                return (confirmed, found.iter().any(|agrees| matches!(agrees, Ok(false))));
            }
            confirmed = *share;
        }
        (confirmed, false)
    }
}

/// A random loop and one of its boundaries, if it has any.
fn draw(random: &mut Random, slowest: &mut [f64; 2]) -> Option<Case> {
    let scenario = random_loop(random);
    let start = Instant::now();
    let verdict = report(&scenario, Depth::Verdict).is_stable();
    slowest[0] = slowest[0].max(start.elapsed().as_secs_f64());
    let start = Instant::now();
    let report = report(&scenario, Depth::Boundaries);
    slowest[1] = slowest[1].max(start.elapsed().as_secs_f64());
    assert_eq!(verdict, report.is_stable());
    let all: Vec<(GainName, f64)> = report
        .loops
        .iter()
        .filter_map(|found| Some((found.gain_name, found.boundaries?)))
        .flat_map(|(name, at)| [at.below, at.above].map(|at| at.map(|at| (name, at.factor))))
        .flatten()
        .collect();
    if all.is_empty() {
        return None;
    }
    let (name, factor) = random.one_of(&all);
    Some(Case { scenario, name, factor, is_unstable: !verdict })
}

#[test]
fn boundaries_are_where_runs_change_from_decay_to_growth() {
    let asked: Option<usize> = std::env::var("SERVOBENCH_SWEEP").ok().and_then(|count| count.parse().ok());
    let count = asked.unwrap_or(12);
    let seed = std::env::var("SERVOBENCH_SEED").ok().and_then(|seed| seed.parse().ok()).unwrap_or(SEED);
    let mut random = Random::seeded(seed);
    let (mut done, mut drawn, mut undecided, mut kinds) = (0, 0, 0, [0; 3]);
    let (mut slowest, mut misses, mut within, mut worst) = ([0.0_f64; 2], Vec::new(), [0_usize; 4], 0.0_f64);
    while done < count {
        drawn += 1;
        let Some(case) = draw(&mut random, &mut slowest) else { continue };
        let (name, factor) = (case.name, case.factor);
        let found = case.along_the_way();
        if found.iter().any(|(_, agrees)| matches!(agrees, Ok(false))) {
            println!("loop {drawn}: {name:?} at {factor}: {found:?}\n{:?}", case.scenario);
            case.print_poles(&found, |agrees| matches!(agrees, Ok(false)));
            misses.push(drawn);
        } else if found.iter().any(|(_, agrees)| agrees.is_err()) {
            println!("loop {drawn}: {name:?} at {factor}: no run of 4 800 000 ticks tells: {found:?}");
            case.print_poles(&found, Result::is_err);
            undecided += 1;
            continue;
        }
        done += 1;
        kinds[match name {
            GainName::Position => 2,
            GainName::Velocity => 1,
            GainName::CurrentBandwidth | GainName::CurrentD | GainName::CurrentQ => 0,
        }] += 1;
        if asked.is_some() {
            let (confirmed, is_contradicted) = case.confirmed();
            if is_contradicted {
                println!("loop {drawn}: {name:?} at {factor} is confirmed to {confirmed} and not nearer");
                worst = worst.max(confirmed);
            }
            for (count, share) in within.iter_mut().zip(SHARES) {
                *count += usize::from(confirmed <= share);
            }
        }
    }
    let [current, velocity, position] = kinds;
    println!(
        "seed {seed}: {done} loops of {drawn} drawn, {undecided} more that runs cannot tell; boundaries of the current loop \
         {current}, velocity {velocity}, position {position}"
    );
    if asked.is_some() {
        println!("confirmed by runs within {SHARES:?}: {within:?}; contradicted within {worst} at most");
    }
    println!("slowest verdict {:.1} ms, with all boundaries {:.0} ms", 1e3 * slowest[0], 1e3 * slowest[1]);
    assert_eq!(misses, [0_usize; 0], "loops whose boundary is off by more than {BAR}");
}
