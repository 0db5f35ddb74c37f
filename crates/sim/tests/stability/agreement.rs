//! The derived loop against the equations that are written out: 20 random loops, `SERVOBENCH_LOOPS` of them where that is set.
use crate::files::report;
use crate::random::random_loop;
use servobench_sim::analyse_typed;
use servobench_stability::{Boundary, Depth, Pole, Report};
use servobench_testkit::Random;

/// Boundaries are bisected to 1e-6 of the gain, each on its own.
const BISECTED: f64 = 3e-6;
/// Poles, on which the rounding of a monodromy matrix is.
const POLES: f64 = 1e-6;

fn is_near(one: f64, other: f64, bar: f64) -> bool {
    (one - other).abs() <= bar * one.abs().max(other.abs()).max(1.0)
}

fn boundary(one: Option<Boundary>, other: Option<Boundary>) -> bool {
    match (one, other) {
        (Some(one), Some(other)) => (one.factor / other.factor - 1.0).abs() < BISECTED,
        (one, other) => one.is_none() && other.is_none(),
    }
}

fn pole(one: Option<Pole>, other: Option<Pole>) -> bool {
    match (one, other) {
        (Some(one), Some(other)) => {
            is_near(one.magnitude, other.magnitude, POLES) && is_near(one.frequency, other.frequency, POLES)
        }
        (one, other) => one.is_none() && other.is_none(),
    }
}

/// Parts of two reports that differ.
fn differences(found: &Report, typed: &Report) -> Vec<String> {
    let mut all = Vec::new();
    let mut note = |is_equal: bool, text: &str| all.extend((!is_equal).then(|| text.to_owned()));
    note(found.is_stable() == typed.is_stable(), "verdict");
    note(pole(found.largest, typed.largest), "largest pole");
    let [one, other] = [found, typed].map(|of| of.instability.as_ref().map(|of| (of.name, of.gain_name)));
    note(one == other, "name");
    for (found, typed) in found.loops.iter().zip(&typed.loops) {
        note(pole(found.least_damped, typed.least_damped), &format!("{}, least damped", found.name));
        if let (Some(one), Some(other)) = (found.boundaries, typed.boundaries) {
            let is_equal = boundary(one.below, other.below) && boundary(one.above, other.above);
            note(is_equal, &format!("{}, {one:?} {other:?}", found.name));
        }
    }
    all
}

#[test]
fn the_derived_loop_is_the_one_that_is_written_out() {
    let asked = std::env::var("SERVOBENCH_LOOPS").ok().and_then(|count| count.parse().ok());
    let mut random = Random::seeded(7);
    let mut wrong = 0;
    for index in 0..asked.unwrap_or(20) {
        let scenario = random_loop(&mut random);
        let found = report(&scenario, Depth::Boundaries);
        let Ok(typed) = analyse_typed(&scenario, Depth::Boundaries).unwrap() else { continue };
        let all = differences(&found, &typed);
        wrong += usize::from(!all.is_empty());
        all.iter().for_each(|one| println!("{index}: {one}; growth {:?}", found.largest.map(|pole| pole.growth)));
    }
    assert!(wrong == 0 || asked.is_some(), "{wrong} differ");
}
