//! The same scenario twice, and with other scenarios beside it: the same bits.
use servobench_plant::EngineName;
use servobench_suite::jobs;
use servobench_tests::{engines, measured, run, scenario_file};
use std::thread;

#[test]
fn a_run_is_the_same_to_the_bit_whatever_runs_beside_it() {
    let files = ["feed-axis-move.toml", "two-mass.toml", "feed-axis-stick-slip.toml", "lambrechts-snap.toml"];
    let scenarios: Vec<_> = files.into_iter().map(scenario_file).collect();
    for engine in engines() {
        let alone: Vec<_> = scenarios.iter().map(|scenario| run(scenario, engine)).collect();
        let together: Vec<_> = thread::scope(|scope| {
            let runs: Vec<_> = scenarios.iter().map(|scenario| scope.spawn(|| run(scenario, engine))).collect();
            runs.into_iter().map(|run| run.join().unwrap()).collect()
        });
        for ((scenario, alone), together) in scenarios.iter().zip(&alone).zip(&together) {
            for (one, two) in alone.channels.iter().zip(&together.channels) {
                let same = one.values.iter().zip(&two.values).all(|(one, two)| one.to_bits() == two.to_bits());
                assert!(same, "{} on {}: {}", scenario.name, engine.name(), one.spec.name);
            }
            assert_eq!(alone, together);
            assert_eq!(measured(scenario, alone), measured(scenario, together));
        }
    }
}

#[test]
fn jobs_have_names_of_their_own() {
    let source = |name: &str| servobench_suite::Source {
        scenario: servobench_scenario::Scenario { name: name.into(), ..scenario_file("emps.toml") },
        text: String::new(),
    };
    let made = jobs(vec![source("a b"), source("a b"), source("c")], &[EngineName::Exact, EngineName::Rapier]);
    let ids: Vec<_> = made.iter().map(|job| job.id.as_str()).collect();
    assert_eq!(ids, ["a-b.exact", "a-b.rapier", "a-b.exact.2", "a-b.rapier.2", "c.exact", "c.rapier"]);
}
