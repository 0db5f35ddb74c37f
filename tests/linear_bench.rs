//! Time of the linear loop, derived from the tick that runs: its verdict, and all boundaries of its gains, beside a second of a run of the
//! same axis in the same rounds.
//!
//! `cargo xtask bench [--json]`. The least of all rounds counts.
use servobench_plant::Exact;
use servobench_scenario::Scenario;
use servobench_sim::{Analysis, Bench, analyse_stability};
use servobench_stability::Depth;
use servobench_tests::scenario_file;
use std::time::{Duration, Instant};

const ROUNDS: usize = 30;

fn time(work: impl FnOnce()) -> Duration {
    let begun = Instant::now();
    work();
    begun.elapsed()
}

fn analyse(scenario: &Scenario, depth: Depth) {
    let analysis = analyse_stability(scenario, depth, None, None).unwrap();
    assert!(matches!(analysis, Analysis::Done { .. }), "{analysis:?}");
}

fn run(scenario: &Scenario) {
    let outcome = Bench::new(scenario, &Exact).unwrap().run(&mut |_| {});
    assert_eq!(outcome.failure, None);
}

fn main() {
    let is_json = std::env::args().any(|argument| argument == "--json");
    for file in ["demo/jerk.toml", "two-mass.toml", "plc/master-pid.toml"] {
        let mut scenario = scenario_file(file);
        scenario.duration = Some(1.0);
        let mut least = [Duration::MAX; 3];
        for _ in 0..ROUNDS {
            let times = [
                time(|| analyse(&scenario, Depth::Verdict)),
                time(|| analyse(&scenario, Depth::Boundaries)),
                time(|| run(&scenario)),
            ];
            least.iter_mut().zip(times).for_each(|(least, time)| *least = time.min(*least));
        }
        let [verdict, boundaries, run] = least.map(|time| 1e3 * time.as_secs_f64());
        if is_json {
            println!(
                "{{\"file\":\"{file}\",\"verdict_ms\":{verdict},\"boundaries_ms\":{boundaries},\"run_of_1_s_ms\":{run}}}"
            );
        } else {
            println!(
                "{file:<24} verdict {verdict:6.2} ms  all boundaries {boundaries:6.2} ms  a run of 1 s {run:6.2} ms"
            );
        }
    }
}
