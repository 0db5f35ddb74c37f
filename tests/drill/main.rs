//! Drills: suites that are ended, starved and shut out at random, and what must hold of them all the same.
//!
//! `cargo xtask drill faults` runs the long form; `SERVOBENCH_SWEEP` sets how many suites there are.
#![cfg(unix)]
#[path = "../command_line/attached.rs"]
mod attached;
mod fault;
mod processes;
mod suite;
mod two_suites;

use fault::Fault;
use servobench_testkit::Random;
use std::collections::BTreeMap;
use suite::Suite;

/// How many of something a drill does: `usual`, or as many as `SERVOBENCH_SWEEP` says.
fn count(usual: u64) -> u64 {
    std::env::var("SERVOBENCH_SWEEP").map_or(usual, |size| size.parse().expect("SERVOBENCH_SWEEP is a whole number"))
}

/// Whatever ends a suite, or keeps it from writing: no run that has ended is lost, nothing hangs, no process and no file that nobody
/// names stays, every file is whole, and what `--resume` makes of it equals, byte for byte, what a suite gives that nothing befell.
#[test]
fn faults() {
    let (suite, mut random) = (Suite::new(), Random::seeded(18));
    let (mut done, mut skipped) = (BTreeMap::<_, u32>::new(), BTreeMap::new());
    for number in 0..count(12) {
        let fault = Fault::drawn(number, &mut random, suite.usual_time());
        let name = fault.name();
        if let Some(why) = fault.cannot(&suite) {
            skipped.insert(name, why);
            continue;
        }
        let ended = suite.befall(&fault, &format!("{number}"));
        println!("{number:4}  {fault:?}: {ended}");
        *done.entry(name).or_default() += 1;
    }
    println!("\n{:>5}  fault", "times");
    for (name, times) in done {
        println!("{times:5}  {name}");
    }
    for (name, why) in skipped {
        println!("SKIPPED  {name}: {why}");
    }
}
